//! Real measurements, where they are there: eleven balls dropped from a bridge (de Silva et al., Front. Artif. Intell. 3:25,
//! 2020). The data stay outside of the repository.

#![expect(
    clippy::unwrap_used,
    reason = "a test stops at the first surprise, in its helpers too"
)]

use crate::calibration_support;

use calibration_support::Files;
use dwell_calibration::{CalibrationOptions, CalibrationVerdict, calibrate};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::PathBuf;

fn shared_data() -> PathBuf {
    std::env::var_os("DWELL_SHARED_DATA").map_or_else(
        || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared/data"),
        PathBuf::from,
    )
}

/// Rows of a table as cells.
fn rows(path: &std::path::Path) -> Vec<Vec<String>> {
    let text = std::fs::read_to_string(path).unwrap();
    text.lines()
        .skip(1)
        .map(|line| line.split(',').map(str::to_owned).collect())
        .collect()
}

/// A physicist accepts: quadratic drag with the coefficient of balls (0.05 past the drag crisis to 1 for a pierced one), that
/// drag cannot be told from something else, or that one coefficient does not serve all balls. Not: nothing.
#[test]
#[ignore = "long: make test runs one of eight shares of these, make test-all all"]
fn falling_balls_get_a_defensible_verdict() {
    let folder = shared_data().join("measured/physics/ball_drops");
    if !folder.join("data.csv").exists() {
        println!("SKIPPED: no measured data at {}", folder.display());
        return;
    }
    let index = rows(&folder.join("index.csv"));
    let mut bodies = BTreeMap::new();
    let mut ball_of = BTreeMap::new();
    for row in &index {
        if let (Ok(mass), Ok(diameter)) = (row[2].parse::<f64>(), row[3].parse::<f64>()) {
            bodies.insert(row[1].clone(), (mass, 0.5 * diameter));
            ball_of.insert(row[0].clone(), row[1].clone());
        }
    }
    let mut list = String::new();
    for (name, (mass, radius)) in &bodies {
        let comma = if list.is_empty() { "" } else { "," };
        write!(
            list,
            r#"{comma}{{"name": "{name}", "mass_kg": {mass}, "radius_m": {radius}}}"#
        )
        .unwrap();
    }
    let mut files = Files::new(format!(
        r#"{{"version": 1, "title": "balls dropped from a bridge", "licence": "MIT", "kind": "trajectory",
            "scene": {{"bodies": [{list}]}},
            "channels": [{{"name": "y", "unit": "m", "clock": "camera", "noise_sd": null}}]}}"#
    ));
    for (episode, ball) in &ball_of {
        files.episode(episode, ball);
    }
    let mut falling = BTreeMap::new();
    for row in rows(&folder.join("data.csv")) {
        let Some(ball) = ball_of.get(&row[0]) else {
            continue;
        };
        let number = |k: usize| row[k].parse::<f64>().unwrap();
        // The first samples may precede the release.
        let released = falling.entry(row[0].clone()).or_insert(false);
        *released |= number(3) < -3.0;
        if *released {
            files.sample(&row[0], number(1), ball, "y", number(2));
        }
    }
    let bundle = tempfile::tempdir().unwrap();
    files.write(bundle.path());
    let report = calibrate(
        bundle.path(),
        &CalibrationOptions::default(),
        &mut |_, _| true,
    )
    .unwrap();
    println!("ball drops: {}", report.sentence);
    for candidate in &report.candidates {
        let p = &candidate.parameters[0];
        println!(
            "  {} {} = {:.4} ({:.4} to {:.4}), fall of BIC {:.1}, held-out share {:?}",
            candidate.id,
            p.name,
            p.value,
            p.interval[0],
            p.interval[1],
            candidate.delta_bic,
            candidate.gain.map(|gain| gain.share)
        );
    }
    match &report.verdict {
        CalibrationVerdict::Named { law, effects, .. } => {
            assert_eq!(law, "drag");
            let c_d = effects[0].parameters[0].value;
            assert!((0.05..1.0).contains(&c_d), "{c_d}");
        }
        CalibrationVerdict::OneOf { laws, .. } => {
            assert!(laws.contains(&"drag".to_owned()), "{laws:?}");
        }
        CalibrationVerdict::Unexplained { reason } => assert!(!reason.is_empty()),
        CalibrationVerdict::NoEffect => panic!("{}", report.sentence),
    }
}
