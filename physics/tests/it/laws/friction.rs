//! Friction of joints and constants of motors, against equations solved here by themselves.

use super::{spec, tower};
use crate::common::{Build, Piece, Run, gravity};
use dwell_physics::PhysicsConfig;
use dwell_scene::{JointCommand, JointId, JointKind, LawSpec, Mobility, Servo, State};
use glam::Vec3;
use std::f64::consts::FRAC_PI_2;

/// Numbers of a friction model by the names of the law's parameters.
type Numbers = &'static [(&'static str, f64)];

/// BAM's identified values of a Dynamixel MX-106.
///
/// # Source
/// Rhoban/bam at 1b5a1ce, bam/params/mx106/m1.json to m6.json.
const MX106: [Numbers; 6] = [
    &[("coulomb", 0.103_520_27), ("viscous", 0.035_202_38)],
    &[
        ("coulomb", 2.768_555e-6),
        ("viscous", 0.059_589_394),
        ("stribeck", 0.117_421_21),
        ("stribeck_velocity", 1.848_780_5),
        ("stribeck_exponent", 1.741_389_3),
    ],
    &[
        ("coulomb", 0.113_353_3),
        ("viscous", 0.011_944_504),
        ("load", 0.108_240_37),
    ],
    &[
        ("coulomb", 6.65e-13),
        ("viscous", 0.050_960_825),
        ("stribeck", 0.104_910_61),
        ("load", 0.009_150_334),
        ("load_stribeck", 0.222_359_12),
        ("stribeck_velocity", 1.623_295),
        ("stribeck_exponent", 1.323_485_7),
    ],
    &[
        ("coulomb", 1.88e-10),
        ("viscous", 0.050_664_87),
        ("stribeck", 0.122_427_47),
        ("motor_load", 0.207_637_1),
        ("external_load", 0.022_684_35),
        ("motor_load_stribeck", 0.195_193_2),
        ("external_load_stribeck", 0.084_901_62),
        ("stribeck_velocity", 1.745_713),
        ("stribeck_exponent", 1.138_313_2),
    ],
    &[
        ("coulomb", 1.023_252_6e-5),
        ("viscous", 0.050_715_666),
        ("stribeck", 0.121_954_1),
        ("motor_load", 0.198_005_54),
        ("external_load", 0.022_215_53),
        ("motor_load_stribeck", 0.198_599_7),
        ("external_load_stribeck", 0.087_103_28),
        ("motor_quadratic", 0.009_999_93),
        ("external_quadratic", 7.326_92e-5),
        ("stribeck_velocity", 1.746_325_2),
        ("stribeck_exponent", 1.142_827_8),
    ],
];

/// The most that friction resists with besides the viscous part, written from the paper's equations: `m` and `e` are the
/// torques of motor and load along the joint, `w` its velocity.
fn most(numbers: Numbers, m: f64, e: f64, w: f64) -> f64 {
    let n = |name: &str| {
        let found = numbers.iter().find(|(known, _)| *known == name);
        found.map_or(0.0, |(_, value)| *value)
    };
    let still = if n("stribeck_velocity") > 0.0 {
        (-(w / n("stribeck_velocity"))
            .abs()
            .powf(n("stribeck_exponent")))
        .exp()
    } else {
        0.0
    };
    let quadratic = if m * e >= 0.0 {
        0.0
    } else if e.abs() < m.abs() {
        n("external_quadratic") * e * e
    } else {
        n("motor_quadratic") * m * m
    };
    let load = (m - e).abs();
    n("coulomb")
        + n("load") * load
        + (n("motor_load") * m - n("external_load") * e).abs()
        + still
            * (n("stribeck")
                + n("load_stribeck") * load
                + (n("motor_load_stribeck") * m - n("external_load_stribeck") * e).abs()
                + quadratic)
}

/// Mass, kg, and length, m, of the arm, which turns about a level axis at its end; at 0 it is level.
const ARM: (f64, f64) = (0.32, 0.4);

fn weight() -> f64 {
    ARM.0 * f64::from(gravity()) * 0.5 * ARM.1
}

fn arm_inertia() -> f64 {
    ARM.0 * ((ARM.1 * ARM.1 + 0.04 * 0.04) / 12.0 + 0.25 * ARM.1 * ARM.1)
}

fn awake() -> PhysicsConfig {
    PhysicsConfig {
        sleeping: false,
        ..PhysicsConfig::default()
    }
}

fn arm(numbers: Numbers, (position, velocity): (f64, f64)) -> (Run, JointId) {
    let mut build = Build::room([4.0, 3.0, 4.0]);
    let arm = Piece::cuboid(Vec3::new(0.2, 0.02, 0.02), Vec3::new(2.2, 2.0, 1.0));
    let arm = build.object("arm", Mobility::Articulated, &[arm]);
    let at = Vec3::new(2.0, 2.0, 1.0);
    let joint = build.joint(arm, JointKind::Hinge, Vec3::Z, at, [-1.0, 1.0]);
    build.data.joints[joint].limits = None;
    build.data.joints[joint].servo = Some(Servo {
        max_effort: 100.0,
        ..Servo::default()
    });
    let house = build.house();
    let mut state = State::new(&house);
    state.laws = vec![spec("joint_friction", None, numbers)];
    let mut run = Run::from_state(house, awake(), state);
    run.state.joint_position[joint] = position as f32;
    run.state.joint_velocity[joint] = velocity as f32;
    run.world.adopt_state(&mut run.state).unwrap();
    (run, joint)
}

/// The same arm by its equation of motion `I dw/dt = m + e(q) - viscous w - friction`, in steps of 10 us, friction
/// stopping it where it can.
fn solved(numbers: Numbers, start: (f64, f64), m: f64, times_s: &[f64]) -> Vec<(f64, f64)> {
    let dt = 1e-5;
    let viscous = numbers
        .iter()
        .find(|(name, _)| *name == "viscous")
        .unwrap()
        .1;
    let (mut q, mut w) = start;
    let mut out = Vec::new();
    let mut step = 0_u32;
    for time in times_s {
        while f64::from(step) * dt < time - 0.5 * dt {
            let e = -weight() * q.cos();
            let stop = most(numbers, m, e, w) * dt / arm_inertia();
            let free = w + (m + e - viscous * w) * dt / arm_inertia();
            w = free - free.clamp(-stop, stop);
            q += w * dt;
            step += 1;
        }
        out.push((q, w));
    }
    out
}

/// Thrown around, swinging out and coming to rest, with the motor giving nothing, pushing along and pushing against:
/// under each of the six models the arm goes where its equation of motion takes it.
#[test]
fn an_arm_coasts_down_under_each_model_as_its_equation_says() {
    let times: Vec<f64> = (1..=40).map(|k| f64::from(k) * 0.05).collect();
    for (model, numbers) in MX106.iter().enumerate() {
        for (start, torque) in [
            ((-FRAC_PI_2, 9.0), 0.0),
            ((-FRAC_PI_2, 5.0), 0.3),
            ((0.5, 0.0), -0.4),
        ] {
            let expected = solved(numbers, start, torque, &times);
            let (mut run, joint) = arm(numbers, start);
            run.state.joint_command[joint] = JointCommand::Effort(torque as f32);
            let (mut worst_q, mut worst_w) = (0.0_f64, 0.0_f64);
            for (q, w) in &expected {
                run.steps(1);
                let now = f64::from(run.state.joint_position[joint]);
                let speed = f64::from(run.state.joint_velocity[joint]);
                worst_q = worst_q.max((now - q).abs());
                worst_w = worst_w.max((speed - w).abs());
            }
            let (end, _) = expected[39];
            println!(
                "M{} {start:?} {torque}: {worst_q:.4} rad {worst_w:.4} rad/s, ends at {end:.3}",
                model + 1
            );
            // A hundredth of the swing. Steps of 1/120 s: where the arm turns round, friction does so within one.
            assert!(
                worst_q < 0.025 && worst_w < 0.12,
                "M{}: {worst_q} {worst_w}",
                model + 1
            );
        }
    }
}

/// Level and at rest, with a motor that gives `m` against the load `e`, the joint stays while `|m + e|` is within the
/// model's bound at rest, and moves beyond it, upwards and downwards.
#[test]
fn a_loaded_joint_holds_within_its_friction_and_breaks_away_beyond_it() {
    let e = -weight();
    for (model, numbers) in MX106.iter().enumerate() {
        for up in [1.0, -1.0] {
            // The torque at which up * (m + e) is the bound; beyond it the difference grows with m in this model or not.
            let left = |m: f64| up * (m + e) - most(numbers, m, e, 0.0);
            let (mut low, mut high) = (-e, -e + up * 2.0);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if left(middle) > 0.0 {
                    high = middle;
                } else {
                    low = middle;
                }
            }
            let breaks = low;
            for (off, moves) in [(-0.004, false), (0.004, true)] {
                let torque = breaks + up * off;
                let (mut run, joint) = arm(numbers, (0.0, 0.0));
                run.state.joint_command[joint] = JointCommand::Effort(torque as f32);
                run.steps(40);
                let q = f64::from(run.state.joint_position[joint]);
                println!(
                    "M{} breaks away at {breaks:.4} N m; at {torque:.4} it is at {q:.2e}",
                    model + 1
                );
                if moves {
                    // 2 s under what is left over.
                    assert!(up * q > 0.05, "M{} {torque}: {q}", model + 1);
                } else {
                    assert!(q.abs() < 1e-5, "M{} {torque}: {q}", model + 1);
                }
            }
        }
    }
}

/// Position motors with stiff gains hold under friction that answers to load, and come no nearer to their target than
/// friction lets them: the model may not chatter.
#[test]
fn a_stiff_servo_comes_to_rest_under_friction_that_answers_to_load() {
    for numbers in MX106 {
        let (mut run, joint) = arm(numbers, (0.0, 0.0));
        run.state.joint_command[joint] = JointCommand::Position(0.8);
        let house = run.house.clone();
        for (name, value) in [("stiffness", 300.0), ("damping", 12.0)] {
            let address = format!("joint/0/{name}").parse().unwrap();
            run.state.set_parameter(&house, &address, value).unwrap();
        }
        run.world.apply_parameters(&mut run.state).unwrap();
        run.steps(60);
        let rest = run.state.joint_position[joint];
        run.steps(20);
        let off = f64::from(run.state.joint_position[joint]) - 0.8;
        assert!(
            (run.state.joint_position[joint] - rest).abs() < 1e-5,
            "{off}"
        );
        let (e, m) = (-weight() * 0.8_f64.cos(), -300.0 * off);
        assert!((m + e).abs() <= most(numbers, m, e, 0.0) + 0.01, "{off}");
    }
}

/// Position and velocity of the elbow, which turns about the vertical, after each control step.
fn told(
    numbers: &[(&str, f64)],
    steps: usize,
    command: impl Fn(usize) -> JointCommand,
) -> Vec<(f32, f32)> {
    let house = tower().house();
    let mut state = State::new(&house);
    if !numbers.is_empty() {
        let law: LawSpec = spec("motor_constants", Some("elbow"), numbers);
        state.laws = vec![law];
    }
    let mut run = Run::from_state(house, awake(), state);
    let joint = run.house.joints.ids().next().unwrap();
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

/// With power and no command back-EMF brakes as `e^(-(n k_t)^2 / R t / I)`; with the motor off it does not.
#[test]
fn back_emf_brakes_only_a_motor_that_has_power() {
    // BAM's identified values of an STS3215, of whose resistance fifty times is taken so that the decay can be seen.
    let (k_t, resistance) = (1.211_641_4, 50.0 * 2.676_166_3);
    let numbers = [("k_t", k_t), ("resistance_ohm", resistance)];
    let braked = |after: JointCommand| {
        let run = told(&numbers, 12, |step| {
            if step < 2 {
                JointCommand::Effort(0.2)
            } else {
                after
            }
        });
        f64::from(run[11].1 / run[1].1)
    };
    let expected = (-k_t * k_t / resistance * 0.5 / arm_inertia()).exp();
    let found = braked(JointCommand::Effort(0.0));
    assert!((found / expected - 1.0).abs() < 2e-3, "{found} {expected}");
    assert!((braked(JointCommand::Off) - 1.0).abs() < 1e-4);
}

/// Told more than it can give, a motor nears the speed `V / (n k_t)` as `1 - e^(-(n k_t)^2 / R t / I)`.
#[test]
fn a_motor_reaches_the_speed_at_which_back_emf_takes_its_supply() {
    let (k_t, gear, supply, resistance) = (0.1, 2.0, 0.3, 0.4);
    let numbers = [
        ("k_t", k_t),
        ("gear", gear),
        ("supply_v", supply),
        ("resistance_ohm", resistance),
    ];
    let top = supply / (gear * k_t);
    let rate = (gear * k_t) * (gear * k_t) / resistance / arm_inertia();
    // The elbow has stops: 1 s.
    let run = told(&numbers, 20, |_| JointCommand::Effort(50.0));
    for (step, (_, velocity)) in run.iter().enumerate() {
        let t = (step + 1) as f64 * 0.05;
        let expected = top * (1.0 - (-rate * t).exp());
        assert!(
            (f64::from(*velocity) - expected).abs() < 2e-3 * top,
            "{t}: {velocity} {expected}"
        );
    }
    assert!(
        (f64::from(run[19].1) / top - 1.0).abs() < 5e-3,
        "{} {top}",
        run[19].1
    );
}

/// The scale of the torque, the stall torque `n k_t V / R` and the rotor's `n^2 J` act as the equation says.
#[test]
fn torque_scale_supply_and_rotor_change_the_acceleration() {
    let velocity = |numbers: &[(&str, f64)], effort: f32| {
        f64::from(told(numbers, 4, |_| JointCommand::Effort(effort))[3].1)
    };
    let free = |effort: f64, inertia: f64| effort / inertia * 0.2;
    let found = velocity(&[("torque_scale", 0.8)], 0.1);
    assert!(
        (found / free(0.08, arm_inertia()) - 1.0).abs() < 1e-3,
        "{found}"
    );
    // Stall torque 4 * 0.001 * 12 / 1 = 0.048 N m; its back-EMF is 1.6e-5 N m s/rad.
    let supply = [("k_t", 0.001), ("gear", 4.0), ("supply_v", 12.0)];
    let found = velocity(&supply, 0.1);
    assert!(
        (found / free(0.048, arm_inertia()) - 1.0).abs() < 1e-3,
        "{found}"
    );
    let found = velocity(&[("gear", 10.0), ("rotor_inertia_kg_m2", 1e-4)], 0.1);
    assert!(
        (found / free(0.1, arm_inertia() + 0.01) - 1.0).abs() < 1e-3,
        "{found}"
    );
}

/// Under its own weight the joint stands `compliance * torque` below where the motor is, which stands where it is told if
/// it carries the weight ahead and `torque / stiffness` below if not.
#[test]
fn what_gives_deflects_in_proportion_to_the_load() {
    for (compliance, feed_forward) in [(0.01, true), (0.05, true), (0.05, false), (0.0, false)] {
        let mut build = Build::room([4.0, 3.0, 4.0]);
        let arm = Piece::cuboid(Vec3::new(0.2, 0.02, 0.02), Vec3::new(2.2, 2.0, 1.0));
        let arm = build.object("arm", Mobility::Articulated, &[arm]);
        let at = Vec3::new(2.0, 2.0, 1.0);
        let joint = build.joint(arm, JointKind::Hinge, Vec3::Z, at, [-1.0, 1.0]);
        build.data.joints[joint].servo = Some(Servo {
            stiffness: 80.0,
            damping: 4.0,
            max_effort: 100.0,
            feed_forward,
            ..Servo::default()
        });
        let house = build.house();
        let mut state = State::new(&house);
        state.laws = vec![spec(
            "joint_compliance",
            None,
            &[("compliance", compliance)],
        )];
        let mut run = Run::from_state(house, awake(), state);
        for target in [0.0_f64, 0.7] {
            run.state.joint_command[joint] = JointCommand::Position(target as f32);
            run.steps(60);
            let q = f64::from(run.state.joint_position[joint]);
            let torque = weight() * q.cos();
            let servo = if feed_forward { 0.0 } else { torque / 80.0 };
            let expected = target - compliance * torque - servo;
            assert!(
                (q - expected).abs() < 1e-4,
                "{compliance} {target}: {q} {expected}"
            );
        }
    }
}
