//! Lines of sight from a viewer to a thing.

use crate::scene::{SemanticScene, Viewer};
use dwell_scene::ObjectId;
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::rays::RayScene;
use glam::Vec3;

/// Distance of the aims of rays from the middle of a thing's box towards its corners, a share of the way; the middle is aimed at too.
const AIM: f32 = 0.6;

/// Where a thing must be to count as seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FieldOfView {
    /// At most so far from where the viewer looks, rad.
    Cone(f32),
    /// In a square picture of 90 degrees in both directions.
    Picture,
    /// Anywhere around the viewer.
    Around,
}

impl FieldOfView {
    fn contains(self, viewer: &Viewer, direction: Vec3) -> bool {
        let seen = viewer
            .world_from_camera
            .inverse()
            .transform_vector(direction);
        match self {
            Self::Cone(half_angle_rad) => {
                -seen.z >= dwell_scene::math::cos(half_angle_rad) * seen.length()
            }
            Self::Picture => seen.x.abs() <= -seen.z && seen.y.abs() <= -seen.z,
            Self::Around => true,
        }
    }
}

/// Returns whether a straight line from the viewer meets `object` before anything else, within the `field` of view.
///
/// Nine rays are aimed at the thing's box; one that meets it first is enough. `rays` must be up to date with the scene's
/// state.
pub fn is_in_line_of_sight(
    scene: &SemanticScene<'_>,
    rays: &RayScene,
    viewer: &Viewer,
    object: ObjectId,
    field: FieldOfView,
) -> bool {
    let eye = viewer.world_from_camera.position;
    let bounds = scene.extent(object).bounds;
    let (center, half) = (bounds.center(), bounds.size() * (0.5 * AIM));
    let corners = dwell_scene::Aabb::new(center - half, center + half).corners();
    let id = scene.house().entity_of_object(object).0;
    std::iter::once(center).chain(corners).any(|point| {
        let ray = Ray::new(eye, point - eye);
        field.contains(viewer, ray.direction)
            && rays
                .closest(&ray, RayMask::EYE)
                .is_some_and(|hit| hit.id == id)
    })
}
