//! Tosses of a box rolled out, each predicted by parameters that others chose:
//!
//! `cargo run -p dwell-calibration --example tosses -- NAME.measured OUT [--options JSON] [--models A,B] [PEER.csv ...]`
//!
//! docs/cube-tosses.md says how the bundle is made.

use dwell_calibration::rollout::study::{self, PeerScores};
use dwell_calibration::rollout::{PoseTracks, study::StudyOptions};
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    let mut option = |name: &str| {
        let at = arguments.iter().position(|a| a == name)?;
        (at + 1 < arguments.len()).then(|| arguments.drain(at..at + 2).nth(1))?
    };
    let options = option("--options").unwrap_or_else(|| "{}".to_owned());
    let names = option("--models");
    let wanted = |name: &str| {
        names
            .as_ref()
            .is_none_or(|all| all.split(',').any(|n| n == name))
    };
    let [measured, out, peers @ ..] = &arguments[..] else {
        return Err(
            "usage: tosses NAME.measured OUT [--options JSON] [--models A,B] [PEER.csv ...]".into(),
        );
    };
    let (measured, out) = (Path::new(measured), Path::new(out));
    let sentence = tosses(measured, out, &options, wanted, peers)?;
    eprintln!("{sentence}");
    Ok(())
}

fn told(done: f32, what: &str) -> bool {
    eprintln!("{:3.0} % {what}", 100.0 * done);
    true
}

fn tosses(
    measured: &Path,
    out: &Path,
    options: &str,
    wanted: impl Fn(&str) -> bool,
    peers: &[String],
) -> Result<String, Box<dyn Error>> {
    let options: StudyOptions = serde_json::from_str(options)?;
    let mut models = study::models();
    models.extend(study::further_models());
    models.retain(|model| wanted(model.name));
    let peers: Result<Vec<PeerScores>, _> = peers
        .iter()
        .map(|p| PeerScores::read(Path::new(p)))
        .collect();
    let tracks = PoseTracks::read(measured)?;
    let report = study::run(&tracks, &models, &peers?, &options, &mut told)?;
    report.write(out)?;
    Ok(report.sentence)
}
