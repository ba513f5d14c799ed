//! Lines of sight from a viewer to a thing.

use crate::clear_glass::is_transparent;
use crate::scene::{SemanticScene, Viewer};
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::rays::RayScene;
use dwell_scene::{Aabb, EntityId, ObjectId};
use glam::{Vec2, Vec3, Vec3Swizzles};

/// Distance of the aims of rays from the middle of a thing's box towards its corners, a share of the way; the middle is aimed at too.
const AIM: f32 = 0.6;

/// Rays along each edge of the part of a picture that a box covers.
const ACROSS: usize = 4;
/// Least depth of what is in front of a viewer, m.
const LEAST_DEPTH_M: f32 = 0.05;

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
    /// Returns whether a direction, of unit length, is within the field.
    fn contains(self, viewer: &Viewer, direction: Vec3) -> bool {
        let camera = &viewer.world_from_camera;
        match self {
            Self::Cone(half_angle_rad) => {
                let ahead = camera.transform_vector(Vec3::NEG_Z);
                direction.dot(ahead) >= dwell_scene::math::cos(half_angle_rad)
            }
            Self::Picture => {
                let seen = camera.inverse().transform_vector(direction);
                seen.x.abs() <= -seen.z && seen.y.abs() <= -seen.z
            }
            Self::Around => true,
        }
    }
}

/// Returns whether a straight line from the viewer meets `object` before anything that one does not see through, within the `field` of view.
///
/// Nine rays are aimed at the thing's box, and in a picture 16 more at the part of it that the box covers; one that meets it first is
/// enough. `rays` must be up to date with the scene's state.
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
    let corners = Aabb::new(center - half, center + half).corners();
    let id = scene.house().entity_of_object(object);
    let meets = |direction: Vec3| {
        let ray = Ray::new(eye, direction);
        field.contains(viewer, ray.direction) && meets_first(rays, &ray, id)
    };
    let mut aims = std::iter::once(center).chain(corners);
    aims.any(|point| meets(point - eye))
        || (field == FieldOfView::Picture && covered(viewer, &bounds).into_iter().any(meets))
}

/// Panes of clear glass that one sees through.
const MAX_PANES: usize = 8;
/// Distance behind a pane from which a ray goes on, m.
const BEHIND_M: f32 = 1e-3;

/// Returns whether a ray meets the entity `id` before anything that one does not see through.
fn meets_first(rays: &RayScene, ray: &Ray, id: EntityId) -> bool {
    let mut ray = *ray;
    for _ in 0..MAX_PANES {
        let Some(hit) = rays.closest(&ray, RayMask::EYE) else {
            return false;
        };
        if hit.id == id.0 {
            return true;
        }
        if !is_transparent(rays, &hit) {
            return false;
        }
        ray = ray.with_range(hit.distance_m + BEHIND_M, ray.far_m);
    }
    false
}

/// Directions over the part of a picture that a box covers, [`ACROSS`] by [`ACROSS`]; none of a box behind the viewer.
fn covered(viewer: &Viewer, bounds: &Aabb) -> Vec<Vec3> {
    let camera_from_world = viewer.world_from_camera.inverse();
    let (mut low, mut high) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
    let corners = bounds
        .corners()
        .map(|corner| camera_from_world.transform_point(corner));
    if corners.iter().all(|corner| corner.z > -LEAST_DEPTH_M) {
        return Vec::new();
    }
    for corner in corners {
        // What reaches behind the viewer reaches to the edges of the picture.
        let place = corner.xy() / (-corner.z).max(LEAST_DEPTH_M);
        (low, high) = (low.min(place), high.max(place));
    }
    let (low, high) = (low.max(Vec2::NEG_ONE), high.min(Vec2::ONE));
    if low.cmpge(high).any() {
        return Vec::new();
    }
    let places = (0..ACROSS * ACROSS).map(|k| {
        let share = Vec2::new((k % ACROSS) as f32 + 0.5, (k / ACROSS) as f32 + 0.5);
        let place = low + (high - low) * share / ACROSS as f32;
        let direction = Vec3::new(place.x, place.y, -1.0);
        viewer.world_from_camera.transform_vector(direction)
    });
    places.collect()
}
