//! Roll-outs: a measured motion is put into the simulation, which predicts what comes after it.
//!
//! Whole episodes start where the bundle says ([`scores`]); windows ([`ends`]) start at any sample and look 1 to 40 samples
//! ahead. A [`Subject`] is what can be rolled out: tosses of a box onto a board ([`Tracks`]), a robot on two wheels
//! ([`drive`]), falling balls ([`mod@drop`]). Models of tosses are compared by a [`study`], those of the others by [`series`].

pub mod drive;
pub mod drop;
mod motion;
pub(crate) mod parts;
mod refine;
mod regime;
mod residuals;
mod rig;
mod score;
pub mod series;
mod start;
pub mod study;
mod subject;
mod summary;
mod track;
mod windows;

pub use motion::{Deviation, Motion};
pub use refine::{FINER, Refinement, refinements};
pub use regime::Regime;
pub use residuals::{Quantiles, ResidualGroup, Residuals};
pub use rig::{Rig, STEPS_PER_SAMPLE, Settings};
pub use score::{Score, deviations, diverging, scores};
pub use start::{Noise, window_start};
pub use subject::Subject;
pub use summary::{Spread, Summary};
pub use track::{Nominal, Track, TrackedBody, Tracks};
pub use windows::{End, HORIZONS, WindowScore, Windowing, ends, windows};
