//! Growth of a world's cost with the number of its things: made, stepped while all is awake and after all has come to rest, reset and
//! saved. Things are apart on a floor, or in one pile, each a little in its neighbours.
//!
//! `cargo bench --profile dev -p dwell-benches --bench crowds`.

#![expect(clippy::unwrap_used, reason = "a bench may stop at the first surprise")]

use divan::Bencher;
use divan::counter::ItemsCount;
use dwell::{Engines, World, WorldConfig};
use dwell_benches::Crowd;
use dwell_scene::House;
use dwell_scene::random::RandomKey;
use std::fmt;
use std::sync::Arc;

/// The longest that things of a pile are given to come to rest, control steps.
const LONGEST_REST: usize = 100;

fn main() {
    divan::main();
}

#[derive(Clone, Copy)]
struct Case {
    crowd: Crowd,
    count: usize,
}

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.count, self.crowd)
    }
}

impl Case {
    fn house(self) -> Arc<House> {
        Arc::new(self.crowd.house(self.count))
    }

    fn world(self) -> World {
        World::new(Engines::new(self.house()), &WorldConfig::default()).unwrap()
    }

    fn items(self) -> ItemsCount {
        ItemsCount::new(self.count)
    }
}

const fn case(crowd: Crowd, count: usize) -> Case {
    Case { crowd, count }
}

const CASES: [Case; 6] = [
    case(Crowd::Spread, 100),
    case(Crowd::Spread, 1_000),
    case(Crowd::Spread, 10_000),
    case(Crowd::Piled, 100),
    case(Crowd::Piled, 1_000),
    case(Crowd::Piled, 10_000),
];

/// Those that come to rest soon.
const THAT_REST: [Case; 4] = [CASES[0], CASES[1], CASES[2], CASES[3]];

#[divan::bench(args = CASES, sample_count = 3, sample_size = 1)]
fn make(bencher: Bencher<'_, '_>, case: Case) {
    let house = case.house();
    bencher
        .counter(case.items())
        .with_inputs(|| Engines::new(house.clone()))
        .bench_values(|engines| World::new(engines, &WorldConfig::default()).unwrap());
}

#[divan::bench(args = CASES, sample_count = 3, sample_size = 1)]
fn step_awake(bencher: Bencher<'_, '_>, case: Case) {
    let mut world = case.world();
    bencher
        .counter(case.items())
        .bench_local(|| world.step(&[]).unwrap());
}

#[divan::bench(args = THAT_REST, sample_count = 3, sample_size = 1)]
fn step_at_rest(bencher: Bencher<'_, '_>, case: Case) {
    let mut world = case.world();
    for _ in 0..LONGEST_REST {
        world.step(&[]).unwrap();
        if world.pair_counts().near == 0 {
            break;
        }
    }
    bencher
        .counter(case.items())
        .bench_local(|| world.step(&[]).unwrap());
}

#[divan::bench(args = CASES, sample_count = 3, sample_size = 1)]
fn reset(bencher: Bencher<'_, '_>, case: Case) {
    let mut world = case.world();
    bencher
        .counter(case.items())
        .bench_local(|| world.reset(RandomKey::root(1)).unwrap());
}

#[divan::bench(args = CASES, sample_count = 3, sample_size = 1)]
fn snapshot(bencher: Bencher<'_, '_>, case: Case) {
    let world = case.world();
    bencher
        .counter(case.items())
        .bench_local(|| world.snapshot());
}
