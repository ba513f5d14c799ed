//! Roll-outs: a measured motion is put into the simulation, which predicts what comes after it.
//!
//! Whole episodes start where the bundle says ([`scores`]); [`windows`] start at any sample and look 1 to 40 samples
//! ahead.

mod motion;
mod regime;
mod rig;
mod score;
pub mod study;
mod summary;
mod track;
mod windows;

pub use motion::{Deviation, Motion};
pub use regime::Regime;
pub use rig::{Rig, STEPS_PER_SAMPLE, Settings};
pub use score::{Score, deviations, scores};
pub use summary::{Spread, Summary};
pub use track::{Nominal, Track, TrackedBody, Tracks};
pub use windows::{HORIZONS, WindowScore, window_start, windows};
