//! Fuzzing of everything that reads a house: samples in every format, mutations of their files, and what has to hold of each.
//!
//! The bodies are used by `tests/tests/it/fuzzing.rs` with mutations of its own, and by the targets of cargo-fuzz in `fuzz/`, which
//! also read the files beside houses.

mod bodies;
mod mutate;
mod samples;
mod targets;

pub use bodies::{exercise_house, read};
pub use mutate::mutated;
pub use samples::{NAMES, Sample, sample};
pub use targets::{OTHERS, fuzz, seed_corpus, seeds};
