//! What several modules' tests share: oracles and helpers.

pub mod meshes;
pub mod overlap;
