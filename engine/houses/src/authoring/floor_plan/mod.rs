//! A building from a plan: rooms with their floors free of walls; the space between them is wall.
//!
//! `data` is the data, `grid` divides storeys into room, wall and air, `walls` cuts the walls into straight stretches, `construct` makes
//! the house of them, with the walls, slabs, doors and windows of generated houses.

mod construct;
mod data;
mod finishes;
mod grid;
mod openings;
mod walls;

pub(super) use construct::build_house_data;
pub use data::{
    BuildingPlan, CardinalDirection, DoorLeaf, DoorPlan, HingeSide, OUTSIDE, RoomPlan, StairsPlan,
    StoreyPlan, SurfaceFinish, WindowPlan,
};
