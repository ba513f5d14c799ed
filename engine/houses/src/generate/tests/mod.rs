//! Properties that hold for every generated house.

mod building;
mod specs;
