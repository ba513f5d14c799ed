//! The projection of things into a viewer's picture.

use crate::scene::{SemanticScene, Term, Viewer};
use dwell_scene::Aabb;

use super::shape::shape_of;

/// The least depth of a thing in front of a viewer, m.
const LEAST_DEPTH_M: f32 = 0.05;
/// The largest tangent that is still in front: 75 degrees to the side.
const WIDEST_TANGENT: f32 = 3.73;

/// Returns the horizontal place of a thing's middle in the viewer's picture: x over depth, positive to the right; `None` when it
/// is not in front of the viewer.
pub(crate) fn picture_x(scene: &SemanticScene<'_>, viewer: &Viewer, term: Term) -> Option<f32> {
    let point = viewer.upright_from_world(scene.center(term)?);
    let depth = -point.z;
    let x = point.x / depth;
    (depth >= LEAST_DEPTH_M && x.abs() <= WIDEST_TANGENT).then_some(x)
}

/// Returns whether a thing's middle is in front of a viewer.
pub(crate) fn is_in_front(scene: &SemanticScene<'_>, viewer: &Viewer, term: Term) -> bool {
    picture_x(scene, viewer, term).is_some()
}

/// The place and width of a thing in a viewer's picture.
pub(super) struct Sight {
    /// The depth of its middle, m.
    pub(super) depth_m: f32,
    /// Its left and right edge in the picture, tangents.
    left: f32,
    right: f32,
}

impl Sight {
    /// Projects a thing into a viewer's picture; `None` when its middle is not in front of the viewer.
    pub(super) fn of(scene: &SemanticScene<'_>, viewer: &Viewer, term: Term) -> Option<Self> {
        let middle = picture_x(scene, viewer, term)?;
        let depth_m = -viewer.upright_from_world(scene.center(term)?).z;
        let (mut left, mut right) = (middle, middle);
        let bounds: Aabb = shape_of(scene, term)?.bounds;
        let upright_from_world = viewer.upright().inverse();
        for corner in bounds.corners() {
            let point = upright_from_world.transform_point(corner);
            let x =
                (point.x / (-point.z).max(LEAST_DEPTH_M)).clamp(-WIDEST_TANGENT, WIDEST_TANGENT);
            (left, right) = (left.min(x), right.max(x));
        }
        Some(Self {
            depth_m,
            left,
            right,
        })
    }

    /// The overlap of both in the picture, as share of the narrower one's width, 0 to 1.
    pub(super) fn shared_width(&self, other: &Self) -> f32 {
        let shared = self.right.min(other.right) - self.left.max(other.left);
        let narrower = (self.right - self.left).min(other.right - other.left);
        if narrower > 0.0 {
            (shared / narrower).max(0.0)
        } else {
            f32::from(shared >= 0.0)
        }
    }
}
