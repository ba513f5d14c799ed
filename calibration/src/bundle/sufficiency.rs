//! Checks that a bundle holds enough: what its kind needs, in every episode, and no episode too long.

use super::check::missing;
use super::file::BundleKind;
use super::{Bundle, jumps, odometry, poses, unit_checks};
use crate::error::CalibrationError;

type CheckResult = Result<(), CalibrationError>;

/// Episodes below which nothing can be held out.
const FEWEST_EPISODES: usize = 4;
/// Poses of an episode below which nothing can be predicted from them.
const FEWEST_POSES: usize = 6;

/// Checks that the data suffice.
pub(super) fn check_sufficient_data(bundle: &Bundle) -> CheckResult {
    let scene = &bundle.manifest.scene;
    let at = format!("{}/manifest.json", bundle.name);
    match bundle.kind() {
        BundleKind::Trajectory if scene.bodies.is_empty() => {
            return Err(missing(
                &at,
                "scene.bodies",
                "a trajectory needs the body that flew",
            ));
        }
        BundleKind::Trajectory if scene.bodies.iter().any(|body| body.radius_m.is_none()) => {
            return Err(missing(
                &at,
                "scene.bodies[].radius_m",
                "free flight is computed for spheres",
            ));
        }
        BundleKind::Servo if scene.joints.len() != 1 || !scene.bodies.is_empty() => {
            return Err(CalibrationError::field(
                at,
                "scene.joints",
                scene.joints.len(),
                "exactly one joint, and no bodies",
            ));
        }
        BundleKind::Trajectory | BundleKind::Servo if bundle.manifest.channels.is_empty() => {
            return Err(missing(
                &at,
                "channels",
                "what the numbers mean must be said",
            ));
        }
        _ => {}
    }
    let found = bundle.episodes.len();
    if found < FEWEST_EPISODES {
        let (at, needed) = (bundle.name.clone(), FEWEST_EPISODES);
        return Err(CalibrationError::TooFew {
            at,
            what: "episodes",
            found,
            needed,
        });
    }
    for episode in &bundle.episodes {
        let at = format!("{}, episode {}", bundle.name, episode.name);
        match bundle.kind() {
            BundleKind::ImpulseResponse
                if episode.responses.is_empty() && episode.arrivals.is_empty() =>
            {
                let needed = "every episode needs an impulse response";
                return Err(missing(&at, "a row of ir.csv", needed));
            }
            BundleKind::Trajectory | BundleKind::Servo if episode.samples.len() < 6 => {
                let (what, found, needed) = ("rows of trajectory.csv", episode.samples.len(), 6);
                return Err(CalibrationError::TooFew {
                    at,
                    what,
                    found,
                    needed,
                });
            }
            BundleKind::PoseTrajectory if episode.poses.len() < FEWEST_POSES => {
                let (what, found, needed) =
                    ("rows of poses.csv", episode.poses.len(), FEWEST_POSES);
                return Err(CalibrationError::TooFew {
                    at,
                    what,
                    found,
                    needed,
                });
            }
            BundleKind::Trajectory
                if episode
                    .samples
                    .iter()
                    .any(|s| s.entity != episode.samples[0].entity) =>
            {
                return Err(CalibrationError::field(
                    at,
                    "entity",
                    "more than one",
                    "one body an episode",
                ));
            }
            BundleKind::Servo if episode.commands.is_empty() => {
                return Err(missing(
                    &at,
                    "a row of command.csv",
                    "a servo's episode needs its commands",
                ));
            }
            _ => {}
        }
        let mut channels = episode.samples.chunk_by(|a, b| a.channel == b.channel);
        channels.try_for_each(|samples| {
            let times: Vec<f64> = samples.iter().map(|s| s.t_s).collect();
            unit_checks::check_sample_times(&at, &times)
        })?;
    }
    match bundle.kind() {
        BundleKind::PoseTrajectory => {
            // To the check of velocities a number that stands for nothing looks like a wrong unit.
            jumps::check_places(&bundle.name, &bundle.manifest, &bundle.episodes)?;
            poses::check_poses(&bundle.name, &bundle.manifest, &bundle.episodes)?;
        }
        BundleKind::Drive => {
            odometry::check_drives(&bundle.name, &bundle.manifest, &bundle.episodes)?;
        }
        BundleKind::Servo => {
            jumps::check_servos(&bundle.name, &bundle.manifest, &bundle.episodes)?;
        }
        BundleKind::Trajectory | BundleKind::ImpulseResponse => {}
    }
    durations(bundle)?;
    let (name, manifest, episodes) = (&bundle.name, &bundle.manifest, &bundle.episodes);
    unit_checks::check_falls(name, manifest, episodes)?;
    jumps::check_places(name, manifest, episodes)?;
    unit_checks::check_bounces(name, manifest, episodes)
}

/// Checks that no episode is longer than can be computed.
fn durations(bundle: &Bundle) -> CheckResult {
    for episode in &bundle.episodes {
        let samples = episode.samples.iter().map(|s| s.t_s);
        let poses = episode.poses.iter().map(|p| p.t_s);
        let drive = episode.drive.iter().map(|row| row.t_s);
        let times: Vec<f64> = samples.chain(poses).chain(drive).collect();
        let span = |f: fn(f64, f64) -> f64, from: f64| times.iter().copied().fold(from, f);
        let duration = span(f64::max, f64::NEG_INFINITY) - span(f64::min, f64::INFINITY);
        if duration > 600.0 {
            return Err(CalibrationError::field(
                format!("{}, episode {}", bundle.name, episode.name),
                "the time from first to last sample",
                duration,
                "at most 600 s",
            ));
        }
    }
    Ok(())
}
