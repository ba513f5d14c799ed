//! Offset of ray origins from surfaces.

use glam::Vec3;

/// Returns how far a ray starts off the surface at `point`, m: more than what f32 loses there.
pub(crate) fn margin_m(point: Vec3) -> f32 {
    1e-4 * point.abs().max_element().max(1.0)
}
