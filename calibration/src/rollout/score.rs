//! Whole episodes: roll out from the start to the last sample, and compare.

use super::board_rig::BoardRig;
use super::initial_state::window_start;
use super::motion::{Deviation, MotionState};
use super::pose_tracks::{PoseTrack, PoseTracks};
use super::subject::RolloutSubject;
use crate::error::CalibrationError;
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use serde::Serialize;

/// Means over the samples of an episode, from its start to its last sample.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct MeanDeviation {
    /// Distance, as a share of the body's width.
    pub position_widths: f64,
    /// Angle, degrees.
    pub rotation_deg: f64,
    /// [`Deviation::e_q`].
    pub e_q: f64,
    /// Squared distance, m².
    pub position_square_m2: f64,
    /// Squared angle, rad².
    pub rotation_square_rad2: f64,
}

impl MeanDeviation {
    fn from_deviations(deviations: &[Deviation], half_width_m: f64) -> Self {
        let count = deviations.len().max(1) as f64;
        let mean = |f: &dyn Fn(&Deviation) -> f64| deviations.iter().map(f).sum::<f64>() / count;
        Self {
            position_widths: mean(&|d| d.position_m) / (2.0 * half_width_m),
            rotation_deg: mean(&|d| d.rotation_rad).to_degrees(),
            e_q: mean(&|d| d.e_q(half_width_m)),
            position_square_m2: mean(&|d| d.position_m * d.position_m),
            rotation_square_rad2: mean(&|d| d.rotation_rad * d.rotation_rad),
        }
    }
}

/// The deviations of an episode's roll-out, sample by sample, the start (no deviation) first.
///
/// # Errors
/// [`CalibrationError::Simulation`] for a start that is not finite.
pub fn deviations(rig: &BoardRig, track: &PoseTrack) -> Result<Vec<Deviation>, CalibrationError> {
    let ahead = &track.motions[track.start + 1..];
    let rolled = rig.simulate(&track.start_motion, ahead.len())?;
    let rest = rolled
        .iter()
        .zip(ahead)
        .map(|(p, m)| Deviation::between(p, m));
    Ok(std::iter::once(Deviation::default()).chain(rest).collect())
}

/// The scores of the episodes `which`, in that order.
///
/// # Errors
/// As [`deviations`].
///
/// # Determinism
/// The same bits for any number of threads.
pub fn scores(
    rig: &BoardRig,
    tracks: &PoseTracks,
    which: &[usize],
    threads: Threads,
) -> Result<Vec<MeanDeviation>, CalibrationError> {
    let half_width_m = tracks.body.half_width_m();
    let one = |k: usize| {
        let deviations = deviations(rig, &tracks.episodes[which[k]])?;
        Ok(MeanDeviation::from_deviations(&deviations, half_width_m))
    };
    threads.map(which.len(), one).into_iter().collect()
}

/// Number of times that the chaos guard starts an episode once more.
const NUDGES: u64 = 4;

/// Returns whether each of the episodes `which` ends elsewhere ([`RolloutSubject::divergence_threshold`]) when its start is drawn from within the
/// tracker's noise: which way it goes is chance then.
///
/// # Errors
/// As [`deviations`].
///
/// # Determinism
/// The same bits for any number of threads.
pub fn diverges_under_noise(
    rig: &BoardRig,
    tracks: &PoseTracks,
    which: &[usize],
    key: RandomKey,
    threads: Threads,
) -> Result<Vec<bool>, CalibrationError> {
    let limit = tracks.divergence_threshold();
    let one = |k: usize| {
        let track = &tracks.episodes[which[k]];
        let samples = track.motions.len() - track.start - 1;
        let last = |start: &MotionState| {
            let rolled = rig.simulate(start, samples)?;
            Ok::<_, CalibrationError>(rolled.last().copied().unwrap_or(*start))
        };
        let estimate = |nudge: Option<RandomKey>| {
            let (step_s, g) = (tracks.step_s(), tracks.gravity_m_s2);
            window_start(track, track.start, step_s, g, &tracks.noise, nudge)
        };
        let (known, plain) = (estimate(None), last(&track.start_motion)?);
        for nudge in 0..NUDGES {
            let other = estimate(Some(key.child(which[k] as u64).child(nudge)));
            // The stated start, moved as the noise moves an estimate of it.
            let turned = other.rotation * known.rotation.inverse();
            let start = MotionState {
                position: track.start_motion.position + other.position - known.position,
                rotation: (turned * track.start_motion.rotation).normalize(),
                linear: track.start_motion.linear + other.linear - known.linear,
                angular: track.start_motion.angular + other.angular - known.angular,
            };
            if Deviation::between(&last(&start)?, &plain).exceeds(&limit) {
                return Ok(true);
            }
        }
        Ok(false)
    };
    threads.map(which.len(), one).into_iter().collect()
}
