//! Plans and buildings.

use crate::generate::{HomeKind, HouseSpec, generate};
use dwell_furniture::testing::meshes::assert_closed;
use dwell_scene::navigation::{DoorPolicy, NavConfig, NavGrid};
use dwell_scene::{House, State};
use std::collections::BTreeSet;

/// Seeds that are looked at in every run.
fn seeds() -> u64 {
    if tests_all() { 300 } else { 80 }
}

/// Returns whether tests take all their seeds (`make test-all`).
fn tests_all() -> bool {
    std::env::var_os("DWELL_TEST_ALL").is_some()
}

fn house(seed: u64, home: HomeKind, storeys: usize) -> House {
    let spec = HouseSpec {
        home: Some(home),
        storeys: (home == HomeKind::House).then_some(storeys),
        ..HouseSpec::default()
    };
    generate(seed, &spec)
        .unwrap_or_else(|error| panic!("seed {seed}, {home:?}: {error}"))
        .house
}

#[test]
fn every_seed_gives_a_house_whose_names_are_unique_and_whose_rooms_have_a_type() {
    let mut given_up = 0;
    let seeds = seeds();
    for seed in 0..seeds {
        let generated = generate(seed, &HouseSpec::default())
            .unwrap_or_else(|error| panic!("seed {seed}: {error}"));
        given_up += generated.report.given_up.len();
        let house = generated.house;
        assert!((1..=20).contains(&house.rooms.len()), "seed {seed}");
        let names: BTreeSet<&str> = house.rooms.iter().map(|room| room.name.as_str()).collect();
        assert_eq!(names.len(), house.rooms.len());
        assert!(house.rooms.iter().all(|room| !room.kinds.is_empty()));
    }
    println!("{given_up} wishes given up in {seeds} houses");
    assert!(given_up < seeds as usize / 4, "{given_up}");
}

#[test]
fn every_room_is_reached_when_doors_are_open() {
    let config = NavConfig {
        doors: DoorPolicy::Open,
        ..NavConfig::default()
    };
    let homes = [
        (HomeKind::Studio, 1),
        (HomeKind::Apartment, 1),
        (HomeKind::House, 1),
        (HomeKind::House, 2),
        (HomeKind::House, 3),
        (HomeKind::Office, 1),
    ];
    let mut faults = Vec::new();
    for (k, (home, storeys)) in homes.into_iter().enumerate() {
        for seed in 0..if tests_all() { 6 } else { 2 } {
            let house = house(seed + 10 * k as u64, home, storeys);
            let grid = NavGrid::build(&house, &State::new(&house), &config).unwrap();
            let largest = grid.walkable().filter(|cell| grid.island(*cell) == Some(0));
            let reached: BTreeSet<&str> = largest
                .filter_map(|cell| house.room_at(grid.position(cell)))
                .map(|room| house.rooms[room].name.as_str())
                .collect();
            for room in &house.rooms {
                if !reached.contains(room.name.as_str()) {
                    let seed = seed + 10 * k as u64;
                    faults.push(format!("{home:?} {storeys}, seed {seed}: {}", room.name));
                }
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn meshes_of_the_building_are_closed() {
    for seed in 0..20 {
        let house = generate(seed, &HouseSpec::default()).unwrap().house;
        for piece in &house.structure {
            let mesh = &house.meshes[piece.mesh];
            assert_closed(&piece.name, mesh);
            assert!(mesh.enclosed_volume_m3() > 1e-6, "{}", piece.name);
        }
    }
}
