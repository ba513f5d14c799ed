//! Measuring where things are.

mod extent;
mod hull;
mod triangles;

pub use extent::Extent;
pub use hull::Hull;
pub(crate) use triangles::{
    height_under, object_triangles_near, structure_triangles, triangle_area_m2,
};
