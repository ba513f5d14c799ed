//! Effects hidden in runs of a servo by an independent integrator, and the verdicts they must get.

#![expect(
    clippy::unwrap_used,
    reason = "a test stops at the first surprise, in its helpers too"
)]

use crate::calibration_support;

use calibration_support::{Files, Random, runge_kutta, table};
use dwell_calibration::{CalibrationOptions, CalibrationReport, CalibrationVerdict, calibrate};

const INERTIA: f64 = 0.004;
const STIFFNESS: f64 = 1.6;
const DAMPING: f64 = 0.12;
const TORQUE: f64 = 3.0;
const RUNS: usize = 8;
const NOISE_RAD: f64 = 0.001;
const RATE_HZ: f64 = 50.0;
const DURATION_S: f64 = 3.0;

#[derive(Clone, Copy)]
struct Joint {
    /// Half the play of the gear, rad.
    play: f64,
    /// Coulomb friction, N·m.
    friction: f64,
    /// The controller's clock runs ahead of the encoder's, s; `None`: both are one clock.
    offset_s: Option<f64>,
    /// Delay and lag of the motor, s.
    delay_s: f64,
    lag_s: f64,
    /// How fast the motor's target follows the command, rad/s.
    max_rate: f64,
    /// Error of position up to which the motor gives nothing, rad.
    deadband: f64,
    /// Strongest torque, N·m.
    max_torque: f64,
    torque_scale: f64,
    /// Yield of the motor's drive, rad/(N·m).
    compliance: f64,
    /// A spring in series with a slider beside the joint: N·m, N·m/rad.
    slider: [f64; 2],
}

impl Default for Joint {
    fn default() -> Self {
        Self {
            play: 0.0,
            friction: 0.0,
            offset_s: Some(0.0),
            delay_s: 0.0,
            lag_s: 0.0,
            max_rate: f64::INFINITY,
            deadband: 0.0,
            max_torque: TORQUE,
            torque_scale: 1.0,
            compliance: 0.0,
            slider: [0.0, 1.0],
        }
    }
}

/// The target at a time: a sum of two sines and a step, of its own in every run.
fn target(run: &[f64; 6], t: f64) -> f64 {
    run[0] * (run[1] * t).sin()
        + run[2] * (run[3] * t).sin()
        + if t > run[5] { run[4] } else { 0.0 }
}

fn runs(joint: Joint, seed: u64) -> CalibrationReport {
    let mut random = Random::new(seed);
    let mut files = Files::new(format!(
        r#"{{"version": 1, "title": "servo", "licence": "CC0-1.0", "kind": "servo",
            "scene": {{"joints": [{{"name": "elbow", "inertia_kg_m2": {INERTIA}, "stiffness_n_m_rad": {STIFFNESS},
                                    "damping_n_m_s_rad": {DAMPING}, "max_torque_n_m": {TORQUE}}}]}},
            "channels": [{{"name": "position", "unit": "rad", "clock": {:?}, "noise_sd": null}}]}}"#,
        if joint.offset_s.is_some() {
            "encoder"
        } else {
            "controller"
        }
    ));
    let ahead_s = joint.offset_s.unwrap_or(0.0);
    for index in 0..RUNS {
        let name = format!("r{index}");
        files.episode(&name, &format!("g{}", index / 2));
        let run = [
            random.range(0.2, 0.6),
            random.range(1.0, 3.0),
            random.range(0.05, 0.15),
            random.range(4.0, 9.0),
            random.range(-0.4, 0.4),
            random.range(1.0, 2.5),
        ];
        // Ten substeps a command, a hundred commands a second.
        let (mut now, mut output) = ([0.0, 0.0], 0.0_f64);
        let mut told = std::collections::VecDeque::new();
        let (mut followed, mut limited, mut slider) = (0.0_f64, 0.0_f64, 0.0_f64);
        let mut u = 0.0;
        let h = 0.001;
        for step in 0..(DURATION_S / h) as usize {
            let t = step as f64 * h;
            if step % 10 == 0 {
                u = target(&run, t);
                files.command(&name, 5.0 + t + ahead_s, "elbow", u);
            }
            told.push_back(u);
            let late = if told.len() > (joint.delay_s / h).round() as usize {
                told.pop_front().unwrap()
            } else {
                0.0
            };
            limited += (late - limited).clamp(-joint.max_rate * h, joint.max_rate * h);
            followed = if joint.lag_s > 0.0 {
                limited + (followed - limited) * (-h / joint.lag_s).exp()
            } else {
                limited
            };
            // The play operator: the output keeps its place until the input pushes it from either side.
            output = output.clamp(followed - joint.play, followed + joint.play);
            if step % (1.0 / RATE_HZ / h) as usize == 0 {
                files.sample(
                    &name,
                    5.0 + t,
                    "elbow",
                    "position",
                    now[0] + NOISE_RAD * random.normal(),
                );
            }
            let soft = 1.0 + STIFFNESS * joint.compliance;
            let rates = |_: f64, s: &[f64; 2]| {
                let off = output - s[0];
                let asked = STIFFNESS / soft * off - DAMPING / (soft * soft) * s[1];
                let most = joint.max_torque.min(TORQUE);
                let push = if off.abs() < joint.deadband {
                    0.0
                } else {
                    (joint.torque_scale * asked).clamp(-most, most)
                };
                // Coulomb friction, smooth over a thousandth of a radian a second.
                let hold = joint.friction * (s[1] / 0.001).tanh();
                [s[1], (push - hold - slider) / INERTIA]
            };
            let before = now[0];
            for sub in 0..8 {
                now = runge_kutta(now, t + f64::from(sub) * h / 8.0, h / 8.0, &rates);
            }
            let [most, spring] = joint.slider;
            slider = (slider + spring * (now[0] - before)).clamp(-most, most);
        }
    }
    let folder = tempfile::tempdir().unwrap();
    files.write(folder.path());
    calibrate(
        folder.path(),
        &CalibrationOptions {
            seed,
            ..CalibrationOptions::default()
        },
        &mut |_, _| true,
    )
    .unwrap()
}

/// Clocks 10 ms apart; with `DWELL_TEST_ALL=1` three seeds, 0, 10 and 20 ms apart: the offset is a nuisance and is no effect.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn backlash_is_named_with_its_width() {
    let seeds = if dwell_tests::runs_all() {
        1..=3
    } else {
        2..=2_u8
    };
    for seed in seeds {
        let offset_s = 0.01 * (f64::from(seed) - 1.0);
        let report = runs(
            Joint {
                play: 0.02,
                offset_s: Some(offset_s),
                ..Joint::default()
            },
            seed.into(),
        );
        println!("seed {seed}: {}", table(&report));
        let CalibrationVerdict::Named { law, effects, gain } = &report.verdict else {
            panic!("{}", table(&report));
        };
        assert_eq!(
            (law.as_str(), effects.len()),
            ("backlash", 1),
            "{}",
            table(&report)
        );
        let width = effects[0].parameters[0].value;
        assert!((width / 0.02 - 1.0).abs() < 0.05, "{}", table(&report));
        assert!(gain.share > 0.5, "{}", table(&report));
        let laws = report.found_laws();
        assert_eq!((laws.len(), laws[0].target.as_deref()), (1, Some("elbow")));
        let found = report.nuisances[0].value;
        // The clocks' distance, and the half step by which commands are held.
        assert!((found - offset_s).abs() < 0.006, "{found} {offset_s}");
    }
}

#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn friction_is_not_taken_for_backlash() {
    let report = runs(
        Joint {
            friction: 0.05,
            ..Joint::default()
        },
        11,
    );
    println!("{}", table(&report));
    match &report.verdict {
        CalibrationVerdict::Named { law, effects, .. } => {
            assert_eq!(law, "joint_friction", "{}", table(&report));
            assert!(
                (effects[0].parameters[0].value / 0.05 - 1.0).abs() < 0.15,
                "{}",
                table(&report)
            );
        }
        // A slider behind a stiff spring is Coulomb friction.
        CalibrationVerdict::OneOf { sets, .. } => {
            let ids: Vec<&str> = sets.iter().flatten().map(String::as_str).collect();
            assert!(
                ids.contains(&"joint_friction")
                    && ids
                        .iter()
                        .all(|id| ["joint_friction", "joint_hysteresis"].contains(id)),
                "{}",
                table(&report)
            );
        }
        other => panic!("{other:?} {}", table(&report)),
    }
}

/// A seed with a clock offset, and three more with `DWELL_TEST_ALL=1`: no name, and nothing unexplained.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn nothing_is_found_where_nothing_is_hidden() {
    let seeds = if dwell_tests::runs_all() {
        21..=24
    } else {
        22..=22
    };
    for seed in seeds {
        let joint = Joint {
            offset_s: Some(if seed % 2 == 0 { 0.015 } else { 0.0 }),
            ..Joint::default()
        };
        let report = runs(joint, seed);
        assert_eq!(
            report.verdict,
            CalibrationVerdict::NoEffect,
            "seed {seed}: {}",
            table(&report)
        );
    }
}

/// A joint in which a law acts that is hidden by other code, with the value of its first parameter that must be found.
fn hidden(law: &str) -> (Joint, f64) {
    let one_clock = Joint {
        offset_s: None,
        ..Joint::default()
    };
    match law {
        "backlash" => (
            Joint {
                play: 0.02,
                ..one_clock
            },
            0.02,
        ),
        "latency" => (
            Joint {
                delay_s: 0.04,
                ..one_clock
            },
            0.04,
        ),
        "first_order_lag" => (
            Joint {
                lag_s: 0.05,
                ..one_clock
            },
            0.05,
        ),
        "rate_limit" => (
            Joint {
                max_rate: 1.0,
                ..one_clock
            },
            1.0,
        ),
        "deadband" => (
            Joint {
                deadband: 0.03,
                ..one_clock
            },
            0.03,
        ),
        "saturation" => (
            Joint {
                max_torque: 0.25,
                ..one_clock
            },
            0.25,
        ),
        "joint_friction" => (
            Joint {
                friction: 0.05,
                ..one_clock
            },
            0.05,
        ),
        "motor_constants" => (
            Joint {
                torque_scale: 0.7,
                ..one_clock
            },
            0.7,
        ),
        "joint_compliance" => (
            Joint {
                compliance: 0.4,
                ..one_clock
            },
            0.4,
        ),
        "joint_hysteresis" => (
            Joint {
                slider: [0.05, 2.0],
                ..one_clock
            },
            0.05,
        ),
        _ => panic!("no case hides {law}: a law that nothing finds must not be added"),
    }
}

/// Each law of joints, hidden alone, is named, or stands in the set of those that cannot be told apart; one of them, all
/// with `DWELL_TEST_ALL=1`.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn every_law_of_a_joint_is_found() {
    let sample = ["latency"];
    let laws = dwell_physics::laws::all().filter(|law| law.acts_on == "joint");
    for law in laws {
        let (joint, value) = hidden(law.id);
        if !dwell_tests::runs_all() && !sample.contains(&law.id) {
            continue;
        }
        let report = runs(joint, 61);
        println!("{}: {}", law.id, table(&report));
        match &report.verdict {
            CalibrationVerdict::Named {
                law: found,
                effects,
                ..
            } => {
                assert_eq!(
                    (found.as_str(), effects.len()),
                    (law.id, 1),
                    "{}",
                    table(&report)
                );
                let found = effects[0].parameters[0].value;
                assert!((found / value - 1.0).abs() < 0.15, "{}", table(&report));
            }
            CalibrationVerdict::OneOf { sets, .. } => {
                assert!(
                    sets.contains(&vec![law.id.to_owned()]),
                    "{}",
                    table(&report)
                );
            }
            other => panic!("{}: {other:?} {}", law.id, table(&report)),
        }
    }
}
