//! Measuring where things are.

mod extent;
mod hull;
mod triangles;

pub use extent::Extent;
pub use hull::Hull;
pub(crate) use triangles::{
    height_under, mapped_area_m2, object_triangles_near, structure_triangles,
};
