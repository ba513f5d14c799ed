//! Where an agent can walk: surfaces by storey from the real geometry, shortest ways, doors, reachable points.
//!
//! Every triangle is clipped against the columns of a grid, so that thin legs and wall edges are never missed (the method
//! of Recast's height fields). A surface of a column is walkable where it is flat enough, has the agent's height free above
//! it and no obstacle higher than a step within the agent's radius, other than stairs and slopes that it climbs. Several
//! surfaces may lie above each other: storeys are joined where steps lead from one to the other.

mod clip;
mod columns;
mod config;
mod distances;
mod doors;
mod grid;
mod ground;
mod layers;
mod obstacles;
mod route;
mod sight;

pub use config::{Doors, NavConfig};
pub use distances::DistanceField;
pub use doors::Door;
pub use grid::{Cell, NavGrid, Occupancy, Rebuilt};
pub use route::Route;
