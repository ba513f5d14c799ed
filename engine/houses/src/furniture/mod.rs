//! Furniture and all other household things, made at run time by parametric code.
//!
//! - `shapes`: closed primitives with convex collision pieces,
//! - `textures`, `finish`: procedural images, and what surfaces are made of,
//! - `model`: a thing with parts, joints, lights, sounds, and places that hold other things,
//! - `models`: the things, one file a family,
//! - `style`: the taste of one house, which gives things that stand together colours that go together,
//! - `draw`, `entries`: sizes and variants drawn by a key,
//! - `catalogue`: the list of what a generated house may hold.

// Until houses are furnished, only tests ask for it.
#[cfg_attr(
    not(test),
    expect(dead_code, reason = "the generator will take furniture from here")
)]
pub(crate) mod catalogue;
pub(crate) mod draw;
mod entries;
pub(crate) mod finish;
pub(crate) mod model;
pub(crate) mod models;
pub(crate) mod shapes;
pub(crate) mod style;
pub(crate) mod textures;

#[cfg(test)]
mod tests;
