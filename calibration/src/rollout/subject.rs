//! Subjects of roll-outs: measured motions, and a simulation that predicts them.

use super::motion::{Deviation, MeasuredMotion};
use super::regime::Regime;
use crate::error::CalibrationError;
use dwell_scene::random::RandomKey;

/// Measured episodes with a simulation that starts from any of their samples.
pub trait RolloutSubject: Sync {
    /// The simulation, set to some values.
    type Rig: Send + Sync;

    /// Returns how many episodes.
    fn count(&self) -> usize;

    /// Returns what was measured, at even spacing. Shape (sample,).
    fn measured(&self, episode: usize) -> &[MeasuredMotion];

    /// Returns what the body did at each sample. Shape (sample,).
    fn regimes(&self, episode: usize) -> &[Regime];

    /// Samples before a start that its state is estimated from and that must be there.
    fn past(&self) -> usize;

    /// Apart by more than this, two predictions are of different outcomes.
    fn divergence(&self) -> Deviation;

    /// Returns how many samples ahead a residual tells most: pictures show that horizon, one of [`HORIZONS`](super::HORIZONS).
    fn telling_horizon(&self) -> usize {
        10
    }

    /// The motions at the `samples` samples after the sample `at`. The state there is estimated from measurements up to
    /// it and none after; with a `nudge` it is drawn from within the uncertainty of that estimate.
    ///
    /// # Errors
    /// [`CalibrationError::Simulation`] for a start that is not finite.
    fn roll(
        &self,
        rig: &Self::Rig,
        episode: usize,
        at: usize,
        samples: usize,
        nudge: Option<RandomKey>,
    ) -> Result<Vec<MeasuredMotion>, CalibrationError>;
}
