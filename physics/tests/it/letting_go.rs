//! Motors that are switched off, delays that begin while a motor holds, and limits that a start violates.

use crate::common::{Build, Piece, Run};
use crate::laws::spec;
use dwell_physics::PhysicsConfig;
use dwell_scene::{Joint, JointCommand, JointId, JointKind, Mobility, Servo, State};
use glam::Vec3;
use std::sync::Arc;

const LIFT: JointId = JointId(0);
/// Position at which the motor holds it, m.
const HELD_M: f32 = 0.4;

/// A weight of about 8 kg on an upright slide with a motor.
fn lift() -> Build {
    let mut build = Build::room([4.0, 3.0, 4.0]);
    let at = Vec3::new(2.0, 0.5, 2.0);
    let weight = Piece::cuboid(Vec3::splat(0.1), at).density(1000.0);
    let object = build.object("lift", Mobility::Articulated, &[weight]);
    let part = build.data.objects[object].first_part;
    let joint = Joint::new("slide", object, part, JointKind::Slide, Vec3::Y);
    build.data.joints.push(Joint {
        parent_from_joint: dwell_scene::Pose::from_position(at),
        limits: Some([0.0, 1.0]),
        servo: Some(Servo {
            stiffness: 4000.0,
            damping: 400.0,
            max_effort: 500.0,
            ..Servo::default()
        }),
        ..joint
    });
    build
}

/// The lift, held at [`HELD_M`] for ten seconds: asleep, as worlds are by default.
fn held() -> Run {
    let mut run = lift().run_with(PhysicsConfig::default());
    run.state.joint_command[LIFT] = JointCommand::Position(HELD_M);
    run.steps(200);
    let at = run.state.joint_position[LIFT];
    assert!((at - HELD_M).abs() < 0.03, "{at}");
    run
}

#[test]
fn a_motor_that_is_told_nothing_more_lets_go_of_what_sleeps() {
    let mut run = held();
    run.state.joint_command[LIFT] = JointCommand::Off;
    run.steps(40);
    let at = run.state.joint_position[LIFT];
    assert!(at < 0.01, "it hangs at {at} m");
}

#[test]
fn a_delay_that_begins_while_a_motor_holds_drops_nothing() {
    let mut run = held();
    let before = run.state.joint_position[LIFT];
    run.state.laws = vec![spec("latency", Some("slide"), &[("delay_s", 0.2)])];
    run.world.apply_parameters(&mut run.state).unwrap();
    for _ in 0..20 {
        run.steps(1);
        let at = run.state.joint_position[LIFT];
        assert!((at - before).abs() < 2e-3, "{at} m instead of {before}");
    }
    // Commands from now on come late: nothing happens for 0.2 s.
    run.state.joint_command[LIFT] = JointCommand::Position(0.6);
    run.steps(3);
    let early = run.state.joint_position[LIFT];
    run.steps(37);
    let late = run.state.joint_position[LIFT];
    assert!((early - before).abs() < 2e-3, "{early}");
    assert!((late - 0.6).abs() < 0.03, "{late}");
}

/// As overrides may have set them before the world began.
#[test]
fn a_start_beyond_its_limits_stands_at_the_nearer_one_from_the_beginning() {
    let house = lift().house();
    let mut state = State::new(&house);
    let address = "joint/lift/slide/lower".parse().unwrap();
    state.set_parameter(&house, &address, 0.3).unwrap();
    let mut run = Run::from_state(Arc::clone(&house), PhysicsConfig::default(), state);
    assert!((run.state.joint_position[LIFT] - 0.3).abs() < 1e-6);
    let part = run.house.joints[LIFT].child;
    let began = run.state.part_pose[part].position;
    assert!((began.y - 0.8).abs() < 1e-5, "{began}");
    run.steps(1);
    assert!(run.state.part_pose[part].position.abs_diff_eq(began, 5e-3));
}
