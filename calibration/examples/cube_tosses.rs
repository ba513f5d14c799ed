//! Real tosses of a box onto a board, studied: `cargo run -p dwell-calibration --example cube_tosses -- cube_toss.measured
//! OUT [PEER.csv ...]`. docs/cube-tosses.md says how the bundle and the peer's scores are made.

use dwell_calibration::rollout::Tracks;
use dwell_calibration::rollout::study::{Peer, StudyOptions, models, run};
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [measured, out, peers @ ..] = &arguments[..] else {
        return Err("usage: cube_tosses NAME.measured OUT [PEER.csv ...]".into());
    };
    let tracks = Tracks::read(Path::new(measured))?;
    let peers: Result<Vec<Peer>, _> = peers.iter().map(|p| Peer::read(Path::new(p))).collect();
    let options = StudyOptions::default();
    let report = run(&tracks, &models(), &peers?, &options, &mut |done, what| {
        eprintln!("{:3.0} % {what}", 100.0 * done);
        true
    })?;
    report.write(Path::new(out))?;
    eprintln!("{}", report.sentence);
    Ok(())
}
