//! Windows: from every measured sample, some samples ahead.

use super::motion::{Deviation, Motion};
use super::regime::Regime;
use super::rig::Rig;
use super::track::{Track, Tracks};
use crate::error::CalibrationError;
use dwell_scene::parallel::Threads;
use glam::DVec3;
use serde::Serialize;

/// How many samples ahead windows look.
pub const HORIZONS: [usize; 5] = [1, 5, 10, 20, 40];
/// Samples of the past that a start in flight is fitted to, at most.
const PAST_SAMPLES: usize = 6;

/// The motion that a window starts from: the measured pose; in flight, velocities from the past samples of the same
/// flight (a recorded velocity is often a filtered difference, which lags), else those that were recorded.
///
/// The velocity is the slope at the end of a least-squares line through the past positions, freed from the parabola of
/// the fall; the angular velocity is the mean turn. Nothing after the start is looked at.
pub fn window_start(track: &Track, at: usize, step_s: f64, gravity_m_s2: f64) -> Motion {
    let measured = track.motions[at];
    let flight = (0..=at)
        .rev()
        .take(PAST_SAMPLES)
        .take_while(|k| track.regimes[*k] == Regime::Flight)
        .count();
    if flight < 3 {
        return measured;
    }
    let past = &track.motions[at + 1 - flight..=at];
    let fall = DVec3::NEG_Y * gravity_m_s2;
    // Times run backwards from the start, so that the slope of the line is the velocity there.
    let time = |k: usize| (k as f64 - (flight - 1) as f64) * step_s;
    let straight = |k: usize| past[k].position - 0.5 * fall * time(k) * time(k);
    let mean_t = (0..flight).map(time).sum::<f64>() / flight as f64;
    let spread: f64 = (0..flight).map(|k| (time(k) - mean_t).powi(2)).sum();
    let slope: DVec3 = (0..flight).map(|k| straight(k) * (time(k) - mean_t)).sum();
    let turned = crate::bundle::turn(past[0].rotation, measured.rotation);
    Motion {
        linear: slope / spread,
        angular: turned / ((flight - 1) as f64 * step_s),
        ..measured
    }
}

/// What windows of one horizon and regime deviate by.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WindowScore {
    /// Samples ahead.
    pub horizon: usize,
    /// The worst that the body does between start and end: an impact before contact before flight before rest;
    /// `null`: all windows.
    pub regime: Option<Regime>,
    /// How many windows.
    pub count: usize,
    /// Root mean square distance, mm.
    pub position_rms_mm: f64,
    /// Median distance, mm.
    pub position_median_mm: f64,
    /// Root mean square angle, degrees.
    pub rotation_rms_deg: f64,
    /// Median angle, degrees.
    pub rotation_median_deg: f64,
}

/// One window's end.
#[derive(Clone, Copy, Debug)]
struct End {
    horizon: usize,
    regime: Regime,
    deviation: Deviation,
}

/// The regime that decides about a window.
fn deciding(regimes: &[Regime]) -> Regime {
    let order = [Regime::Impact, Regime::Contact, Regime::Flight];
    let found = order.into_iter().find(|regime| regimes.contains(regime));
    found.unwrap_or(Regime::Rest)
}

fn ends(
    rig: &Rig,
    track: &Track,
    tracks: &Tracks,
    stride: usize,
) -> Result<Vec<End>, CalibrationError> {
    let longest = HORIZONS.into_iter().max().unwrap_or(1);
    let last = track.motions.len() - 1;
    let mut ends = Vec::new();
    for at in (0..last).step_by(stride.max(1)) {
        let start = window_start(track, at, tracks.step_s(), tracks.gravity_m_s2);
        let rolled = rig.roll(&start, longest.min(last - at))?;
        for horizon in HORIZONS.into_iter().filter(|h| *h <= rolled.len()) {
            ends.push(End {
                horizon,
                regime: deciding(&track.regimes[at..=at + horizon]),
                deviation: Deviation::between(&rolled[horizon - 1], &track.motions[at + horizon]),
            });
        }
    }
    Ok(ends)
}

/// Windows from every `stride`-th sample of the episodes `which`, each simulated by the rig at the same place of `rigs`,
/// by horizon and regime.
///
/// # Errors
/// [`CalibrationError::Simulation`] for a start that is not finite.
///
/// # Determinism
/// The same bits for any number of threads.
pub fn windows(
    rigs: &[&Rig],
    tracks: &Tracks,
    which: &[usize],
    stride: usize,
    threads: Threads,
) -> Result<Vec<WindowScore>, CalibrationError> {
    let one = |k: usize| ends(rigs[k], &tracks.episodes[which[k]], tracks, stride);
    let found: Result<Vec<Vec<End>>, _> = threads.map(which.len(), one).into_iter().collect();
    let found = found?.concat();
    let mut scores = Vec::new();
    for horizon in HORIZONS {
        let regimes = std::iter::once(None).chain(Regime::ALL.map(Some));
        for regime in regimes {
            let here = found.iter().filter(|end| {
                end.horizon == horizon && regime.is_none_or(|regime| end.regime == regime)
            });
            let deviations: Vec<Deviation> = here.map(|end| end.deviation).collect();
            if !deviations.is_empty() {
                scores.push(score(horizon, regime, &deviations));
            }
        }
    }
    Ok(scores)
}

fn score(horizon: usize, regime: Option<Regime>, deviations: &[Deviation]) -> WindowScore {
    let mut mm: Vec<f64> = deviations.iter().map(|d| 1e3 * d.position_m).collect();
    let mut degrees: Vec<f64> = deviations
        .iter()
        .map(|d| d.rotation_rad.to_degrees())
        .collect();
    WindowScore {
        horizon,
        regime,
        count: deviations.len(),
        position_rms_mm: rms(&mm),
        position_median_mm: crate::fit::median(&mut mm),
        rotation_rms_deg: rms(&degrees),
        rotation_median_deg: crate::fit::median(&mut degrees),
    }
}

fn rms(values: &[f64]) -> f64 {
    let squares: f64 = values.iter().map(|v| v * v).sum();
    (squares / values.len().max(1) as f64).sqrt()
}
