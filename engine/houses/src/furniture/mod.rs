//! Furniture and all other household things, made at run time by parametric code.
//!
//! - `shapes`: closed primitives with convex collision pieces,
//! - `textures`, `finish`: procedural images, and what surfaces are made of,
//! - `model`: a thing with parts, joints, lights, sounds, and places that hold other things,
//! - `models`: the things, one file a family,
//! - `style`: the taste of one house, which gives things that stand together colours that go together,
//! - `draw`, `entries`: sizes and variants drawn by a key,
//! - `catalogue`: the list of what a generated house may hold,
//! - `stock`: models of the catalogue, built once and shared.

pub(crate) mod catalogue;
pub(crate) mod draw;
mod entries;
pub(crate) mod finish;
pub(crate) mod model;
pub(crate) mod models;
pub(crate) mod shapes;
pub(crate) mod stock;
pub(crate) mod style;
pub(crate) mod textures;

#[cfg(test)]
mod tests;
