//! Subjects of roll-outs: measured motions, and a simulation that predicts them.

use super::motion::{Deviation, MotionState};
use super::regime::ContactRegime;
use crate::error::CalibrationError;
use dwell_scene::random::RandomKey;

/// Measured episodes with a simulation that starts from any of their samples.
pub trait RolloutSubject: Sync {
    /// The simulation, set to some values.
    type Rig: Send + Sync;

    /// Returns the number of episodes.
    fn count(&self) -> usize;

    /// Returns the measured motion, at even spacing. Shape (sample,).
    fn measured(&self, episode: usize) -> &[MotionState];

    /// Returns the regime at each sample. Shape (sample,).
    fn regimes(&self, episode: usize) -> &[ContactRegime];

    /// The deviation beyond which two predictions are of different outcomes.
    fn divergence_threshold(&self) -> Deviation;

    /// The motions at the `samples` samples after the sample `at`. The state there is estimated from measurements up to
    /// it and none after; with a `nudge` it is drawn from within the uncertainty of that estimate.
    ///
    /// # Errors
    /// [`CalibrationError::Simulation`] for a start that is not finite.
    fn simulate(
        &self,
        rig: &Self::Rig,
        episode: usize,
        at: usize,
        samples: usize,
        nudge: Option<RandomKey>,
    ) -> Result<Vec<MotionState>, CalibrationError>;
}
