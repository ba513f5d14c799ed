//! Doors, and what follows when things move.

use crate::support::{
    add_movable, assert_same, grid_of, house, open_door, room_with_door, two_storeys,
};
use dwell_scene::navigation::{DoorPolicy, NavConfig, NavGrid};
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentId, JointId, ObjectId, PartId, Pose, State};
use glam::{Quat, Vec3};

const WEST: Vec3 = Vec3::new(1.0, 0.0, 2.0);
const EAST: Vec3 = Vec3::new(4.2, 0.0, 2.0);

fn with(doors: DoorPolicy) -> NavConfig {
    NavConfig {
        doors,
        ..NavConfig::default()
    }
}

#[test]
fn a_shut_door_parts_two_islands_and_an_open_one_joins_them() {
    let house = house(room_with_door());
    let mut state = State::new(&house);
    let mut grid = NavGrid::build(&house, &state, &with(DoorPolicy::AsTheyStand)).unwrap();
    let [door] = grid.doors().try_into().expect("one door");
    assert_eq!((door.joint, door.is_open), (JointId(0), false));
    assert_eq!((door.cells.len(), door.islands.len()), (0, 2));
    assert_eq!(grid.geodesic_m(WEST, EAST), None);
    open_door(&house, &mut state, 1.0);
    grid.update(&house, &state).unwrap();
    let [door] = grid.doors().try_into().expect("one door");
    assert!(door.is_open && door.openness > 0.99);
    assert!(!door.cells.is_empty());
    assert_eq!(door.islands, [0]);
    let way = grid.geodesic_m(WEST, EAST).unwrap();
    // Middles of cells lie up to half a cell's edge off either end.
    assert!((3.1..3.4).contains(&way), "{way}");
}

#[test]
fn the_leaf_of_an_open_door_occupies_its_cells() {
    let house = house(room_with_door());
    let mut state = State::new(&house);
    let beside = Vec3::new(3.0, 0.0, 1.55);
    let grid = NavGrid::build(&house, &state, &with(DoorPolicy::AsTheyStand)).unwrap();
    assert!(grid.nearest(beside, 0.08).is_some());
    open_door(&house, &mut state, 1.0);
    let grid = NavGrid::build(&house, &state, &with(DoorPolicy::AsTheyStand)).unwrap();
    assert_eq!(grid.nearest(beside, 0.08), None);
}

#[test]
fn who_opens_doors_goes_through_and_pays_for_it() {
    let house = house(room_with_door());
    let mut state = State::new(&house);
    let open = NavGrid::build(&house, &state, &with(DoorPolicy::Open)).unwrap();
    let free = open.geodesic_m(WEST, EAST).unwrap();
    let config = NavConfig {
        door_price_m: 3.5,
        ..with(DoorPolicy::Priced)
    };
    let mut priced = NavGrid::build(&house, &state, &config).unwrap();
    let cost = |grid: &NavGrid| {
        let [a, b] = [WEST, EAST].map(|p| grid.nearest(p, 0.1).unwrap());
        let there = grid.distance_field(&[b]).at(a).unwrap();
        let back = grid.distance_field(&[a]).at(b).unwrap();
        assert!((there - back).abs() < 1e-9, "{there} {back}");
        there
    };
    assert!((cost(&priced) - cost(&open) - 3.5).abs() < 1e-6);
    let route = priced.route(WEST, EAST).unwrap();
    assert!((route.length_m - free).abs() < 0.02);
    assert_eq!(route.shut_doors, [JointId(0)]);
    open_door(&house, &mut state, 1.0);
    priced.update(&house, &state).unwrap();
    assert!((cost(&priced) - cost(&open)).abs() < 1e-6);
    assert!(priced.route(WEST, EAST).unwrap().shut_doors.is_empty());
}

/// Door and boxes at random places, one or all moving at a time: updating equals building anew.
#[test]
fn following_what_moves_equals_building_anew() {
    let mut data = room_with_door();
    for k in 0..4 {
        let corner = Vec3::new(0.4 + 0.9 * k as f32, 0.0, 0.4);
        add_movable(&mut data, [corner, corner + Vec3::new(0.5, 0.9, 0.4)]);
    }
    let house = house(data);
    for doors in [
        DoorPolicy::AsTheyStand,
        DoorPolicy::Open,
        DoorPolicy::Priced,
    ] {
        let config = with(doors);
        let mut state = State::new(&house);
        let mut grid = NavGrid::build(&house, &state, &config).unwrap();
        let mut stream = RandomKey::root(17).stream();
        for round in 0..25 {
            if stream.below(2) == 0 {
                open_door(&house, &mut state, stream.uniform_f32());
            }
            for part in 1..5 {
                if stream.below(3) == 0 {
                    let place = Vec3::new(
                        stream.range(0.3, 4.7),
                        // In the air, on the floor, on top of each other, near the ceiling.
                        stream.range(0.3, 2.4),
                        stream.range(0.3, 3.7),
                    );
                    let turn = Quat::from_rotation_y(stream.range(-3.0, 3.0));
                    state.part_pose[PartId(part)] = Pose::new(place, turn);
                }
            }
            let held = stream.below(4) == 0;
            state.held_by[ObjectId(2)] = held.then_some(AgentId(0));
            let rebuilt = grid.update(&house, &state).unwrap();
            let anew = NavGrid::build(&house, &state, &config).unwrap();
            assert_same(&grid, &anew);
            assert_eq!(
                grid.update(&house, &state).unwrap().rechecked_cells,
                0,
                "{round}"
            );
            assert!(rebuilt.changed_columns <= rebuilt.rechecked_cells);
        }
    }
}

#[test]
fn only_columns_near_a_door_are_looked_at_again() {
    let house = house(room_with_door());
    let mut state = State::new(&house);
    let mut grid = NavGrid::build(&house, &state, &with(DoorPolicy::AsTheyStand)).unwrap();
    open_door(&house, &mut state, 0.5);
    let rebuilt = grid.update(&house, &state).unwrap();
    assert_eq!(rebuilt.moved_parts, 1);
    // A leaf of 1 by 0.04 m, twice: some 12 columns shut and 20 slanting; with the radius 3 columns around each.
    assert!((15..60).contains(&rebuilt.changed_columns), "{rebuilt:?}");
    assert!(rebuilt.rechecked_cells < 260, "{rebuilt:?}");
}

#[test]
fn another_house_is_refused() {
    let ours = house(room_with_door());
    let mut grid = grid_of(&ours, &NavConfig::default());
    let other = two_storeys(true);
    let error = grid.update(&other, &State::new(&other)).unwrap_err();
    assert!(error.to_string().contains("navigation"), "{error}");
}
