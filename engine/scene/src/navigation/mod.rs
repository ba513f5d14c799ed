//! Where an agent can walk: a grid by storey from the real geometry, shortest paths, reachable points.
//!
//! Every triangle is clipped against the columns of the grid, so that thin legs and wall edges are never missed (the
//! method of Recast's height fields). A cell is walkable where a surface has the agent's height free above it and no
//! obstacle higher than a step within the agent's radius.

mod columns;
mod grid;
mod paths;

pub use grid::{Cell, Doors, NavConfig, NavGrid};
pub use paths::DistanceField;
