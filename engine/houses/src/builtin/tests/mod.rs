//! What must hold for every built-in house.

mod furniture;
mod house;
mod overlap;
pub(crate) mod support;
mod walking;
