//! Mutated files of houses in every format: an error or a house, never a panic, and houses that one can live in.

use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind};

use dwell_scene::random::RandomKey;
use dwell_tests::hostile::{NAMES, OTHERS, exercise_house, mutated, read, sample, seeds};

/// One of so many opened houses is run.
const LIVED_IN: usize = 4;

/// Mutations of one sample, from its own stream of random numbers; gives back how many opened and those that panicked.
fn run(name: &str, count: usize) -> (usize, Vec<String>) {
    let sample = sample(name);
    let (mut opened, mut panicked) = (0, Vec::new());
    for k in 0..count {
        let mut random = RandomKey::root(71).child(name).child(k as u64).stream();
        // The file that leads gets half of them.
        let file = if random.below(2) == 0 {
            0
        } else {
            random.below(sample.len())
        };
        let bytes = mutated(sample.bytes(file), &mut random);
        let ended = catch_unwind(AssertUnwindSafe(|| {
            let Ok((house, _)) = read(&sample, file, &bytes) else {
                return false;
            };
            if k % LIVED_IN == 0 {
                exercise_house(house);
            }
            true
        }));
        if let Ok(is_open) = ended {
            opened += usize::from(is_open);
        } else {
            panicked.push(format!("{name} {k}: {}", sample.path(file).display()));
        }
    }
    (opened, panicked)
}

/// 2,000 in all; `DWELL_FUZZ=N` sets how many, as `DWELL_TEST_ALL=1` sets 1,000,000. `DWELL_FUZZ_ONLY=NAME` does the share of
/// one sample.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn mutated_files_end_in_an_error_or_in_a_house() {
    let number = std::env::var("DWELL_FUZZ").ok();
    let all = std::env::var_os("DWELL_TEST_ALL").map(|_| 1_000_000);
    let total: usize = number
        .map(|text| text.parse().unwrap())
        .or(all)
        .unwrap_or(2_000);
    let mut panicked = Vec::new();
    let only = std::env::var("DWELL_FUZZ_ONLY").ok();
    for (k, name) in NAMES.into_iter().enumerate() {
        if only.as_deref().is_some_and(|only| only != name) {
            continue;
        }
        // The built-in house in three forms is large: a fifth of what the small ones get.
        let weight = |k: usize| if k < 3 { 1 } else { 5 };
        let weights: usize = (0..NAMES.len()).map(weight).sum();
        let count = (total * weight(k)).div_ceil(weights);
        let start = std::time::Instant::now();
        let (opened, wrong) = run(name, count);
        println!(
            "  {name}: {count} mutations, {opened} opened, {} panicked, {:.1} s",
            wrong.len(),
            start.elapsed().as_secs_f32()
        );
        panicked.extend(wrong);
    }
    assert!(panicked.is_empty(), "{panicked:#?}");
}

#[test]
fn every_sample_opens_as_it_is() {
    for name in NAMES {
        let sample = sample(name);
        let opened = read(&sample, 0, sample.bytes(0));
        let (house, _) = opened.unwrap_or_else(|error| panic!("{name}: {error}"));
        exercise_house(house);
    }
}

/// Every target of cargo-fuzz has undamaged seed inputs, whose first byte tells which file they are.
#[test]
fn every_fuzz_target_has_seeds_and_an_entry() {
    let manifest = include_str!("../../../fuzz/Cargo.toml");
    for name in NAMES.into_iter().chain(OTHERS) {
        assert!(
            manifest.contains(&format!("path = \"fuzz_targets/{name}.rs\"")),
            "{name}"
        );
        let seeds = seeds(name);
        assert!(
            !seeds.is_empty() && seeds.iter().all(|(_, input)| input.len() > 1),
            "{name}"
        );
        let names: BTreeSet<_> = seeds.iter().map(|(file, _)| file).collect();
        assert_eq!(names.len(), seeds.len(), "{name}");
    }
    for name in NAMES {
        let sample = sample(name);
        for (file, input) in seeds(name) {
            let which = usize::from(input[0]);
            assert!(input[1..] == *sample.bytes(which), "{name}: {file}");
        }
    }
}
