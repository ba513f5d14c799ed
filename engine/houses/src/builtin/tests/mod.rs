//! Properties that hold for every built-in house.

mod furniture;
mod house;
mod specs;
mod support;
mod walking;
