//! Bodies against textbook mechanics.

use crate::common::{Build, Piece, gravity, pair};
use dwell_physics::PhysicsConfig;
use glam::{Quat, Vec3};

/// y0 - g t^2 / 2, within 0.1 mm.
#[test]
fn free_fall_follows_the_parabola() {
    let mut build = Build::room([4.0, 10.0, 4.0]);
    let ball = build.movable("ball", Piece::ball(0.1, Vec3::new(2.0, 8.0, 2.0)));
    let mut run = build.run();
    for step in 1..=18 {
        run.steps(1);
        let t = step as f32 / 20.0;
        let expected = 8.0 - 0.5 * gravity() * t * t;
        assert!(
            (run.position(ball).y - expected).abs() < 1e-4,
            "{t}: {} {expected}",
            run.position(ball).y
        );
        assert!((run.velocity(ball).y + gravity() * t).abs() < 1e-3 * gravity());
    }
}

/// The rates are settings: the same fall at other rates.
#[test]
fn a_fall_does_not_depend_on_the_rates() {
    for (control, physics, substeps) in [(10.0, 60.0, 4), (20.0, 240.0, 2), (100.0, 100.0, 1)] {
        let mut build = Build::room([4.0, 10.0, 4.0]);
        let ball = build.movable("ball", Piece::ball(0.1, Vec3::new(2.0, 8.0, 2.0)));
        let mut run = build.run_with(PhysicsConfig {
            control_rate_hz: control,
            physics_rate_hz: physics,
            solver_substeps: substeps,
            ..PhysicsConfig::default()
        });
        run.steps((0.8 * control) as usize);
        let expected = 8.0 - 0.5 * gravity() * 0.64;
        assert!(
            (run.position(ball).y - expected).abs() < 1e-4,
            "{control} {physics}: {}",
            run.position(ball).y
        );
    }
}

/// v^2 / (2 mu g), for a pair by the mean rule and one with a published value.
#[test]
fn a_sliding_box_stops_after_v_squared_over_two_mu_g() {
    for (floor, thing) in [
        ("parquet", "wood"),
        ("oak", "cast_iron"),
        ("steel", "copper"),
    ] {
        let mut build = Build::room_of([8.0, 3.0, 4.0], floor);
        let at = Vec3::new(1.0, 0.1, 2.0);
        let sled = build.movable(
            "sled",
            Piece::cuboid(Vec3::new(0.3, 0.1, 0.3), at).of(thing),
        );
        let mut run = build.run();
        run.steps(10);
        let from = run.position(sled);
        run.throw(sled, Vec3::new(3.0, 0.0, 0.0));
        run.steps(60);
        let (mu, _) = pair(floor, thing);
        let expected = 9.0 / (2.0 * mu * gravity());
        let found = run.position(sled).x - from.x;
        assert!(
            (found / expected - 1.0).abs() < 0.03,
            "{floor} {thing}: {found} m, expected {expected} m"
        );
        assert!(run.velocity(sled).length() < 1e-3);
    }
}

/// A block slides once the slope exceeds atan(mu): within 1.5 degrees on either side.
#[test]
fn a_block_slides_from_the_angle_of_friction_on() {
    let (mu, _) = pair("wood", "oak");
    let limit = mu.atan();
    for (angle, slides) in [(limit - 0.026, false), (limit + 0.026, true)] {
        let mut build = Build::room([8.0, 5.0, 4.0]);
        let turn = Quat::from_rotation_z(angle);
        let at = Vec3::new(4.0, 1.8, 2.0);
        build.fixed(
            "ramp",
            Piece::cuboid(Vec3::new(3.0, 0.1, 1.0), at)
                .of("oak")
                .turned(turn),
        );
        let on = at + turn * Vec3::new(1.0, 0.1 + 0.05, 0.0);
        let block = build.movable(
            "block",
            Piece::cuboid(Vec3::new(0.2, 0.05, 0.2), on)
                .of("wood")
                .turned(turn),
        );
        let mut run = build.run();
        run.steps(40);
        let moved = (run.position(block) - on).length();
        assert_eq!(moved > 0.05, slides, "{angle} rad: moved {moved} m");
    }
}

/// The first rebound of a ball reaches e^2 of its height.
#[test]
fn a_ball_rebounds_to_e_squared_of_its_height() {
    for (floor, thing) in [
        ("rubber", "rubber"),
        ("marble", "glass"),
        ("carpet", "rubber"),
        ("thick_carpet", "foam"),
    ] {
        let mut build = Build::room_of([4.0, 4.0, 4.0], floor);
        let ball = build.movable("ball", Piece::ball(0.1, Vec3::new(2.0, 1.6, 2.0)).of(thing));
        let mut run = build.run();
        let (mut touched, mut apex) = (false, 0.0_f32);
        for _ in 0..40 {
            run.steps(1);
            let y = run.position(ball).y;
            touched |= y < 0.35 || run.velocity(ball).y > 0.1;
            if touched {
                apex = apex.max(if run.velocity(ball).y > 0.0 || apex > 0.0 {
                    y
                } else {
                    0.0
                });
            }
            if touched && run.velocity(ball).y < -0.05 && apex > 0.0 {
                break;
            }
        }
        let (_, e) = pair(floor, thing);
        let found = (apex - 0.1) / 1.5;
        assert!(
            (found - e * e).abs() < 0.04,
            "{floor} {thing}: {found}, expected {}",
            e * e
        );
    }
}

#[test]
fn a_stack_of_eight_boxes_stays() {
    let mut build = Build::room([4.0, 4.0, 4.0]);
    let boxes: Vec<_> = (0..8)
        .map(|k| {
            let at = Vec3::new(2.0, 0.1 + 0.2 * k as f32, 2.0);
            build.movable(
                &format!("box_{k}"),
                Piece::cuboid(Vec3::new(0.15, 0.1, 0.15), at),
            )
        })
        .collect();
    let mut run = build.run();
    run.steps(200);
    for (k, id) in boxes.iter().enumerate() {
        let off = run.position(*id) - Vec3::new(2.0, 0.1 + 0.2 * k as f32, 2.0);
        println!("  box {k} moved by {off}");
        assert!(off.length() < 0.004, "box {k} moved by {off}");
    }
    assert_eq!(run.world.awake_count(), 0, "a stack at rest sleeps");
}

/// The ten cups touch the table only; they stay where the file put them.
#[test]
fn things_on_a_table_stay_there() {
    let mut build = Build::room([6.0, 3.0, 6.0]);
    build.movable(
        "table",
        Piece::cuboid(Vec3::new(0.8, 0.02, 0.5), Vec3::new(3.0, 0.74, 3.0)).density(700.0),
    );
    for (k, (x, z)) in [(-0.7, -0.4), (0.7, -0.4), (-0.7, 0.4), (0.7, 0.4)]
        .into_iter()
        .enumerate()
    {
        build.fixed(
            &format!("leg_{k}"),
            Piece::cuboid(
                Vec3::new(0.03, 0.36, 0.03),
                Vec3::new(3.0 + x, 0.36, 3.0 + z),
            ),
        );
    }
    let cups: Vec<_> = (0..10)
        .map(|k| {
            let at = Vec3::new(
                2.4 + 0.13 * k as f32,
                0.76 + 0.05,
                3.0 + 0.1 * (k % 3) as f32,
            );
            build.movable(
                &format!("cup_{k}"),
                Piece::cuboid(Vec3::new(0.04, 0.05, 0.04), at).of("porcelain"),
            )
        })
        .collect();
    let mut run = build.run();
    let before: Vec<Vec3> = cups.iter().map(|id| run.position(*id)).collect();
    assert!(run.report.moved.is_empty() && run.report.frozen.is_empty());
    run.steps(100);
    for (id, before) in cups.iter().zip(&before) {
        assert!(
            (run.position(*id) - *before).length() < 0.005,
            "{:?}",
            run.position(*id) - *before
        );
    }
}

/// Mass, centre of mass and inertia come from the pieces: a hammer of two boxes, thrown spinning, turns about the point
/// that theory names as its centre of mass.
#[test]
fn a_compound_body_turns_about_its_centre_of_mass() {
    let mut build = Build::room([10.0, 10.0, 10.0]);
    let grip = Piece::cuboid(Vec3::new(0.3, 0.02, 0.02), Vec3::new(5.0, 5.0, 5.0)).density(500.0);
    let head = Piece::cuboid(Vec3::new(0.05, 0.1, 0.05), Vec3::new(5.35, 5.0, 5.0)).density(7800.0);
    let hammer = build.object("hammer", dwell_scene::Mobility::Movable, &[grip, head]);
    let (grip_kg, head_kg) = (500.0 * 0.6 * 0.04 * 0.04, 7800.0 * 0.1 * 0.2 * 0.1);
    let center = 0.35 * head_kg / (grip_kg + head_kg);
    let mut run = build.run();
    let root = run.root(hammer);
    run.state.part_velocity[root].angular = Vec3::new(0.0, 6.0, 0.0);
    run.state.part_velocity[root].linear =
        Vec3::new(0.0, 6.0, 0.0).cross(Vec3::new(-center, 0.0, 0.0));
    run.world.adopt_state(&mut run.state).unwrap();
    for _ in 0..10 {
        run.steps(1);
        let at = run.state.part_pose[root].transform_point(Vec3::new(center, 0.0, 0.0));
        assert!(
            (at.x - 5.0 - center).abs() < 2e-3 && (at.z - 5.0).abs() < 2e-3,
            "{at}"
        );
    }
}
