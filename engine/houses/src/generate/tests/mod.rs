//! What must hold for every generated house.

mod building;
mod specs;
