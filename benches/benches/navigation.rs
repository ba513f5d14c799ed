//! Navigation: building a grid, following a door, paths and distance fields. One thread; cells of 0.1 m.
//!
//! Houses: the built-in apartment, and the SUNCG sample house where `../shared` lies beside the repository.

use divan::Bencher;
use divan::counter::ItemsCount;
use dwell_houses::open;
use dwell_scene::navigation::{DoorPolicy, NavCell, NavConfig, NavGrid};
use dwell_scene::random::RandomKey;
use dwell_scene::{House, Pose, State};
use std::path::PathBuf;
use std::sync::LazyLock;

/// Ways in a round.
const PATH_COUNT: usize = 20;

fn main() {
    divan::main();
}

static CASES: LazyLock<Vec<(&'static str, House)>> = LazyLock::new(|| {
    let apartment = open("builtin:apartment").map(|(house, _)| house);
    let mut cases = vec![(
        "apartment",
        apartment.expect("the built-in apartment opens"),
    )];
    let shared = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared");
    let path = shared.join("data/suncg/house/0004d52d1aeeb8ae6de39d6bd993e992/house.json");
    match path.to_str().map(open) {
        Some(Ok((house, _))) => cases.push(("sample", house)),
        _ => eprintln!("no sample house in ../shared: the built-in apartment alone"),
    }
    cases
});

fn names() -> impl Iterator<Item = &'static str> {
    CASES.iter().map(|(name, _)| *name)
}

fn house(name: &str) -> &'static House {
    let case = CASES.iter().find(|(other, _)| *other == name);
    &case.expect("a listed house").1
}

fn grid(house: &House) -> NavGrid {
    let config = NavConfig {
        doors: DoorPolicy::Open,
        ..NavConfig::default()
    };
    NavGrid::build(house, &State::new(house), &config).expect("a house with floors")
}

/// Ends of ways that exist.
fn ends(grid: &NavGrid) -> Vec<[NavCell; 2]> {
    let on_island = |cell: NavCell| grid.island(cell) == Some(0);
    (0..PATH_COUNT)
        .filter_map(|k| {
            let key = RandomKey::root(5).child(k as u64);
            Some([
                grid.sample(key.child(0_u64), on_island)?,
                grid.sample(key.child(1_u64), on_island)?,
            ])
        })
        .collect()
}

#[divan::bench(args = names())]
fn build(bencher: Bencher, name: &str) {
    let house = house(name);
    let found = grid(house);
    eprintln!(
        "{name}: {} cells to stand on of {}, {} doors",
        found.walkable().count(),
        found.len(),
        found.doors().len()
    );
    bencher.bench_local(|| grid(house));
}

/// Every second time a door is a little further open.
#[divan::bench(args = names())]
fn follow_a_door(bencher: Bencher, name: &str) {
    let house = house(name);
    let mut state = State::new(house);
    let config = NavConfig::default();
    let mut grid = NavGrid::build(house, &state, &config).expect("a house with floors");
    let Some(door) = grid.doors().first().map(|door| door.joint) else {
        eprintln!("{name}: no door");
        return;
    };
    let joint = &house.joints[door];
    let parent = joint
        .parent
        .map_or(Pose::IDENTITY, |parent| state.part_pose[parent]);
    let mut fraction = 0.0;
    bencher.bench_local(|| {
        fraction = if fraction < 1.0 { fraction + 0.1 } else { 0.0 };
        state.joint_position[door] = joint.position_at(fraction);
        state.part_pose[joint.child] = joint.world_from_child(&parent, joint.position_at(fraction));
        grid.update(house, &state)
    });
}

#[divan::bench(args = names())]
fn routes(bencher: Bencher, name: &str) {
    let grid = grid(house(name));
    let ends = ends(&grid);
    bencher
        .counter(ItemsCount::new(ends.len()))
        .bench_local(|| {
            let ways = ends
                .iter()
                .map(|[a, b]| grid.route(grid.position(*a), grid.position(*b)));
            ways.flatten().map(|way| way.length_m).sum::<f64>()
        });
}

#[divan::bench(args = names())]
fn distance_field(bencher: Bencher, name: &str) {
    let grid = grid(house(name));
    let Some([goal, _]) = ends(&grid).first().copied() else {
        return;
    };
    bencher.bench_local(|| grid.distance_field(&[goal]));
}
