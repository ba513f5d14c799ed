//! Lines of sight from a viewer to a thing.

use crate::scene::{SemanticScene, Viewer};
use dwell_scene::ObjectId;
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::rays::RayScene;
use glam::Vec3;

/// Distance of the aims of rays from the middle of a thing's box towards its corners, a share of the way; the middle is aimed at too.
const AIM: f32 = 0.6;

/// Returns whether a straight line from the viewer meets `object` before anything else, at most `half_angle_rad` away from where
/// the viewer looks.
///
/// Nine rays are aimed at the thing's box; one that meets it first is enough. `rays` must be up to date with the scene's
/// state.
pub fn is_in_line_of_sight(
    scene: &SemanticScene<'_>,
    rays: &RayScene,
    viewer: &Viewer,
    object: ObjectId,
    half_angle_rad: f32,
) -> bool {
    let eye = viewer.world_from_camera.position;
    let ahead = viewer.world_from_camera.transform_vector(Vec3::NEG_Z);
    let bounds = scene.extent(object).bounds;
    let (center, half) = (bounds.center(), bounds.size() * (0.5 * AIM));
    let corners = dwell_scene::Aabb::new(center - half, center + half).corners();
    let id = scene.house().entity_of_object(object).0;
    let least = dwell_scene::math::cos(half_angle_rad);
    std::iter::once(center).chain(corners).any(|point| {
        let ray = Ray::new(eye, point - eye);
        ray.direction.dot(ahead) >= least
            && rays
                .closest(&ray, RayMask::EYE)
                .is_some_and(|hit| hit.id == id)
    })
}
