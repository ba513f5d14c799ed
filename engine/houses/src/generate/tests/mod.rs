//! What must hold for every generated house.

mod building;
mod furniture;
mod specs;
