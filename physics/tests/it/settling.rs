//! Settling of objects before a world begins.

use crate::common::{Build, Piece, Run};
use dwell_physics::PhysicsConfig;
use dwell_scene::Pose;
use glam::Vec3;
use std::sync::Arc;

const HALF_M: f32 = 0.1;

fn dropped_box() -> Run {
    let mut build = Build::room([8.0, 3.0, 8.0]);
    build.movable(
        "box",
        Piece::cuboid(Vec3::splat(HALF_M), Vec3::new(2.0, 1.0, 2.0)),
    );
    build.run()
}

#[test]
fn what_was_dropped_lies_and_time_begins_then() {
    let mut run = dropped_box();
    run.world.settle(&mut run.state, 10.0).unwrap();
    assert_eq!(run.world.awake_count(), 0);
    assert_eq!(run.world.time_s(), 0.0);
    assert!(run.world.delayed_outcomes().is_empty());
    let height_m = |run: &Run| {
        let poses = run.state.part_pose.iter();
        poses.map(|pose: &Pose| pose.position.y).fold(0.0, f32::max)
    };
    assert!((height_m(&run) - HALF_M).abs() < 2e-3, "{}", height_m(&run));
    let before = run.state.clone();
    run.steps(40);
    assert!(run.events.is_empty(), "{:?}", run.events);
    assert_eq!(run.state.part_pose, before.part_pose);
}

/// An object without time to settle falls when the world runs, and one with too little still does.
#[test]
fn it_takes_no_longer_than_it_may() {
    let mut run = dropped_box();
    run.world.settle(&mut run.state, 0.0).unwrap();
    assert_eq!(run.state.part_pose, dropped_box().state.part_pose);
    run.world.settle(&mut run.state, 0.2).unwrap();
    assert_eq!(run.world.awake_count(), 1);
    run.steps(20);
    assert!(run.events.iter().all(|event| event.time_s >= 0.0));
    assert!(!run.events.is_empty(), "it hits the floor after the start");
}

#[test]
fn other_durations_are_refused() {
    for longest_s in [-1.0, f64::NAN, f64::INFINITY, 60.5] {
        let mut run = dropped_box();
        let before = run.state.clone();
        let error = run.world.settle(&mut run.state, longest_s).unwrap_err();
        assert!(error.to_string().contains("settle_s"), "{error}");
        assert_eq!(run.state.part_pose, before.part_pose);
    }
}

/// A furnished house that has settled goes on as one that ran for as long, but for its time.
#[test]
fn a_house_has_settled_as_one_that_ran() {
    let house = Arc::new(dwell_houses::open("builtin:studio").unwrap().0);
    let config = PhysicsConfig::default;
    let mut settled = Run::over(house.clone(), config());
    settled.world.settle(&mut settled.state, 2.0).unwrap();
    let mut ran = Run::over(house, config());
    ran.steps(40);
    assert_eq!(settled.state.part_pose, ran.state.part_pose);
    assert!(
        settled.world.awake_count() < 6,
        "{}",
        settled.world.awake_count()
    );
    settled.events.clear();
    settled.steps(1);
    assert!(settled.events.iter().all(|event| event.time_s < 0.1));
}
