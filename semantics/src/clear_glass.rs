//! Surfaces that one sees through.

use dwell_scene::bvh::Hit;
use dwell_scene::rays::RayScene;

/// Opacity below which one sees through a surface.
pub(crate) const CLEAR_OPACITY: f32 = 0.6;

/// Returns whether one sees through the surface that a ray met.
pub(crate) fn is_transparent(rays: &RayScene, hit: &Hit) -> bool {
    let material = rays.surface(hit).material;
    rays.house().materials[material].opacity < CLEAR_OPACITY
}
