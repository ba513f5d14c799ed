//! Furniture and all other household things, made at run time by parametric code.
//!
//! - `shapes`: closed primitives with convex collision pieces,
//! - `textures`, `finishes`: procedural images, and what surfaces are made of,
//! - `model`: a thing with parts, joints, lights, sounds, and places that hold other things,
//! - `resize`: models in other sizes,
//! - `style`: the taste of one house, which gives things that stand together colours that go together,
//! - `sampling`: sizes and variants drawn by a key,
//! - `models`: the things; a file holds a model, what is drawn at random for it, and its entry in the catalogue,
//! - `catalogue`: all entries, what a generated house may hold,
//! - `model_cache`: models of the catalogue, built once and shared,
//! - `tables`: what the tables of `assets/` say of categories, rooms and textures by name,
//! - `testing`: oracles for meshes and collision pieces that this crate's tests and those of houses share.

pub mod catalogue;
mod catalogue_entry;
pub mod finishes;
pub mod model;
pub mod model_cache;
pub mod models;
mod resize;
mod sampling;
pub mod shapes;
pub mod style;
pub mod tables;
pub mod testing;
pub mod textures;

#[cfg(test)]
mod tests;
