//! Mimic joints.

use crate::arms::{STRONG, angles, arm, awake};
use crate::common::Run;
use dwell_physics::JointState;
use dwell_scene::{JointCommand, JointId, Mimic};

/// An arm whose third joint follows its second; the motors of the others are commanded to `position`, rad.
pub(crate) fn linked(position: f32) -> Run {
    linked_within(None, position)
}

/// The same with other stops for the follower, rad.
fn linked_within(stops: Option<[f32; 2]>, position: f32) -> Run {
    let mut build = arm(1.0, Some(STRONG));
    let follower = &mut build.data.joints[JointId(2)];
    follower.servo = None;
    follower.limits = stops.or(follower.limits);
    follower.mimic = Some(Mimic {
        leader: JointId(1),
        multiplier: -0.5,
        offset: 0.1,
    });
    follower.initial = 0.1;
    let mut run = build.run_with(awake());
    for k in [0, 1, 3, 4, 5] {
        run.state.joint_command[JointId(k)] = JointCommand::Position(position);
    }
    run
}

/// A mimic joint keeps its multiple of the leader, also under load.
#[test]
fn a_follower_keeps_to_its_leader() {
    let mut run = linked(0.6);
    run.steps(80);
    let q = angles(&run.state);
    assert!((q[1] - 0.6).abs() < 0.02, "{q:?}");
    assert!((q[2] - (0.1 - 0.5 * q[1])).abs() < 2e-3, "{q:?}");
}

/// A mimic joint that is set elsewhere than at its multiple converges with its leader: a tenth of the difference in a
/// physics step, so that 0.9^6 of it is left after a control step, and without overshoot.
#[test]
fn a_linkage_that_was_set_apart_comes_together() {
    let mut run = linked(0.0);
    run.steps(5);
    let apart = JointState {
        joint: JointId(2),
        position: 0.4,
        velocity: 0.0,
    };
    run.world.set_joints(&mut run.state, &[apart]).unwrap();
    let off = |run: &Run| {
        let q = angles(&run.state);
        q[2] - (0.1 - 0.5 * q[1])
    };
    let mut left = off(&run);
    assert!((left - 0.3).abs() < 0.02, "{left}");
    for step in 0..12 {
        run.steps(1);
        let now = off(&run);
        println!("{step}: {now:.2e} rad off");
        // Within a twentieth, for the weight that both move under meanwhile.
        let expected = 0.9_f64.powi(6) * left;
        assert!(
            (now - expected).abs() < 0.05 * left + 2e-5,
            "{step}: {now} {expected}"
        );
        left = now;
    }
    assert!(left.abs() < 2e-4, "{left}");
}

/// A mimic joint whose stops keep it from its position does not press for it: it stands at the stop, and its leader where
/// its motor holds it. Where the arm meets itself on the way, it is pressed, but not shot away.
#[test]
fn a_linkage_that_asks_for_the_impossible_rests_at_the_stop() {
    for (stop, offset) in [(1.0_f32, 34.0), (-1.0, -34.0), (3.0, 34.0)] {
        let mut run = linked_within(Some([-stop.abs(), stop.abs()]), 0.6);
        run.steps(20);
        let house = run.house.clone();
        let address = "joint/2/mimic_offset".parse().unwrap();
        run.state.set_parameter(&house, &address, offset).unwrap();
        run.world.apply_parameters(&mut run.state).unwrap();
        let mut fastest = 0.0_f32;
        for _ in 0..200 {
            run.steps(1);
            assert!(
                run.world.delayed_outcomes().is_empty(),
                "{:?}",
                run.world.delayed_outcomes()
            );
            fastest = fastest.max(run.world.max_speed_m_s());
        }
        let q = angles(&run.state);
        println!(
            "{offset}: {q:?}, fastest {fastest} m/s, {} J",
            run.world.kinetic_energy_j()
        );
        assert!(fastest < 20.0, "{fastest}");
        if stop.abs() < 2.0 {
            assert!((q[2] - f64::from(stop)).abs() < 0.01, "{q:?}");
            assert!((q[1] - 0.6).abs() < 0.02, "{q:?}");
            assert!(run.world.kinetic_energy_j() < 1e-3);
        }
    }
}
