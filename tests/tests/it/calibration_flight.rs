//! Effects hidden in throws by an independent integrator, and the verdicts they must get.

#![expect(
    clippy::unwrap_used,
    reason = "a test stops at the first surprise, in its helpers too"
)]

use crate::calibration_support;

use calibration_support::{Files, Random, runge_kutta, table};
use dwell_calibration::{CalibrationOptions, CalibrationReport, CalibrationVerdict, calibrate};
use dwell_scene::LawInfo;
use std::f64::consts::TAU;

/// The forces on the ball besides gravity.
#[derive(Clone, Copy)]
struct World {
    gravity: f64,
    /// Quadratic drag.
    c_d: f64,
    /// Linear drag, 1/s.
    linear: f64,
    /// A fan that is switched on and off: sideways acceleration, m/s².
    fan: f64,
    /// The air's velocity along x and z, m/s.
    wind: [f64; 2],
    /// Coefficient of the lift by spin; the spin is measured where it is not 0.
    c_l: f64,
    /// Density of the air that carries the ball, kg/m³.
    fluid_kg_m3: f64,
    mass_kg: f64,
    radius_m: f64,
    /// What the tracker writes: lengths, times, and a lean of its vertical about z, rad.
    length_scale: f64,
    clock_scale: f64,
    tilt_rad: f64,
    /// Lowest and highest speed of throws, m/s.
    speeds: [f64; 2],
    noise_m: f64,
    heavy_tails: bool,
}

const QUIET: World = World {
    gravity: 9.806_65,
    c_d: 0.0,
    linear: 0.0,
    fan: 0.0,
    wind: [0.0; 2],
    c_l: 0.0,
    fluid_kg_m3: 0.0,
    mass_kg: 0.0577,
    radius_m: 0.033,
    length_scale: 1.0,
    clock_scale: 1.0,
    tilt_rad: 0.0,
    speeds: [2.0, 8.0],
    noise_m: 0.002,
    heavy_tails: false,
};

const THROWS: usize = 15;
const RATE_HZ: f64 = 90.0;

/// Throws of a tennis ball in `world`, calibrated.
fn throws(world: World, seed: u64) -> CalibrationReport {
    let mut random = Random::new(seed);
    let World {
        mass_kg, radius_m, ..
    } = world;
    let spin_channels = if world.c_l == 0.0 {
        String::new()
    } else {
        ["wx", "wy", "wz"]
            .map(|name| {
                format!(r#", {{"name": "{name}", "unit": "rad/s", "clock": "c", "noise_sd": 0.5}}"#)
            })
            .concat()
    };
    let mut files = Files::new(format!(
        r#"{{"version": 1, "title": "throws", "licence": "CC0-1.0", "kind": "trajectory",
            "scene": {{"environment": {{"temperature_c": 20.0, "pressure_pa": 101325.0}},
                       "bodies": [{{"name": "ball", "mass_kg": {mass_kg}, "radius_m": {radius_m}}}]}},
            "channels": [{{"name": "x", "unit": "m", "clock": "c", "noise_sd": null}},
                         {{"name": "y", "unit": "m", "clock": "c", "noise_sd": null}},
                         {{"name": "z", "unit": "m", "clock": "c", "noise_sd": {}}}{spin_channels}]}}"#,
        world.noise_m
    ));
    // Dry air at 20 degrees Celsius and 101,325 Pa.
    let area = std::f64::consts::PI * radius_m * radius_m;
    let drag = 0.5 * 1.2041 * world.c_d * area / mass_kg;
    let lift = 0.5 * 1.2041 * world.c_l * area * radius_m / mass_kg;
    let displaced =
        world.fluid_kg_m3 * 4.0 / 3.0 * std::f64::consts::PI * radius_m.powi(3) / mass_kg;
    // Half of the displaced mass moves along.
    let fall = world.gravity * (1.0 - displaced) / (1.0 + 0.5 * displaced);
    for throw in 0..THROWS {
        let name = format!("t{throw}");
        files.episode(&name, &format!("s{}", throw / 2));
        let speed = random.range(world.speeds[0], world.speeds[1]);
        let (up, around) = (random.range(0.2, 1.2), random.range(0.0, TAU));
        let mut now = [
            0.0,
            random.range(1.0, 1.5),
            0.0,
            speed * up.cos() * around.cos(),
            speed * up.sin(),
            speed * up.cos() * around.sin(),
        ];
        let gust = random.range(0.0, TAU);
        let spin = if world.c_l == 0.0 {
            [0.0; 3]
        } else {
            [0; 3].map(|_| random.range(-60.0, 60.0))
        };
        let rates = |t: f64, s: &[f64; 6]| {
            let air = [s[3] - world.wind[0], s[4], s[5] - world.wind[1]];
            let v = (air[0] * air[0] + air[1] * air[1] + air[2] * air[2]).sqrt();
            let slow = drag * v + world.linear;
            let fan = world.fan * (14.0 * t + gust).sin();
            [
                s[3],
                s[4],
                s[5],
                -slow * air[0] + fan + lift * (spin[1] * air[2] - spin[2] * air[1]),
                -slow * air[1] - fall + lift * (spin[2] * air[0] - spin[0] * air[2]),
                -slow * air[2] + lift * (spin[0] * air[1] - spin[1] * air[0]),
            ]
        };
        let (sin, cos) = world.tilt_rad.sin_cos();
        let samples = (RATE_HZ * random.range(0.5, 0.8)) as usize;
        for k in 0..samples {
            let t = k as f64 / RATE_HZ;
            let stamp = 3.0 + world.clock_scale * t;
            let leaning = [
                cos * now[0] - sin * now[1],
                sin * now[0] + cos * now[1],
                now[2],
            ];
            for (axis, channel) in ["x", "y", "z"].iter().enumerate() {
                let noise = if world.heavy_tails {
                    random.heavy()
                } else {
                    random.normal()
                };
                let written = world.length_scale * leaning[axis] + world.noise_m * noise;
                files.sample(&name, stamp, "ball", channel, written);
            }
            if world.c_l != 0.0 {
                for (axis, channel) in ["wx", "wy", "wz"].iter().enumerate() {
                    let written = spin[axis] + 0.5 * random.normal();
                    files.sample(&name, stamp, "ball", channel, written);
                }
            }
            for sub in 0..8 {
                let h = 1.0 / RATE_HZ / 8.0;
                now = runge_kutta(now, t + f64::from(sub) * h, h, &rates);
            }
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

/// The first parameter of the first effect: value and 95 % interval.
fn named(report: &CalibrationReport, law: &str) -> (f64, [f64; 2]) {
    let CalibrationVerdict::Named {
        law: found,
        effects,
        ..
    } = &report.verdict
    else {
        panic!("{law} was hidden: {}", table(report));
    };
    assert_eq!(
        (found.as_str(), effects.len()),
        (law, 1),
        "{}",
        table(report)
    );
    let parameter = &effects[0].parameters[0];
    (parameter.value, parameter.interval)
}

/// Five seeds; the interval of 95 % may miss once in twenty, so a tolerance of 5 % stands beside it.
/// Two seeds, one with heavy tails; five with `DWELL_TEST_ALL=1`.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn quadratic_drag_is_named_with_its_coefficient() {
    for seed in 1..=if dwell_tests::runs_all() { 5 } else { 2 } {
        let world = World {
            c_d: 0.5,
            heavy_tails: seed % 2 == 0,
            ..QUIET
        };
        let report = throws(world, seed);
        let (c_d, [low, high]) = named(&report, "drag");
        assert!(
            (low..=high).contains(&0.5) || (c_d / 0.5 - 1.0).abs() < 0.05,
            "{}",
            table(&report)
        );
        println!("seed {seed}: {}", table(&report));
        let laws = report.found_laws();
        assert_eq!((laws.len(), laws[0].id.as_str()), (1, "drag"));
        let drag = LawInfo::find(dwell_physics::laws::all(), "drag").unwrap();
        laws[0].check(drag).unwrap();
    }
}

#[test]
fn linear_drag_gets_its_own_name() {
    let report = throws(
        World {
            linear: 0.2,
            ..QUIET
        },
        21,
    );
    let (rate, _) = named(&report, "viscous_damping");
    assert!((rate / 0.2 - 1.0).abs() < 0.05, "{}", table(&report));
    assert_eq!(report.found_laws()[0].target.as_deref(), Some("ball"));
}

/// Flights alone do not tell gravity from scales of lengths and of the clock: g s / tau² is all that they show.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn gravity_and_scales_are_not_told_apart_by_flights() {
    let report = throws(
        World {
            gravity: 9.78,
            noise_m: 0.0005,
            ..QUIET
        },
        22,
    );
    let CalibrationVerdict::OneOf { sets, .. } = &report.verdict else {
        panic!("{}", table(&report));
    };
    for id in ["gravity", "length_scale", "clock_scale"] {
        assert!(sets.contains(&vec![id.to_owned()]), "{}", table(&report));
    }
    assert!(report.found_parameters().is_empty());
    let gravity = report
        .candidates
        .iter()
        .find(|c| c.id == "gravity")
        .unwrap();
    assert!(
        (gravity.parameters[0].value - 9.78).abs() < 0.02,
        "{}",
        table(&report)
    );
    // No place on Earth has this gravity: what is off is the measurement.
    let report = throws(
        World {
            gravity: 9.6,
            ..QUIET
        },
        23,
    );
    let CalibrationVerdict::OneOf { laws, .. } = &report.verdict else {
        panic!("{}", table(&report));
    };
    assert!(!laws.contains(&"gravity".to_owned()), "{}", table(&report));
    assert!(laws.contains(&"length_scale".to_owned()) && laws.contains(&"clock_scale".to_owned()));
}

/// Ten seeds, half of them with heavy tails: no name, and nothing unexplained.
/// Three seeds, one with heavy tails; ten with `DWELL_TEST_ALL=1`.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn nothing_is_found_where_nothing_is_hidden() {
    for seed in 31..=if dwell_tests::runs_all() { 40 } else { 33 } {
        let report = throws(
            World {
                heavy_tails: seed % 2 == 0,
                ..QUIET
            },
            seed,
        );
        assert_eq!(
            report.verdict,
            CalibrationVerdict::NoEffect,
            "seed {seed}: {}",
            table(&report)
        );
        assert!(report.found_laws().is_empty() && report.found_parameters().is_empty());
    }
}

/// At one low speed and with much noise, drag by v and by v² are one.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn what_cannot_be_told_apart_is_said_to_be_so() {
    let world = World {
        c_d: 0.5,
        speeds: [4.0, 4.2],
        noise_m: 0.006,
        ..QUIET
    };
    let report = throws(world, 41);
    println!("{}", table(&report));
    let CalibrationVerdict::OneOf {
        laws,
        separating_experiments,
        ..
    } = &report.verdict
    else {
        panic!("{}", table(&report));
    };
    assert!(
        laws.contains(&"drag".to_owned()) && laws.len() == separating_experiments.len(),
        "{laws:?}"
    );
    assert!(report.found_laws().is_empty());
}

#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn a_cause_outside_of_the_library_gets_no_name() {
    for seed in [51, 52] {
        let report = throws(World { fan: 4.0, ..QUIET }, seed);
        println!("{}", table(&report));
        assert!(
            matches!(report.verdict, CalibrationVerdict::Unexplained { .. }),
            "{}",
            table(&report)
        );
        assert!(report.found_laws().is_empty());
    }
    // Drag that no shape of this size has.
    let report = throws(
        World {
            c_d: 9.0,
            speeds: [2.0, 4.0],
            ..QUIET
        },
        53,
    );
    assert!(
        matches!(report.verdict, CalibrationVerdict::Unexplained { .. }),
        "{}",
        table(&report)
    );
    assert!(report.sentence.contains("plausible"), "{}", table(&report));
}

#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn the_report_is_one_page_and_the_same_for_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let hidden = dwell_calibration::example::write(folder.path(), 3).unwrap();
    let mut fractions = Vec::new();
    let run = |threads, fractions: &mut Vec<f32>| {
        let options = CalibrationOptions {
            threads: Some(threads),
            ..CalibrationOptions::default()
        };
        calibrate(folder.path(), &options, &mut |fraction, _| {
            fractions.push(fraction);
            true
        })
        .unwrap()
    };
    let (one, two) = (run(1, &mut fractions), run(2, &mut Vec::new()));
    assert_eq!(one.to_json(), two.to_json());
    assert!(fractions.windows(2).all(|pair| pair[0] <= pair[1]) && fractions.last() == Some(&1.0));
    println!("{hidden} / {}", one.sentence);
    named(&one, "drag");
    let page = one.to_html();
    assert!(page.contains("<svg") && !page.contains("http") && !page.contains("<script"));
    let json: serde_json::Value = serde_json::from_str(&one.to_json()).unwrap();
    assert_eq!(json["verdict"]["kind"], "named");
    assert_eq!(json["html"], page.as_str());
    let out = tempfile::tempdir().unwrap();
    one.write(out.path()).unwrap();
    let found: serde_json::Value =
        serde_json::from_slice(&std::fs::read(out.path().join("found.json")).unwrap()).unwrap();
    assert_eq!(found["version"], 1);
    assert_eq!(found["laws"][0]["id"], "drag");
    assert_eq!(std::fs::read_dir(out.path()).unwrap().count(), 3);
}

#[test]
fn the_caller_can_stop_it() {
    let folder = tempfile::tempdir().unwrap();
    dwell_calibration::example::write(folder.path(), 1).unwrap();
    let mut calls = 0;
    let stopped = calibrate(
        folder.path(),
        &CalibrationOptions::default(),
        &mut |_, _| {
            calls += 1;
            calls < 5
        },
    );
    assert!(matches!(
        stopped,
        Err(dwell_calibration::CalibrationError::Interrupted)
    ));
}

/// Each law of bodies in flight and each fault of a tracker, hidden alone by other code, is named or stands in the set of
/// those that cannot be told apart.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn every_law_of_flight_and_every_fault_of_a_tracker_is_found() {
    let spinning = World { c_l: 1.0, ..QUIET };
    let balloon = World {
        mass_kg: 0.02,
        radius_m: 0.1,
        fluid_kg_m3: 1.2,
        speeds: [1.0, 3.0],
        ..QUIET
    };
    let hidden = |id: &str| match id {
        "drag" => World { c_d: 0.5, ..QUIET },
        "viscous_damping" => World {
            linear: 0.2,
            ..QUIET
        },
        "magnus" => spinning,
        "buoyancy" => balloon,
        "wind" => World {
            c_d: 1.0,
            wind: [0.9, -0.7],
            ..QUIET
        },
        "length_scale" => World {
            length_scale: 1.01,
            ..QUIET
        },
        "clock_scale" => World {
            clock_scale: 0.99,
            ..QUIET
        },
        "frame_tilt" => World {
            tilt_rad: 0.02,
            ..QUIET
        },
        // Spheres that nothing touches show neither.
        "center_of_mass_offset" | "inertia_error" => QUIET,
        _ => panic!("no case hides {id}: a law that nothing finds must not be added"),
    };
    let flight = dwell_scene::law::LawRegime::Flight;
    let laws = dwell_physics::laws::all()
        .filter(|law| law.acts_on == "object" && law.regimes.contains(&flight))
        .map(|law| law.id);
    for id in laws.chain(["length_scale", "clock_scale", "frame_tilt"]) {
        let report = throws(hidden(id), 71);
        println!("{id}: {}", table(&report));
        if ["center_of_mass_offset", "inertia_error"].contains(&id) {
            assert_eq!(
                report.verdict,
                CalibrationVerdict::NoEffect,
                "{}",
                table(&report)
            );
            continue;
        }
        match &report.verdict {
            CalibrationVerdict::Named { law, effects, .. } => {
                assert_eq!((law.as_str(), effects.len()), (id, 1), "{}", table(&report));
            }
            CalibrationVerdict::OneOf { sets, .. } => {
                assert!(
                    sets.contains(&vec![id.to_owned()]),
                    "{id}: {}",
                    table(&report)
                );
            }
            other => panic!("{id}: {other:?} {}", table(&report)),
        }
    }
}
