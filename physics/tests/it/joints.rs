//! Hinges, slides and servos.

use crate::common::{Build, Piece, Run, gravity};
use dwell_physics::PhysicsConfig;
use dwell_scene::{JointCommand, JointId, JointKind, Mobility, ObjectId, Servo};
use glam::Vec3;
use std::f32::consts::{PI, TAU};

/// A bar of length 1 m that hangs from (2, 3, 2) and swings about Z.
fn pendulum(start_rad: f32) -> (Run, JointId, ObjectId) {
    let mut build = Build::room([4.0, 4.0, 4.0]);
    let bar = Piece::cuboid(Vec3::new(0.02, 0.5, 0.02), Vec3::new(2.0, 2.5, 2.0));
    let object = build.object("bar", Mobility::Articulated, &[bar]);
    let joint = build.joint(
        object,
        JointKind::Hinge,
        Vec3::Z,
        Vec3::new(2.0, 3.0, 2.0),
        [-PI, PI],
    );
    build.data.joints[joint].closed = PI;
    let mut run = build.run();
    run.state.joint_position[joint] = start_rad;
    run.world.adopt_state(&mut run.state).unwrap();
    (run, joint, object)
}

/// T = 2 pi sqrt(I / (m g d)) for small swings; I = m (l^2 / 3 + w^2 / 3) about the end.
#[test]
fn a_pendulum_has_its_period() {
    let (mut run, joint, _) = pendulum(0.1);
    let inertia = 1.0 / 3.0 + 0.02_f32 * 0.02 / 3.0;
    let expected = TAU * (inertia / (gravity() * 0.5)).sqrt();
    let mut crossings = Vec::new();
    let mut last = run.state.joint_position[joint];
    for step in 1..200 {
        run.steps(1);
        let now = run.state.joint_position[joint];
        if last > 0.0 && now <= 0.0 {
            let share = last / (last - now);
            crossings.push((step as f32 - 1.0 + share) / 20.0);
        }
        last = now;
    }
    let period = (crossings[crossings.len() - 1] - crossings[0]) / (crossings.len() - 1) as f32;
    assert!(
        (period / expected - 1.0).abs() < 0.01,
        "{period} s, expected {expected} s"
    );
}

/// The bar's end stays on its circle, and its energy within 0.2 % of what it was for 5 s.
#[test]
fn a_swinging_pendulum_keeps_its_length_and_gains_no_energy() {
    let (mut run, joint, object) = pendulum(1.5);
    let energy = |run: &Run| {
        let (q, v) = (
            run.state.joint_position[joint],
            run.state.joint_velocity[joint],
        );
        0.5 / 3.0 * v * v + gravity() * 0.5 * (1.0 - q.cos())
    };
    let start = energy(&run);
    let mut worst = 0.0_f32;
    for _ in 0..100 {
        run.steps(1);
        worst = worst.max((energy(&run) / start - 1.0).abs());
        let pose = run.state.part_pose[run.root(object)];
        let end = pose.transform_point(Vec3::new(0.0, 0.5, 0.0));
        assert!((end - Vec3::new(2.0, 3.0, 2.0)).length() < 2e-3, "{end}");
    }
    println!("  off by {worst} of its energy");
    assert!(worst < 0.002, "{worst}");
}

#[test]
fn a_joint_stops_at_its_limits() {
    let mut build = Build::room([4.0, 4.0, 4.0]);
    let bar = Piece::cuboid(Vec3::new(0.5, 0.02, 0.02), Vec3::new(2.5, 3.0, 2.0));
    let object = build.object("bar", Mobility::Articulated, &[bar]);
    let joint = build.joint(
        object,
        JointKind::Hinge,
        Vec3::Z,
        Vec3::new(2.0, 3.0, 2.0),
        [-0.7, 0.3],
    );
    build.data.joints[joint].closed = 0.3;
    let mut run = build.run();
    run.steps(80);
    assert!(
        (run.state.joint_position[joint] + 0.7).abs() < 0.01,
        "{}",
        run.state.joint_position[joint]
    );
}

/// Coulomb friction above the load's torque holds the bar; below, it falls.
#[test]
fn joint_friction_holds_up_to_its_torque() {
    for (share, holds) in [(1.2, true), (0.8, false)] {
        let mut build = Build::room([4.0, 4.0, 4.0]);
        let bar = Piece::cuboid(Vec3::new(0.5, 0.02, 0.02), Vec3::new(2.5, 3.0, 2.0));
        let mass = 500.0 * 1.0 * 0.04 * 0.04;
        let object = build.object("bar", Mobility::Articulated, &[bar]);
        let joint = build.joint(
            object,
            JointKind::Hinge,
            Vec3::Z,
            Vec3::new(2.0, 3.0, 2.0),
            [-1.5, 1.5],
        );
        build.data.joints[joint].friction = share * mass * gravity() * 0.5;
        build.data.joints[joint].closed = 1.5;
        let mut run = build.run();
        run.steps(40);
        assert_eq!(
            run.state.joint_position[joint].abs() < 0.01,
            holds,
            "{}",
            run.state.joint_position[joint]
        );
    }
}

/// A slide with viscous damping c under a force m g sinks at m g / c.
#[test]
fn a_damped_slide_sinks_at_its_terminal_speed() {
    let mut build = Build::room([4.0, 6.0, 4.0]);
    let lift = Piece::cuboid(Vec3::splat(0.1), Vec3::new(2.0, 5.0, 2.0));
    let mass = 500.0 * 0.2 * 0.2 * 0.2;
    let object = build.object("lift", Mobility::Articulated, &[lift]);
    let joint = build.joint(
        object,
        JointKind::Slide,
        Vec3::Y,
        Vec3::new(2.0, 5.0, 2.0),
        [-4.0, 1.0],
    );
    build.data.joints[joint].damping = mass * gravity() / 0.5;
    build.data.joints[joint].closed = 1.0;
    let mut run = build.run();
    run.steps(40);
    assert!(
        (run.state.joint_velocity[joint] + 0.5).abs() < 0.01,
        "{}",
        run.state.joint_velocity[joint]
    );
}

/// A servo of stiffness k under a load torque t comes to rest t / k below its target.
#[test]
fn a_servo_goes_to_its_target_less_the_load_over_its_stiffness() {
    let mut build = Build::room([4.0, 4.0, 4.0]);
    let arm = Piece::cuboid(Vec3::new(0.2, 0.02, 0.02), Vec3::new(2.2, 2.0, 2.0));
    let mass = 500.0 * 0.4 * 0.04 * 0.04;
    let object = build.object("arm", Mobility::Articulated, &[arm]);
    let joint = build.joint(
        object,
        JointKind::Hinge,
        Vec3::Z,
        Vec3::new(2.0, 2.0, 2.0),
        [-1.5, 1.5],
    );
    build.data.joints[joint].servo = Some(Servo {
        stiffness: 20.0,
        damping: 1.0,
        max_effort: 10.0,
        ..Servo::default()
    });
    let mut run = build.run();
    for target in [0.8, -0.4, 0.0] {
        run.state.joint_command[joint] = JointCommand::Position(target);
        run.steps(60);
        let q = run.state.joint_position[joint];
        let load = mass * gravity() * 0.2 * q.cos();
        assert!(
            (q - (target - load / 20.0)).abs() < 2e-3,
            "{q} for {target}"
        );
    }
}

/// The servo's effort has its bound: one that is too weak for the load does not lift it.
#[test]
fn a_servo_is_no_stronger_than_its_effort() {
    let mut build = Build::room([4.0, 4.0, 4.0]);
    let arm = Piece::cuboid(Vec3::new(0.5, 0.02, 0.02), Vec3::new(2.5, 2.0, 2.0));
    let torque = 500.0 * 1.0 * 0.04 * 0.04 * gravity() * 0.5;
    let object = build.object("arm", Mobility::Articulated, &[arm]);
    let joint = build.joint(
        object,
        JointKind::Hinge,
        Vec3::Z,
        Vec3::new(2.0, 2.0, 2.0),
        [-1.0, 1.0],
    );
    build.data.joints[joint].servo = Some(Servo {
        stiffness: 1000.0,
        damping: 10.0,
        max_effort: 0.5 * torque,
        ..Servo::default()
    });
    let mut run = build.run_with(PhysicsConfig {
        sleeping: false,
        ..PhysicsConfig::default()
    });
    run.state.joint_command[joint] = JointCommand::Position(0.5);
    run.steps(60);
    assert!(
        run.state.joint_position[joint] < -0.9,
        "{}",
        run.state.joint_position[joint]
    );
}
