//! Oracles and helpers for the tests of several modules.

pub mod coincident;
pub mod meshes;
pub mod overlap;
