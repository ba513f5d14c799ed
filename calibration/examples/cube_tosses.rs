//! Real tosses of a box onto a board, studied:
//!
//! `cargo run -p dwell-calibration --example cube_tosses -- NAME.measured OUT [--options JSON] [--models A,B] [PEER.csv ...]`
//!
//! docs/cube-tosses.md says how the bundle and the peer's scores are made.

use dwell_calibration::rollout::Tracks;
use dwell_calibration::rollout::study::{Peer, StudyOptions, models, run};
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    let mut option = |name: &str| {
        let at = arguments.iter().position(|a| a == name)?;
        (at + 1 < arguments.len()).then(|| arguments.drain(at..at + 2).nth(1))?
    };
    let options: StudyOptions = match option("--options") {
        Some(text) => serde_json::from_str(&text)?,
        None => StudyOptions::default(),
    };
    let mut chosen = models();
    if let Some(names) = option("--models") {
        chosen.retain(|model| names.split(',').any(|name| name == model.name));
    }
    let [measured, out, peers @ ..] = &arguments[..] else {
        return Err(
            "usage: cube_tosses NAME.measured OUT [--options JSON] [--models A,B] [PEER.csv ...]"
                .into(),
        );
    };
    let tracks = Tracks::read(Path::new(measured))?;
    let peers: Result<Vec<Peer>, _> = peers.iter().map(|p| Peer::read(Path::new(p))).collect();
    let report = run(&tracks, &chosen, &peers?, &options, &mut |done, what| {
        eprintln!("{:3.0} % {what}", 100.0 * done);
        true
    })?;
    report.write(Path::new(out))?;
    eprintln!("{}", report.sentence);
    Ok(())
}
