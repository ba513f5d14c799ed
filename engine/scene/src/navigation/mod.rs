//! Navigation of walking agents: walkable surfaces by storey from the real geometry, shortest paths, doors, reachable points.
//!
//! Every triangle is clipped against the columns of a grid, so that thin legs and wall edges are never missed (the method
//! of Recast's height fields). A surface of a column is walkable where it is flat enough, has the agent's height free above
//! it and no obstacle higher than a step within the agent's radius, other than stairs and slopes that it climbs. Several
//! surfaces may lie above each other: storeys are joined where steps lead from one to the other.

mod clip;
mod config;
mod distance_field;
mod doors;
mod grid;
mod heightfield;
mod layers;
mod map;
mod obstacles;
mod route;
mod static_grid;
mod straight_path;

pub use config::{DoorPolicy, NavConfig};
pub use distance_field::DistanceField;
pub use doors::NavDoor;
pub use grid::{NavCell, NavGrid, NavGridUpdate, Occupancy};
pub use map::ColumnFrame;
pub use route::Route;
