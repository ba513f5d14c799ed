//! What several modules' tests share: oracles and helpers.

pub(crate) mod meshes;
pub(crate) mod overlap;
