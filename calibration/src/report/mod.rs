//! The report: what was measured against what was simulated, in numbers, words and pictures.

mod build;
mod data;
mod html;
pub(crate) mod page;
mod plot;
pub(crate) mod svg;
mod write;

pub(crate) use build::build;
pub use data::{
    CalibrationReport, CalibrationVerdict, CandidateCause, FittedParameter, FoundEffects,
    NamedEffect, NuisanceParameter, Provenance, ResidualPlot,
};
pub(crate) use write::write_atomically;
