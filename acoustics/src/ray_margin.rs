//! Offset of ray origins from surfaces.

use glam::Vec3;

/// Returns the offset of a ray's start off the surface at `point`, m: more than the rounding of f32 there.
pub(crate) fn ray_offset_m(point: Vec3) -> f32 {
    1e-4 * point.abs().max_element().max(1.0)
}
