//! Windows: from every measured sample, some samples ahead.

use super::motion::{Deviation, MotionState};
use super::regime::ContactRegime;
use super::subject::RolloutSubject;
use crate::error::CalibrationError;
use crate::median::median;
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use serde::Serialize;

/// Horizons of windows, samples.
pub const HORIZONS: [usize; 5] = [1, 5, 10, 20, 40];
/// Number of times that the chaos guard starts a window once more, from within the uncertainty of its start.
const NUDGES: u64 = 4;

/// The starts of windows, and their evaluation.
#[derive(Clone, Copy, Debug)]
pub struct WindowOptions {
    /// Samples from one start to the next.
    pub stride: usize,
    /// Seed of the chaos guard's nudges; `None`: no guard, nothing diverges.
    pub chaos_guard: Option<RandomKey>,
    /// Threads.
    pub threads: Threads,
}

/// One window's end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindowPrediction {
    /// The episode, and the sample that it started from.
    pub start: (usize, usize),
    /// Samples ahead.
    pub horizon: usize,
    /// The worst that the body does between start and end.
    pub regime: ContactRegime,
    /// Measured speed at the start, m/s.
    pub speed_m_s: f64,
    /// The prediction.
    pub predicted: MotionState,
    /// Its deviation from the measurement.
    pub deviation: Deviation,
    /// True if starts within the uncertainty of this one end elsewhere: the result is chance, and says little about
    /// the model.
    pub diverges: bool,
}

/// The deviations in windows of one horizon and regime.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WindowScore {
    /// Samples ahead.
    pub horizon: usize,
    /// The worst that the body does between start and end; `null`: all windows.
    pub regime: Option<ContactRegime>,
    /// True for the windows that the chaos guard marked, which are in no other row.
    pub diverging: bool,
    /// Number of windows.
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

fn predict_episode_windows<S: RolloutSubject>(
    subject: &S,
    rig: &S::Rig,
    episode: usize,
    windowing: &WindowOptions,
) -> Result<Vec<WindowPrediction>, CalibrationError> {
    let longest = HORIZONS.into_iter().max().unwrap_or(1);
    let (measured, regimes) = (subject.measured(episode), subject.regimes(episode));
    let last = measured.len().saturating_sub(1);
    let limit = subject.divergence_threshold();
    let mut ends = Vec::new();
    for at in (0..last).step_by(windowing.stride.max(1)) {
        let samples = longest.min(last - at);
        let plain = subject.simulate(rig, episode, at, samples, None)?;
        let mut nudged = Vec::new();
        if let Some(key) = windowing.chaos_guard {
            let key = key.child(episode as u64).child(at as u64);
            for nudge in 0..NUDGES {
                let key = Some(key.child(nudge));
                nudged.push(subject.simulate(rig, episode, at, samples, key)?);
            }
        }
        for horizon in HORIZONS.into_iter().filter(|h| *h <= plain.len()) {
            let predicted = plain[horizon - 1];
            ends.push(WindowPrediction {
                start: (episode, at),
                horizon,
                regime: ContactRegime::hardest(&regimes[at..=at + horizon]),
                speed_m_s: measured[at].linear.length(),
                predicted,
                deviation: Deviation::between(&predicted, &measured[at + horizon]),
                diverges: nudged.iter().any(|rolled| {
                    Deviation::between(&rolled[horizon - 1], &predicted).exceeds(&limit)
                }),
            });
        }
    }
    Ok(ends)
}

/// The ends of the windows of all episodes, each episode simulated by the rig at its place.
///
/// # Errors
/// [`CalibrationError::Simulation`] for a start that is not finite.
///
/// # Determinism
/// The same bits for any number of threads.
pub fn predict_windows<S: RolloutSubject>(
    subject: &S,
    rigs: &[&S::Rig],
    windowing: &WindowOptions,
) -> Result<Vec<WindowPrediction>, CalibrationError> {
    let one = |episode: usize| predict_episode_windows(subject, rigs[episode], episode, windowing);
    let found = windowing.threads.map(subject.count(), one);
    let found: Result<Vec<Vec<WindowPrediction>>, _> = found.into_iter().collect();
    Ok(found?.concat())
}

/// Returns the deviations of the windows, by horizon and regime; those that diverge apart.
pub fn window_scores(ends: &[WindowPrediction]) -> Vec<WindowScore> {
    let mut scores = Vec::new();
    for horizon in HORIZONS {
        let regimes = std::iter::once(None).chain(ContactRegime::ALL.map(Some));
        let steady = regimes.map(|regime| (regime, false));
        for (regime, diverging) in steady.chain([(None, true)]) {
            let here = ends.iter().filter(|end| {
                end.horizon == horizon
                    && end.diverges == diverging
                    && regime.is_none_or(|regime| end.regime == regime)
            });
            let deviations: Vec<Deviation> = here.map(|end| end.deviation).collect();
            if !deviations.is_empty() {
                scores.push(score(horizon, regime, diverging, &deviations));
            }
        }
    }
    scores
}

fn score(
    horizon: usize,
    regime: Option<ContactRegime>,
    diverging: bool,
    deviations: &[Deviation],
) -> WindowScore {
    let mut mm: Vec<f64> = deviations.iter().map(Deviation::position_mm).collect();
    let mut degrees: Vec<f64> = deviations.iter().map(Deviation::rotation_deg).collect();
    WindowScore {
        horizon,
        regime,
        diverging,
        count: deviations.len(),
        position_rms_mm: rms(&mm),
        position_median_mm: median(&mut mm),
        rotation_rms_deg: rms(&degrees),
        rotation_median_deg: median(&mut degrees),
    }
}

fn rms(values: &[f64]) -> f64 {
    let squares: f64 = values.iter().map(|v| v * v).sum();
    (squares / values.len().max(1) as f64).sqrt()
}
