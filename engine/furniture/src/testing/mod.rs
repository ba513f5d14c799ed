//! Oracles and helpers for the tests of several modules.

pub mod meshes;
pub mod overlap;
