//! Fuzzing of everything that reads a house: samples in every format, mutations of their files, and what has to hold of each.
//!
//! The bodies are used by `tests/tests/fuzzing.rs` with mutations of its own, and by the targets of cargo-fuzz in `fuzz/`.

mod bodies;
mod mutate;
mod samples;

pub use bodies::{Ended, fuzz, live_in, read};
pub use mutate::mutated;
pub use samples::{NAMES, Sample, sample};
