//! Overlaps at the start.

use crate::common::{Build, Piece};
use dwell_physics::PhysicsConfig;
use dwell_scene::Mobility;
use glam::Vec3;

#[test]
fn shallow_overlaps_are_resolved_and_reported_and_nothing_explodes() {
    let mut build = Build::room([6.0, 3.0, 6.0]);
    let half = Vec3::splat(0.1);
    let sunk = build.movable("sunk", Piece::cuboid(half, Vec3::new(1.0, 0.06, 1.0)));
    let in_wall = build.movable("in_wall", Piece::cuboid(half, Vec3::new(0.05, 0.1, 3.0)));
    build.movable("below", Piece::cuboid(half, Vec3::new(4.0, 0.1, 4.0)));
    let above = build.movable("above", Piece::cuboid(half, Vec3::new(4.0, 0.27, 4.0)));
    let fine = build.movable("fine", Piece::cuboid(half, Vec3::new(2.0, 0.1, 5.0)));
    let mut run = build.run();
    let moved: Vec<_> = run.report.moved.iter().map(|moved| moved.object).collect();
    assert_eq!(moved, [sunk, in_wall, above]);
    for moved in &run.report.moved {
        assert!(
            moved.distance_m > 0.02 && moved.distance_m <= 0.1,
            "{moved:?}"
        );
        assert!(
            moved.overlap_m > 0.02 && moved.overlap_m < 0.06,
            "{moved:?}"
        );
    }
    assert!(run.report.frozen.is_empty() && run.report.overlaps == 3);
    assert_eq!(run.position(fine), Vec3::new(2.0, 0.1, 5.0));
    let mut fastest = 0.0_f32;
    for _ in 0..40 {
        run.steps(1);
        fastest = fastest.max(run.world.max_speed_m_s());
    }
    assert!(fastest < 0.5, "{fastest} m/s");
    assert!(
        run.world.max_speed_m_s() < 0.01,
        "{} m/s after 2 s",
        run.world.max_speed_m_s()
    );
    assert!((run.position(sunk).y - 0.1).abs() < 2e-3);
    assert!(run.position(in_wall).x > 0.098);
    assert!(
        (run.position(above).y - 0.3).abs() < 4e-3,
        "{}",
        run.position(above)
    );
}

#[test]
fn what_needs_more_than_the_bound_is_frozen_and_named() {
    let mut build = Build::room([6.0, 3.0, 6.0]);
    build.fixed(
        "block",
        Piece::cuboid(Vec3::splat(0.5), Vec3::new(3.0, 0.5, 3.0)),
    );
    let buried = build.movable(
        "buried",
        Piece::cuboid(Vec3::splat(0.1), Vec3::new(3.0, 0.5, 3.0)),
    );
    let mut run = build.run();
    assert_eq!(run.report.frozen.len(), 1);
    assert_eq!(
        (
            run.report.frozen[0].object,
            run.report.frozen[0].with.as_str()
        ),
        (buried, "block")
    );
    run.steps(40);
    assert_eq!(run.position(buried), Vec3::new(3.0, 0.5, 3.0));
    assert_eq!(run.world.max_speed_m_s(), 0.0);
}

/// A frozen object stays for good; giving it a velocity frees it, so that it collides with what is in its way.
#[test]
fn a_frozen_thing_with_a_velocity_is_free() {
    let mut build = Build::room([6.0, 3.0, 6.0]);
    let half = Vec3::splat(0.5);
    build.fixed("block", Piece::cuboid(half, Vec3::new(3.0, 0.5, 3.0)));
    let piece = Piece::cuboid(Vec3::splat(0.1), Vec3::new(3.0, 0.95, 3.0));
    let sunk = build.movable("sunk", piece);
    let mut run = build.run_with(PhysicsConfig {
        max_start_shift_m: 0.01,
        ..PhysicsConfig::default()
    });
    assert_eq!(run.report.frozen.len(), 1);
    run.world.adopt_state(&mut run.state).unwrap();
    run.steps(20);
    assert_eq!(run.position(sunk), Vec3::new(3.0, 0.95, 3.0), "it stands");
    let root = run.root(sunk);
    run.state.part_velocity[root].linear = Vec3::new(2.0, 1.0, 0.0);
    run.world.adopt_state(&mut run.state).unwrap();
    run.steps(100);
    let at = run.position(sunk);
    assert!(
        at.x > 3.2 && at.x < 5.92 && at.y > 0.09,
        "it flew and fell inside the room: {at}"
    );
    assert!(run.world.max_speed_m_s() < 0.1);
}

/// With a larger bound the same thing is lifted out.
#[test]
fn the_bound_is_a_setting() {
    let mut build = Build::room([6.0, 3.0, 6.0]);
    build.fixed(
        "block",
        Piece::cuboid(Vec3::splat(0.5), Vec3::new(3.0, 0.5, 3.0)),
    );
    let buried = build.movable(
        "buried",
        Piece::cuboid(Vec3::splat(0.1), Vec3::new(3.0, 0.7, 3.0)),
    );
    let run = build.run_with(PhysicsConfig {
        max_start_shift_m: 0.6,
        ..PhysicsConfig::default()
    });
    assert_eq!(run.report.moved[0].object, buried);
    assert!(run.position(buried).y > 1.09, "{}", run.position(buried));
}

#[test]
fn a_leaf_passes_through_its_frame_and_nothing_else() {
    let mut build = Build::room([6.0, 3.0, 6.0]);
    let (_, joint) = build.wall_with_door(3.0, 6.0);
    let run = build.run();
    let passing = &run.report.passing[0];
    assert_eq!(passing.joint, joint);
    assert_eq!(passing.through, ["floor", "lintel", "wall_a", "wall_b"]);
}

#[test]
fn a_moving_thing_without_pieces_has_the_hull_of_what_is_seen() {
    let mut build = Build::room([6.0, 3.0, 6.0]);
    let ghost = build.movable(
        "ghost",
        Piece::cuboid(Vec3::splat(0.1), Vec3::new(3.0, 1.0, 3.0)),
    );
    let part = build.data.objects[ghost].first_part;
    build.data.parts[part].colliders.clear();
    let mut run = build.run();
    assert_eq!(run.report.stand_ins, [ghost]);
    run.steps(60);
    assert!(
        (run.position(ghost).y - 0.1).abs() < 5e-3,
        "{}",
        run.position(ghost)
    );
}

#[test]
fn an_empty_house_and_things_without_shape_make_a_world() {
    let house = dwell_scene::House::new(dwell_scene::HouseData::default()).unwrap();
    let mut run = crate::common::Run::over(std::sync::Arc::new(house), PhysicsConfig::default());
    run.agent(Vec3::ZERO, 0.0);
    run.steps(30);
    assert!(
        (run.state.agents[dwell_scene::AgentId(0)].position.y + 0.5).abs() < 0.01,
        "on the floor of the box of last resort"
    );
    let mut build = Build::room([6.0, 3.0, 6.0]);
    let ghost = build.movable(
        "ghost",
        Piece::cuboid(Vec3::splat(0.1), Vec3::new(3.0, 1.0, 3.0)),
    );
    let part = build.data.objects[ghost].first_part;
    build.data.parts[part].colliders.clear();
    build.data.parts[part].mesh = build.data.meshes.push(std::sync::Arc::default());
    let mut run = build.run();
    run.steps(40);
    assert!(
        run.position(ghost).y > 0.0 && run.position(ghost).y < 0.02,
        "{}",
        run.position(ghost)
    );
}

/// An object that leaves the house comes to rest below it instead of falling for ever.
#[test]
fn nothing_falls_for_ever() {
    let mut build = Build::room([6.0, 3.0, 6.0]);
    let lost = build.movable(
        "lost",
        Piece::cuboid(Vec3::splat(0.1), Vec3::new(9.0, 1.0, 3.0)),
    );
    let mut run = build.run();
    run.steps(80);
    assert!(
        (run.position(lost).y + 0.4).abs() < 0.02,
        "{}",
        run.position(lost)
    );
    assert_eq!(run.house.objects[lost].mobility, Mobility::Movable);
}

/// A tall box that stands a little in two others beside it cannot leave by itself; they make way for it.
#[test]
fn what_stands_around_makes_way() {
    let mut build = Build::room([6.0, 3.0, 6.0]);
    let half = Vec3::new(0.1, 0.4, 0.1);
    let mut tall =
        |name: &str, x: f32| build.movable(name, Piece::cuboid(half, Vec3::new(x, 0.4, 3.0)));
    let (left, right) = (tall("left", 1.0), tall("right", 1.372));
    let middle = tall("middle", 1.186);
    // Objects behind and in front leave no shorter way out.
    for (name, z) in [("behind", 2.7), ("before", 3.3)] {
        let wide = Vec3::new(1.0, 0.4, 0.19);
        build.fixed(name, Piece::cuboid(wide, Vec3::new(1.186, 0.4, z)));
    }
    let run = build.run();
    assert!(run.report.frozen.is_empty(), "{:?}", run.report.frozen);
    let moved: Vec<_> = run.report.moved.iter().map(|moved| moved.object).collect();
    assert!(moved.contains(&left) && moved.contains(&right), "{moved:?}");
    for moved in &run.report.moved {
        assert!(moved.distance_m < 0.03, "{moved:?}");
    }
    let apart = |a, b| run.position(b).x - run.position(a).x;
    assert!(apart(left, middle) > 0.197 && apart(middle, right) > 0.197);
}

/// An object stuck in a ceiling comes down, and one too near to a wall is moved beside it, but never behind it.
#[test]
fn what_is_stuck_comes_down_or_aside_but_through_no_wall() {
    let mut build = Build::room([6.0, 3.0, 6.0]);
    let half = Vec3::splat(0.1);
    let lamp = build.movable("lamp", Piece::cuboid(half, Vec3::new(3.0, 2.95, 3.0)));
    // A chair that a script put on a table, into a ceiling that it did not know of.
    let top = Vec3::new(0.4, 0.02, 0.4);
    build.fixed("table", Piece::cuboid(top, Vec3::new(3.0, 2.2, 1.0)));
    let chair = build.movable(
        "chair",
        Piece::cuboid(Vec3::new(0.2, 0.45, 0.2), Vec3::new(3.1, 2.7, 1.0)),
    );
    // A cupboard in a wall, and too little room before it; behind the wall there would be some.
    build.fixed(
        "shaft",
        Piece::cuboid(Vec3::new(0.3, 1.5, 3.0), Vec3::new(0.7, 1.5, 3.0)),
    );
    let cupboard = build.movable(
        "cupboard",
        Piece::cuboid(Vec3::new(0.25, 0.5, 0.5), Vec3::new(0.1, 0.5, 3.0)),
    );
    let run = build.run_with(PhysicsConfig {
        max_start_shift_m: 0.8,
        ..PhysicsConfig::default()
    });
    let frozen: Vec<_> = run.report.frozen.iter().map(|one| one.object).collect();
    assert_eq!(frozen, [cupboard]);
    let at = run.position(lamp);
    assert!(at.y < 2.901 && at.y > 2.8, "{at}");
    let at = run.position(chair);
    assert!(
        (at.x - 1.0).abs() > 0.59 || (at.z - 1.0).abs() > 0.59,
        "{at}"
    );
    assert!(
        at.y + 0.45 < 3.001 && at.y > 2.4,
        "beside, below the ceiling: {at}"
    );
}
