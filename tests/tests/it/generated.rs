//! Generated houses are valid: as they stand, and when physics begins. The bench `validity` looks at thousands of seeds.

use dwell_houses::builtin;
use dwell_houses::generate::HouseSpec;
use dwell_scene::parallel::Threads;
use dwell_tests::validity::{CheckCounts, CheckDepth, check_house, thread_dependent_seeds};
use std::collections::BTreeMap;

/// Number of seeds that are looked at.
fn seeds() -> usize {
    if dwell_tests::runs_all() { 300 } else { 40 }
}

/// Of these, the number of seeds whose houses settle for two seconds.
fn settled() -> usize {
    if dwell_tests::runs_all() { 30 } else { 6 }
}

fn assert_valid(all: &[CheckCounts]) {
    let mut faults = Vec::new();
    let mut given_up = BTreeMap::<&str, usize>::new();
    for looked in all {
        for fault in &looked.faults {
            faults.push(format!(
                "seed {}: {}: {}",
                looked.seed, fault.rule, fault.what
            ));
        }
        for sentence in &looked.given_up {
            *given_up.entry(sentence).or_default() += 1;
        }
    }
    eprintln!("given up in {} houses: {given_up:#?}", all.len());
    let told = &faults[..faults.len().min(60)];
    assert!(
        faults.is_empty(),
        "{} faults\n{}",
        faults.len(),
        told.join("\n")
    );
}

#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn houses_of_seeds_are_valid_as_they_stand() {
    let check =
        |seed: usize| check_house(seed as u64, &HouseSpec::default(), CheckDepth::Geometric);
    assert_valid(&Threads::default().map(seeds(), check));
}

#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn houses_of_seeds_stay_as_they_are_when_physics_begins() {
    let check = |seed: usize| check_house(seed as u64, &HouseSpec::default(), CheckDepth::Settled);
    assert_valid(&Threads::default().map(settled(), check));
}

#[test]
fn houses_of_seeds_are_the_same_alone_and_beside_others() {
    let seeds: Vec<u64> = (0..20).collect();
    assert_eq!(thread_dependent_seeds(&seeds), Vec::<u64>::new());
}

/// Its grid has lines half a micrometre apart: strips of floor between them were triangles without area, which held everything.
#[test]
fn a_house_whose_lines_differ_by_rounding_is_valid() {
    assert_valid(&[check_house(
        1743,
        &HouseSpec::default(),
        CheckDepth::Settled,
    )]);
}

#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn built_in_houses_are_valid_and_stay_as_they_are() {
    let specs = builtin::names().iter().map(|name| builtin::spec(name));
    let looked: Vec<CheckCounts> = specs
        .map(|known| {
            let (seed, spec) = known.expect("every built-in house has a spec");
            check_house(seed, &spec, CheckDepth::Settled)
        })
        .collect();
    assert_valid(&looked);
}
