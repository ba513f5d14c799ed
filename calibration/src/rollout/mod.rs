//! Roll-outs: a measured motion is put into the simulation, which predicts what comes after it.
//!
//! Whole episodes start where the bundle says ([`scores`]); windows ([`predict_windows`]) start at any sample and look 1 to 40 samples
//! ahead. Tosses of a box onto a board ([`PoseTracks`]) are rolled out; a [`study`] compares models of their contact.

mod board_rig;
mod box_plot;
pub(crate) mod html;
mod initial_state;
mod motion;
mod pose_tracks;
mod refine;
mod regime;
mod residuals;
mod score;
pub mod study;
mod subject;
mod summary;
mod windows;

pub use board_rig::{BoardRig, RigSettings, STEPS_PER_SAMPLE};
pub use initial_state::{TrackerNoise, window_start};
pub use motion::{Deviation, MotionState};
pub use pose_tracks::{PoseTrack, PoseTracks, TrackedBody};
pub use refine::{REFINEMENT_FACTOR, StepRefinementEffect, step_refinement_effects};
pub use regime::ContactRegime;
pub use residuals::{Quantiles, ResidualGroup, ResidualGroups};
pub use score::{MeanDeviation, deviations, diverges_under_noise, scores};
pub use subject::RolloutSubject;
pub use summary::{EpisodeStatistics, ScoreSummary};
pub use windows::{
    HORIZONS, WindowOptions, WindowPrediction, WindowScore, predict_windows, window_scores,
};
