//! The top-down map: it agrees with the navigation grid, shows nothing that was not seen, and comes back from snapshots.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use dwell::{Batch, DiscreteAction, Engines, FloorPlanLabels, WorldConfig, floor_plan};
use dwell_scene::navigation::{NavConfig, NavGrid, Occupancy};
use dwell_scene::{AgentBody, AgentId, Id, LevelId};
use dwell_tests::sensing::{bare_room, observed, place, sensing, world};
use glam::{Vec2, Vec3};
use serde_json::{Value, json};
use std::sync::Arc;

const UNKNOWN: f32 = 0.0;
const FREE: f32 = 1.0;
const OBSTACLE: f32 = 2.0;
const AGENT: f32 = 3.0;
const SIDE: usize = 240;

/// The occupancy of an agent's storey, for its body as the world is now.
fn occupancy(batch: &mut Batch) -> Occupancy {
    let body = AgentBody::default();
    let config = NavConfig {
        radius_m: body.radius_m,
        height_m: body.height_m,
        step_m: body.step_height_m,
        max_slope_rad: body.max_slope_rad,
        ..NavConfig::default()
    };
    let world = world(batch);
    let grid = NavGrid::build(world.house(), world.state(), &config).expect("a valid walker");
    grid.occupancy(LevelId(0)).expect("a ground floor")
}

/// The middle of a cell of a map in axes of the world, (x, z), m, on the grid of `map`.
fn middle(batch: &mut Batch, map: &Occupancy, cell: usize) -> Vec2 {
    let at = world(batch).state().agents[AgentId(0)].position;
    let [x0, z0] = map.corner;
    let own = [(at.x - x0) / map.cell_m, (at.z - z0) / map.cell_m].map(f32::floor);
    let half = (SIDE / 2) as f32;
    let column = own[0] + (cell % SIDE) as f32 - half;
    let row = own[1] + (cell / SIDE) as f32 - half;
    Vec2::new(x0, z0) + map.cell_m * Vec2::new(column + 0.5, row + 0.5)
}

/// The value of the occupancy map at a point, as the sensor tells it.
fn value_at(map: &Occupancy, point: Vec2) -> f32 {
    let [x, z] = ((point - Vec2::from_array(map.corner)) / map.cell_m)
        .floor()
        .to_array();
    let inside = x >= 0.0 && z >= 0.0 && x < map.width as f32 && z < map.depth as f32;
    if inside && map.free[z as usize * map.width + x as usize] == 1 {
        FREE
    } else {
        OBSTACLE
    }
}

fn settings(more: &Value) -> Value {
    let mut all = json!({"axes": "world", "width": SIDE, "height": SIDE});
    if let (Some(all), Some(more)) = (all.as_object_mut(), more.as_object()) {
        all.extend(more.clone());
    }
    all
}

fn apartment_map(sensors: &[(&str, Value)]) -> Batch {
    sensing(&dwell_tests::apartment(), WorldConfig::default(), sensors)
}

fn step(batch: &mut Batch, action: DiscreteAction) {
    batch.step(&[Some(action)]).unwrap();
}

/// Actions of a walk that turns and goes, now into something, now on.
fn walk(count: usize) -> Vec<DiscreteAction> {
    let action = |k: usize| match k % 9 {
        5 | 6 => DiscreteAction::TurnLeft,
        7 if k.is_multiple_of(2) => DiscreteAction::TurnRight,
        _ => DiscreteAction::MoveForward,
    };
    (0..count).map(action).collect()
}

#[test]
fn without_fog_the_map_is_the_navigation_grid() {
    let mut batch = apartment_map(&[("top_down_map", settings(&json!({"fog_of_war": false})))]);
    for action in walk(3) {
        step(&mut batch, action);
    }
    let (found, shape) = observed(&mut batch, "top_down_map");
    assert_eq!(shape, [SIDE, SIDE]);
    let map = occupancy(&mut batch);
    let mut free = 0;
    for (cell, value) in found.iter().enumerate() {
        if cell == SIDE / 2 * SIDE + SIDE / 2 {
            assert_eq!(*value, AGENT);
            continue;
        }
        let point = middle(&mut batch, &map, cell);
        assert_eq!(*value, value_at(&map, point), "{point}");
        free += usize::from(*value == FREE);
    }
    let all: usize = map.free.iter().map(|free| usize::from(*free)).sum();
    assert!(free + 1 >= all && free > 1000, "{free} of {all}");
}

#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn what_is_known_agrees_with_the_grid_and_only_grows() {
    let fixed = json!({"name": "start", "axes": "start", "width": 200, "height": 200});
    let mut batch = apartment_map(&[
        ("top_down_map", settings(&json!({}))),
        ("top_down_map", fixed),
    ]);
    let known = |batch: &mut Batch| -> Vec<bool> {
        let cells = observed(batch, "start").0;
        cells.into_iter().map(|value| value != UNKNOWN).collect()
    };
    let mut before = known(&mut batch);
    let first = before.iter().filter(|known| **known).count();
    assert!(first > 50);
    let (mut agrees, mut all) = (0, 0);
    // Things that it pushes are remembered where they were seen.
    let mut maps = vec![occupancy(&mut batch)];
    for action in walk(60) {
        step(&mut batch, action);
        maps.push(occupancy(&mut batch));
        let now = known(&mut batch);
        let mut both = before.iter().zip(&now);
        assert!(both.all(|(before, now)| *now || !before));
        before = now;
    }
    for (cell, value) in observed(&mut batch, "top_down_map")
        .0
        .into_iter()
        .enumerate()
    {
        if value == FREE || value == OBSTACLE {
            let point = middle(&mut batch, &maps[0], cell);
            let was = |map: &Occupancy| value_at(map, point) == value;
            assert!(maps.iter().any(was), "{point}: {value}");
            agrees += usize::from(maps.last().is_some_and(was));
            all += 1;
        }
    }
    assert!(agrees * 100 > 99 * all, "{agrees} of {all}");
    assert!(before.iter().filter(|known| **known).count() > first);
}

/// The whole field of view of a room without anything in it is seen, and nothing else.
#[test]
fn in_an_empty_room_the_field_of_view_is_seen() {
    let own = json!({"axes": "agent", "width": 41, "height": 41, "fov_deg": 90.0, "range_m": 1.5, "radius_m": 0.0});
    let mut batch = sensing(
        &bare_room([8.0, 3.0, 8.0]),
        WorldConfig::default(),
        &[("top_down_map", own)],
    );
    place(&mut batch, 0, Vec3::new(4.0, 0.0, 4.0), 0.6);
    // What was seen from the episode's start is forgotten with it.
    batch.env_mut(0).unwrap().set_goal(0, None).unwrap();
    let (cells, _) = observed(&mut batch, "top_down_map");
    for (cell, value) in cells.iter().enumerate() {
        let right = 0.1 * ((cell % 41) as f32 - 20.0);
        let ahead = 0.1 * (20.0 - (cell / 41) as f32);
        let (distance_m, aside) = (right.hypot(ahead), right.abs() - ahead);
        if distance_m < 0.05 {
            assert_eq!(*value, AGENT);
        } else if distance_m < 1.4 && aside < -0.2 {
            assert_eq!(*value, FREE, "{right} {ahead}");
        } else if distance_m > 1.65 || aside > 0.25 {
            assert_eq!(*value, UNKNOWN, "{right} {ahead}");
        }
    }
}

/// A place before a closed door of the ground floor: its middle, and the unit vector away from it to the place.
fn before_a_door(plan: &FloorPlanLabels, map: &Occupancy) -> (Vec2, Vec2) {
    let places = plan.doors.iter().flat_map(|door| {
        let (hinge, shut) = (Vec2::from_array(door.hinge), Vec2::from_array(door.shut));
        let across = (shut - hinge).normalize_or_zero();
        let middle = 0.5 * (hinge + shut);
        [across.perp(), -across.perp()].map(|normal| (middle, normal))
    });
    let stands = |(middle, normal): &(Vec2, Vec2)| {
        let free = |m: f32| value_at(map, *middle + *normal * m) == FREE;
        // Both sides are floor, so that something would be seen through the door.
        free(1.0) && free(0.9) && free(-0.8)
    };
    places
        .into_iter()
        .find(stands)
        .expect("a door between two floors")
}

#[test]
fn nothing_behind_a_closed_door_is_seen_until_it_opens() {
    let (house, _) = dwell_houses::open("seed:7").unwrap();
    let wide = settings(&json!({"fov_deg": 60.0, "range_m": 3.0}));
    let mut batch = sensing(
        &Engines::new(Arc::new(house)),
        WorldConfig::default(),
        &[("top_down_map", wide)],
    );
    let world_of = |batch: &mut Batch, openness: f32| {
        let world = world(batch);
        let house = world.house().clone();
        let doors = house.joints.iter_ids().filter(|(_, joint)| {
            joint.is_openable() && house.objects[joint.object].category.coarse == "door"
        });
        let joints: Vec<_> = doors
            .map(|(id, joint)| (id, joint.position_at(openness), 0.0))
            .collect();
        world.set_joints(&joints).unwrap();
    };
    world_of(&mut batch, 0.0);
    let map = occupancy(&mut batch);
    let plan = floor_plan(world(&mut batch), LevelId::from_index(0));
    let (door, normal) = before_a_door(&plan, &map);
    let feet = door + normal;
    let yaw = dwell_scene::space::yaw_from_forward(Vec3::new(-normal.x, 0.0, -normal.y));
    place(&mut batch, 0, Vec3::new(feet.x, plan.floor_y, feet.y), yaw);
    batch.env_mut(0).unwrap().set_goal(0, None).unwrap();
    let seen_behind = |batch: &mut Batch| {
        let cells = observed(batch, "top_down_map").0;
        let known = cells
            .iter()
            .enumerate()
            .filter(|(_, value)| **value != UNKNOWN);
        let (mut behind, mut before) = (0, 0);
        for (cell, _) in known.collect::<Vec<_>>() {
            let depth_m = (middle(batch, &map, cell) - door).dot(-normal);
            // The cells of wall and leaf are 0.1 m wide.
            behind += usize::from(depth_m > 0.2);
            before += usize::from(depth_m < 0.0);
        }
        (behind, before)
    };
    let (behind, before) = seen_behind(&mut batch);
    assert!(
        behind == 0 && before > 50,
        "{behind} behind, {before} before"
    );
    step(&mut batch, DiscreteAction::Wait);
    assert_eq!(seen_behind(&mut batch).0, 0);
    world_of(&mut batch, 1.0);
    step(&mut batch, DiscreteAction::Wait);
    let (behind, _) = seen_behind(&mut batch);
    assert!(behind > 50, "{behind} behind the open door");
}

#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn what_was_seen_comes_back_and_does_not_depend_on_being_observed() {
    let sensors = [("top_down_map", settings(&json!({})))];
    let mut batch = apartment_map(&sensors);
    for action in walk(12) {
        step(&mut batch, action);
    }
    let saved = batch.env(0).unwrap().snapshot().unwrap();
    let here = observed(&mut batch, "top_down_map").0;
    let go_on = |batch: &mut Batch, observes: bool| {
        for action in walk(30) {
            step(batch, action);
            if observes {
                observed(batch, "top_down_map");
            }
        }
        observed(batch, "top_down_map").0
    };
    let there = go_on(&mut batch, true);
    assert_ne!(there, here);
    batch.restore(0, &saved).unwrap();
    assert_eq!(observed(&mut batch, "top_down_map").0, here);
    assert_eq!(go_on(&mut batch, false), there);
    let mut other = apartment_map(&sensors);
    other.restore(0, &saved).unwrap();
    assert_eq!(observed(&mut other, "top_down_map").0, here);
    assert_eq!(go_on(&mut other, false), there);
    // Another episode remembers nothing of this one.
    let mut fresh = apartment_map(&sensors);
    other.reset(&[Some(1)]).unwrap();
    assert_eq!(
        observed(&mut other, "top_down_map").0,
        observed(&mut fresh, "top_down_map").0
    );
    // With other settings it would be another memory; without the sensor there is none.
    let mut longer = apartment_map(&[("top_down_map", settings(&json!({"range_m": 6.0})))]);
    let told = longer.restore(0, &saved).unwrap_err().to_string();
    assert!(
        told.contains("top_down_map") && told.contains("its settings are"),
        "{told}"
    );
    let mut without = apartment_map(&[("gps", json!({}))]);
    without.restore(0, &saved).unwrap();
    let blind = without.env(0).unwrap().snapshot().unwrap();
    fresh.restore(0, &blind).unwrap();
    let known = observed(&mut fresh, "top_down_map").0;
    let count = |cells: &[f32]| cells.iter().filter(|value| **value != UNKNOWN).count();
    assert!(count(&known) > 20 && count(&known) < count(&here));
}
