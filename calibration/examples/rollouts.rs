//! Real motions rolled out: tosses of a box, drives of a robot, falling balls, each predicted by parameters that others
//! chose:
//!
//! `cargo run -p dwell-calibration --example roll_outs -- NAME.measured OUT [--options JSON] [--models A,B] [PEER.csv ...]`
//!
//! docs/cube-tosses.md, docs/robot-odometry.md and docs/ball-drops.md say how the bundles are made.

use dwell_calibration::bundle::file::BundleKind;
use dwell_calibration::rollout::drive::{self, DriveRecordings};
use dwell_calibration::rollout::drop::BallDrops;
use dwell_calibration::rollout::series::{self, ModelledSubject, SimulationModel};
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
            "usage: roll_outs NAME.measured OUT [--options JSON] [--models A,B] [PEER.csv ...]"
                .into(),
        );
    };
    let (measured, out) = (Path::new(measured), Path::new(out));
    let sentence = match dwell_calibration::check_bundle(measured)?.0 {
        BundleKind::PoseTrajectory => tosses(measured, out, &options, wanted, peers)?,
        BundleKind::Drive => {
            let drives = DriveRecordings::read(measured)?;
            tried(&drives, drive::models(), out, &options, wanted)?
        }
        BundleKind::Trajectory => {
            let drops = BallDrops::read(measured)?;
            let models = drops.models();
            tried(&drops, models, out, &options, wanted)?
        }
        other => return Err(format!("{other:?} is explained by `dwell calibrate`").into()),
    };
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

fn tried<S: ModelledSubject>(
    subject: &S,
    mut models: Vec<SimulationModel>,
    out: &Path,
    options: &str,
    wanted: impl Fn(&str) -> bool,
) -> Result<String, Box<dyn Error>> {
    models.retain(|model| wanted(model.name));
    let report = series::run(subject, &models, &serde_json::from_str(options)?, &mut told)?;
    report.write(out)?;
    Ok(report.sentence)
}
