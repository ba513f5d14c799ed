//! A building from a plan: rooms with their floors free of walls, what is left between them is wall.
//!
//! `plan` is the data, `grid` says what is room, wall and air, `walls` cuts the walls into straight stretches, `raise` makes
//! the house of them, with the walls, slabs, doors and windows of generated houses.

mod coverings;
mod grid;
mod openings;
mod plan;
mod raise;
mod walls;

pub use plan::{
    Building, Compass, Covering, Door, Hinge, Leaf, OUTSIDE, Room, StairsPlan, Storey, Window,
};
pub(super) use raise::raise;
