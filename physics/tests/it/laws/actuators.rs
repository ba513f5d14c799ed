//! Laws of servos and joints.

use super::{spec, tower};
use crate::common::Run;
use dwell_physics::PhysicsConfig;
use dwell_scene::{JointCommand, JointId, LawSpec, State};

/// The joint follows the target b behind on the way up and b ahead on the way down, and rests at the turns.
#[test]
fn backlash_draws_its_hysteresis_loop() {
    let b = 0.1;
    let house = tower().house();
    let mut state = State::new(&house);
    state.laws = vec![spec("backlash", Some("elbow"), &[("half_width", b)])];
    let mut run = Run::from_state(
        house,
        PhysicsConfig {
            sleeping: false,
            ..PhysicsConfig::default()
        },
        state,
    );
    let joint = run.house.joints.ids().next().unwrap();
    let mut follow = |target: f32| {
        run.state.joint_command[joint] = JointCommand::Position(target);
        run.steps(30);
        run.state.joint_position[joint]
    };
    for (target, expected) in [
        (0.05, 0.0),
        (0.5, 0.4),
        (1.0, 0.9),
        (0.9, 0.9),
        (0.8, 0.9),
        (0.5, 0.6),
        (0.0, 0.1),
        (0.15, 0.1),
        (0.4, 0.3),
    ] {
        let found = follow(target);
        assert!(
            (found - expected).abs() < 2e-3,
            "target {target}: {found}, expected {expected}"
        );
    }
}

/// A world over the tower with laws on its elbow, which turns about the vertical.
fn elbow(laws: Vec<LawSpec>) -> (Run, JointId) {
    let house = tower().house();
    let mut state = State::new(&house);
    state.laws = laws;
    let run = Run::from_state(house, awake(), state);
    let joint = run.house.joints.ids().next().unwrap();
    (run, joint)
}

fn awake() -> PhysicsConfig {
    PhysicsConfig {
        sleeping: false,
        ..PhysicsConfig::default()
    }
}

/// Position and velocity of the elbow after each control step under commands.
fn told(
    laws: Vec<LawSpec>,
    steps: usize,
    command: impl Fn(usize) -> JointCommand,
) -> Vec<(f32, f32)> {
    let (mut run, joint) = elbow(laws);
    (0..steps)
        .map(|step| {
            run.state.joint_command[joint] = command(step);
            run.steps(1);
            (
                run.state.joint_position[joint],
                run.state.joint_velocity[joint],
            )
        })
        .collect()
}

/// The arm's inertia about the elbow, kg·m², by the acceleration under an effort without any law.
fn inertia() -> f32 {
    let free = told(Vec::new(), 4, |_| JointCommand::Effort(0.1));
    0.1 * 0.2 / free[3].1
}

#[test]
fn the_arm_has_the_inertia_of_its_shape() {
    // 0.32 kg of 0.4 m by 0.04 m, whose end is at the elbow.
    let expected = 0.32 * ((0.16 + 0.0016) / 12.0 + 0.04);
    assert!(
        (inertia() / expected - 1.0).abs() < 2e-3,
        "{} {expected}",
        inertia()
    );
}

/// Two control steps late, and otherwise the same.
#[test]
fn latency_shifts_a_motion_and_does_not_deform_it() {
    let command = |step: usize| match step {
        0..2 => JointCommand::Off,
        2..20 => JointCommand::Position(0.6),
        20..30 => JointCommand::Velocity(0.0),
        _ => JointCommand::Position(-0.2),
    };
    let plain = told(Vec::new(), 50, command);
    let late = told(
        vec![spec("latency", Some("elbow"), &[("delay_s", 0.1)])],
        52,
        command,
    );
    for (step, (before, after)) in plain.iter().zip(&late[2..]).enumerate() {
        assert!(
            (before.0 - after.0).abs() < 1e-4 && (before.1 - after.1).abs() < 1e-3,
            "{step}: {before:?} {after:?}"
        );
    }
    assert!(plain.iter().any(|(position, _)| *position > 0.55));
}

/// `v = T / I (t - tau (1 - e^(-t / tau)))` under a step of effort T.
#[test]
fn a_lag_rounds_a_step_of_effort_as_the_exponential() {
    let inertia = inertia();
    for tau in [0.03_f32, 0.2] {
        let laws = vec![spec("first_order_lag", None, &[("tau_s", tau.into())])];
        let run = told(laws, 10, |_| JointCommand::Effort(0.05));
        for (step, (_, velocity)) in run.iter().enumerate() {
            let t = (step + 1) as f32 * 0.05;
            let expected = 0.05 / inertia * (t - tau * (1.0 - (-t / tau).exp()));
            assert!(
                (velocity - expected).abs() < 3e-3 * (0.05 / inertia * t),
                "{tau} {t}: {velocity} {expected}"
            );
        }
    }
}

/// A step of position becomes a ramp, which the servo follows `damping / stiffness * rate` behind.
#[test]
fn a_rate_limit_makes_a_ramp_of_a_step() {
    let rate = 0.5_f32;
    let laws = vec![spec(
        "rate_limit",
        Some("arm/elbow"),
        &[("max_rate", rate.into())],
    )];
    let run = told(laws, 60, |_| JointCommand::Position(1.0));
    for (step, (position, velocity)) in run.iter().enumerate().skip(10).take(26) {
        let t = (step + 1) as f32 * 0.05;
        let behind = rate * 2.0 / 50.0;
        assert!(
            (position - (rate * t - behind)).abs() < 4e-3,
            "{t}: {position}"
        );
        assert!((velocity - rate).abs() < 5e-3, "{t}: {velocity}");
    }
    assert!((run[59].0 - 1.0).abs() < 1e-3);
}

#[test]
fn a_saturated_motor_gives_its_bound_and_is_exact_below_it() {
    let inertia = inertia();
    let weak = |effort: f32| {
        let laws = vec![spec("saturation", Some("elbow"), &[("max_effort", 0.05)])];
        told(laws, 4, |_| JointCommand::Effort(effort))[3].1
    };
    for (effort, given) in [(0.03, 0.03), (0.05, 0.05), (0.2, 0.05), (-3.0, -0.05)] {
        let expected = given / inertia * 0.2;
        assert!(
            (weak(effort) / expected - 1.0).abs() < 2e-3,
            "{effort}: {}",
            weak(effort)
        );
    }
    // Told a far position, it gathers speed evenly.
    let laws = vec![spec("saturation", Some("elbow"), &[("max_effort", 0.05)])];
    let far = told(laws, 4, |_| JointCommand::Position(1.5))[3].1;
    assert!((far / (0.05 / inertia * 0.2) - 1.0).abs() < 2e-3, "{far}");
}

#[test]
fn within_its_deadband_a_motor_does_nothing_and_beyond_it_all() {
    let banded = || {
        let numbers = [("half_width", 0.05), ("min_effort", 0.04)];
        vec![spec("deadband", Some("elbow"), &numbers)]
    };
    let still = told(banded(), 20, |_| JointCommand::Position(0.049));
    assert_eq!(still[19], (0.0, 0.0));
    let still = told(banded(), 20, |_| JointCommand::Effort(-0.039));
    assert_eq!(still[19], (0.0, 0.0));
    for command in [JointCommand::Position(0.3), JointCommand::Effort(0.05)] {
        // The first step leaves the band nowhere: the same bits as without the law.
        assert_eq!(
            told(banded(), 1, |_| command),
            told(Vec::new(), 1, |_| command)
        );
    }
}

/// All state of motor laws is in the snapshot.
#[test]
fn laws_of_motors_continue_bit_for_bit_from_a_snapshot() {
    let laws = vec![
        spec("latency", None, &[("delay_s", 0.083)]),
        spec("first_order_lag", None, &[("tau_s", 0.06)]),
        spec("rate_limit", None, &[("max_rate", 1.5)]),
        spec("backlash", None, &[("half_width", 0.02)]),
        spec("deadband", None, &[("half_width", 0.01)]),
        spec("joint_friction", None, &[("coulomb", 0.03), ("load", 0.1)]),
        spec(
            "motor_constants",
            None,
            &[("k_t", 0.1), ("torque_scale", 0.9)],
        ),
    ];
    let (mut run, joint) = elbow(laws);
    let go = |run: &mut Run, step: usize| {
        run.state.joint_command[joint] = match step / 9 % 3 {
            0 => JointCommand::Position(0.8),
            1 => JointCommand::Position(-0.3),
            _ => JointCommand::Velocity(0.4),
        };
        run.steps(1);
    };
    for step in 0..20 {
        go(&mut run, step);
    }
    let (state, bytes) = (run.state.clone(), run.world.snapshot());
    let mut other = elbow(run.state.laws.clone()).0;
    for step in 20..60 {
        go(&mut run, step);
    }
    other.state = state;
    other.world.restore(&mut other.state, &bytes).unwrap();
    for step in 20..60 {
        go(&mut other, step);
    }
    assert!(run.hash() == other.hash());
}

/// Two laws of one kind on one motor each keep their state when parameters are applied again.
#[test]
fn equal_laws_on_one_motor_keep_their_own_memory() {
    let laws = || {
        vec![
            spec("latency", Some("elbow"), &[("delay_s", 0.08)]),
            spec("latency", Some("elbow"), &[("delay_s", 0.03)]),
            spec("first_order_lag", Some("elbow"), &[("tau_s", 0.05)]),
            spec("first_order_lag", Some("elbow"), &[("tau_s", 0.2)]),
        ]
    };
    let (mut plain, mut applied) = (elbow(laws()).0, elbow(laws()).0);
    let joint = plain.house.joints.ids().next().unwrap();
    for step in 0..40 {
        let command = JointCommand::Position(if step < 15 { 0.7 } else { -0.4 });
        for run in [&mut plain, &mut applied] {
            run.state.joint_command[joint] = command;
            run.steps(1);
        }
        applied.world.apply_parameters(&mut applied.state).unwrap();
    }
    assert!(plain.hash() == applied.hash());
    assert!(plain.state.joint_position[joint].abs() > 0.05);
}

/// Under a reversed velocity command, a motor turns back through the play at once, and the joint coasts on: they meet after
/// 2 b / 2 w, and from then on the joint moves with the motor.
#[test]
fn a_joint_with_play_coasts_until_its_motor_has_turned_round() {
    let (b, w) = (0.05_f32, 0.25_f32);
    let laws = vec![spec("backlash", Some("elbow"), &[("half_width", b.into())])];
    let (mut run, joint) = elbow(laws);
    let house = run.house.clone();
    let address = format!("joint/{}/velocity_gain", joint.0).parse().unwrap();
    run.state.set_parameter(&house, &address, 5.0).unwrap();
    run.world.apply_parameters(&mut run.state).unwrap();
    let mut go = |step: usize| {
        run.state.joint_command[joint] = JointCommand::Velocity(if step < 20 { w } else { -w });
        run.steps(1);
        let state = &run.state;
        (state.joint_position[joint], state.joint_velocity[joint])
    };
    let run: Vec<(f32, f32)> = (0..60).map(&mut go).collect();
    // From the middle it first crosses b in 0.2 s.
    let turned = run[19].0;
    assert!((turned - (w - b)).abs() < 5e-3, "{turned}");
    for (step, (position, velocity)) in run.iter().enumerate().skip(20) {
        let t = (step - 19) as f32 * 0.05;
        let meet = b / w;
        let coasts = t < meet - 0.01;
        let way = if t < meet {
            w * t
        } else {
            w * (2.0 * meet - t)
        };
        let within = if coasts { 1e-3 } else { 6e-3 };
        assert!((position - turned - way).abs() < within, "{t}: {position}");
        if coasts || t > meet + 0.11 {
            let expected = if coasts { w } else { -w };
            assert!((velocity - expected).abs() < 2e-3, "{t}: {velocity}");
        }
    }
}

/// Under an effort command, a motor with inertia exerts it once it has crossed the play: `v = u / I (t - sqrt(2 b J / u))` from the middle.
#[test]
fn an_effort_comes_once_the_motor_has_crossed_the_play() {
    let (b, effort, motor) = (0.1_f32, 0.05_f32, 0.02_f32);
    for motor in [motor, 0.0] {
        let numbers = [("half_width", b.into()), ("motor_inertia", motor.into())];
        let laws = vec![spec("backlash", Some("elbow"), &numbers)];
        let run = told(laws, 12, |_| JointCommand::Effort(effort));
        let late = (2.0 * b * motor / effort).sqrt();
        for (step, (_, velocity)) in run.iter().enumerate() {
            let t = (step + 1) as f32 * 0.05;
            let expected = effort / inertia() * (t - late).max(0.0);
            // A physics step.
            let within = effort / inertia() * 0.01;
            assert!(
                (velocity - expected).abs() < within,
                "{t}: {velocity} {expected}"
            );
        }
    }
}

/// Setting a joint is no motion: whatever was before, equal states evolve alike.
#[test]
fn joints_that_are_set_forget_their_springs_and_their_play() {
    let laws = || {
        vec![
            spec(
                "joint_hysteresis",
                Some("elbow"),
                &[("stiffness", 4.0), ("max_effort", 0.3)],
            ),
            spec("backlash", Some("elbow"), &[("half_width", 0.1)]),
        ]
    };
    let go = |run: &mut Run, joint: JointId| -> Vec<(f32, f32)> {
        let set = dwell_physics::JointState {
            joint,
            position: 0.3,
            velocity: 0.4,
        };
        run.world.set_joints(&mut run.state, &[set]).unwrap();
        (0..40)
            .map(|step| {
                run.state.joint_command[joint] = match step / 10 {
                    0 => JointCommand::Off,
                    1 => JointCommand::Position(0.35),
                    2 => JointCommand::Velocity(-0.3),
                    _ => JointCommand::Effort(0.1),
                };
                run.steps(1);
                let state = &run.state;
                (state.joint_position[joint], state.joint_velocity[joint])
            })
            .collect()
    };
    let (mut fresh, joint) = elbow(laws());
    let plain = go(&mut fresh, joint);
    let (mut used, _) = elbow(laws());
    for target in [1.2, -0.9, 0.3] {
        used.state.joint_command[joint] = JointCommand::Position(target);
        used.steps(15);
    }
    // First from elsewhere, then from the very place.
    for _ in 0..2 {
        let again = go(&mut used, joint);
        for (step, (a, b)) in plain.iter().zip(&again).enumerate() {
            assert!(
                (a.0 - b.0).abs() < 1e-5 && (a.1 - b.1).abs() < 1e-4,
                "{step}: {a:?} {b:?}"
            );
        }
    }
    assert!((plain[9].0 - 0.3).abs() > 0.01);
}
