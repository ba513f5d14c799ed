//! The report: what was measured against what was simulated, in numbers, words and pictures.

mod boxes;
mod build;
mod data;
mod html;
pub(crate) mod page;
mod plot;
mod svg;
mod write;

pub(crate) use build::build;
pub use data::{Candidate, Effect, Fitted, Found, Nuisance, Plot, Report, Verdict};
pub(crate) use write::whole;
