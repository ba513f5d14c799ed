//! Joints that turn on and on: their angle is the integral of their velocity, and stops after several turns hold.
//!
//! Regression: turns were counted from control step to control step: a wheel at 100 rad/s, which makes most of a turn in 50
//! ms, read any angle, and stops beyond half a turn came too early or too late.

use crate::arms::{awake, double_pendulum};
use crate::common::{Build, Piece, Run};
use dwell_physics::JointState;
use dwell_scene::{Joint, JointCommand, JointId, JointKind, Mobility, PartId, Pose, Servo};
use glam::Vec3;

const WHEEL: JointId = JointId(0);
const AT: Vec3 = Vec3::new(2.0, 2.0, 2.0);

/// A wheel about Y on the wall or, without weight, on a body that floats.
fn wheel(floats: bool, limits: Option<[f32; 2]>) -> Run {
    let mut build = Build::room([4.0, 4.0, 4.0]);
    let disc = Piece::cuboid(Vec3::new(0.1, 0.02, 0.1), AT);
    let body = Piece::cuboid(Vec3::splat(0.2), AT - Vec3::Y * 0.3);
    let (mobility, pieces) = if floats {
        (Mobility::Movable, vec![body, disc])
    } else {
        (Mobility::Articulated, vec![disc])
    };
    let object = build.object("rig", mobility, &pieces);
    let parts: Vec<PartId> = build.data.objects[object].parts().collect();
    let at = if floats { Vec3::Y * 0.3 } else { AT };
    build.data.joints.push(Joint {
        parent: floats.then(|| parts[0]),
        parent_from_joint: Pose::from_position(at),
        limits,
        servo: Some(Servo {
            max_effort: 1000.0,
            ..Servo::default()
        }),
        ..Joint::new(
            "axle",
            object,
            *parts.last().unwrap(),
            JointKind::Hinge,
            Vec3::Y,
        )
    });
    let mut run = build.run_with(awake());
    let weightless = "world/gravity_m_s2".parse().unwrap();
    let house = run.house.clone();
    run.state.set_parameter(&house, &weightless, 0.0).unwrap();
    run.world.apply_parameters(&mut run.state).unwrap();
    run
}

fn spin(run: &mut Run, position: f32, velocity: f32) {
    let state = JointState {
        joint: WHEEL,
        position,
        velocity,
    };
    run.world.set_joints(&mut run.state, &[state]).unwrap();
}

/// q = w t, up to the fastest that may be set, either way.
#[test]
fn a_continuous_joint_reads_the_integral_of_its_velocity() {
    for floats in [false, true] {
        for speed in [3.0_f32, -60.0, 100.0, -350.0, 1000.0] {
            let mut run = wheel(floats, None);
            spin(&mut run, 0.5, speed);
            let mut worst = 0.0_f64;
            for k in 1..=40 {
                run.steps(1);
                let expected = 0.5 + f64::from(speed) * 0.05 * f64::from(k);
                let off = f64::from(run.state.joint_position[WHEEL]) - expected;
                worst = worst.max(off.abs() / expected.abs());
            }
            let last = run.state.joint_velocity[WHEEL];
            println!("floats {floats}, {speed} rad/s: off by {worst:.1e} of its way, {last} rad/s");
            assert!(worst < 2e-4, "{floats} {speed}: {worst}");
            assert!((last / speed - 1.0).abs() < 2e-4, "{last} {speed}");
        }
    }
}

/// q = a t^2 / 2 under an even effort, from rest to 400 rad/s.
#[test]
fn a_wheel_that_gathers_speed_counts_its_turns() {
    for floats in [false, true] {
        let mut run = wheel(floats, None);
        let effort = 1.0;
        run.state.joint_command[WHEEL] = JointCommand::Effort(effort);
        run.steps(1);
        let a = f64::from(run.state.joint_velocity[WHEEL]) / 0.05;
        let steps = (400.0 / (a * 0.05)).round() as i32;
        let mut worst = 0.0_f64;
        for k in 2..=steps {
            run.steps(1);
            let t = 0.05 * f64::from(k);
            let expected = 0.5 * a * t * t;
            // The velocity at the end of a step or its middle: a physics step's gain of way.
            let within = 1e-3 * expected + a * t / 120.0;
            let off = (f64::from(run.state.joint_position[WHEEL]) - expected).abs();
            worst = worst.max(off / within);
        }
        println!("floats {floats}: {a} rad/s2, {steps} steps, {worst:.2} of what is allowed");
        assert!(steps > 4 && worst < 1.0, "{floats}: {worst}");
    }
}

/// Thrown at stops that are more than three turns away.
#[test]
fn stops_after_several_turns_hold_at_any_speed() {
    for floats in [false, true] {
        for speed in [30.0_f32, 100.0, -400.0, 1000.0] {
            let mut run = wheel(floats, Some([-20.0, 20.0]));
            let goal = 20.0_f32.copysign(speed);
            spin(&mut run, -0.25 * goal, speed);
            let (mut beyond, mut seen) = (0.0_f32, 0.0_f32);
            for _ in 0..30 {
                run.steps(1);
                let q = run.state.joint_position[WHEEL];
                beyond = beyond.max(q.abs() - 20.0);
                seen = seen.max(q * goal.signum());
            }
            println!("floats {floats}, {speed} rad/s: came to {seen}, beyond by {beyond:.1e} rad");
            assert!(beyond < 1e-3, "{floats} {speed}: {beyond}");
            // It came there, and did not begin another turn on the way.
            assert!(seen > 20.0 - 1e-2, "{floats} {speed}: {seen}");
        }
    }
}

/// Two bars that whirl as fast as may be set: whatever becomes of their energy, numbers stay numbers, and the world goes on.
#[test]
fn a_chain_that_whirls_stays_finite() {
    let speeds: &[f32] = if std::env::var_os("DWELL_TEST_ALL").is_some() {
        &[-1000.0, -600.0, -180.0, 125.0, 200.0, 400.0, 1000.0]
    } else {
        &[-1000.0, 180.0]
    };
    for (first, second) in speeds.iter().flat_map(|a| speeds.iter().map(|b| (*a, *b))) {
        for bend in [0.0, 1.0] {
            let mut run = double_pendulum(None, [0.3, bend], [first, second]);
            run.steps(20);
            let joints = &run.state.joint_velocity;
            assert!(
                joints.iter().all(|speed| speed.is_finite()),
                "{first} {second} {bend}"
            );
        }
    }
}
