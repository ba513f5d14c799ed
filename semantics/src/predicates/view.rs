//! Where things fall in a viewer's picture.

use super::shape::shape_of;
use crate::scene::{SemanticScene, Term, Viewer};
use dwell_scene::Pose;
use dwell_scene::space::azimuth_elevation;
use glam::Vec3;

/// The least depth of what is in front of a viewer, m.
const LEAST_DEPTH_M: f32 = 0.05;
/// The largest tangent that is still in front: 75 degrees to the side.
const WIDEST_TANGENT: f32 = 3.73;

/// Half the width of "straight ahead", rad: the middle third of a picture of 90 degrees, atan(1/3) = 18.4 degrees.
pub(super) const AHEAD_RAD: f32 = 0.321_750_55;

/// The direction of a thing's middle, rad to the left of where the viewer looks, seen from above.
pub(super) fn azimuth_rad(scene: &SemanticScene<'_>, viewer: &Viewer, term: Term) -> Option<f32> {
    let middle = viewer.upright_from_world(scene.center(term)?);
    Some(azimuth_elevation(middle).0)
}

/// Returns where a thing's middle falls in the viewer's picture: x over depth, growing to the right; `None` when it is not in
/// front of the viewer.
pub(crate) fn image_x(scene: &SemanticScene<'_>, viewer: &Viewer, term: Term) -> Option<f32> {
    tangent(viewer.upright_from_world(scene.center(term)?))
}

/// The tangent of a direction in the viewer's upright frame; `None` of what is not in front.
fn tangent(point: Vec3) -> Option<f32> {
    let depth = -point.z;
    let x = point.x / depth;
    (depth >= LEAST_DEPTH_M && x.abs() <= WIDEST_TANGENT).then_some(x)
}

/// Returns whether a thing's middle is in front of a viewer.
pub(crate) fn is_in_front(scene: &SemanticScene<'_>, viewer: &Viewer, term: Term) -> bool {
    image_x(scene, viewer, term).is_some()
}

/// Two things as a viewer sees them, both in front of it.
pub(super) struct ViewedPair {
    upright_from_world: Pose,
    terms: [Term; 2],
    /// Where their middles are in the viewer's upright frame, m.
    middles: [Vec3; 2],
}

impl ViewedPair {
    /// Returns how a viewer sees two things; `None` when the middle of one is not in front of the viewer.
    pub(super) fn of(scene: &SemanticScene<'_>, viewer: &Viewer, terms: [Term; 2]) -> Option<Self> {
        let upright_from_world = viewer.upright().inverse();
        let middle = |term| {
            let point = upright_from_world.transform_point(scene.center(term)?);
            tangent(point).map(|_| point)
        };
        let middles = [middle(terms[0])?, middle(terms[1])?];
        Some(Self {
            upright_from_world,
            terms,
            middles,
        })
    }

    /// Returns how much nearer the first one is along where the viewer looks, m.
    pub(super) fn depth_difference_m(&self) -> f32 {
        self.middles[0].z - self.middles[1].z
    }

    /// The share of the narrower one's width in the picture that both have in common, 0 to 1.
    pub(super) fn width_overlap_fraction(&self, scene: &SemanticScene<'_>) -> f32 {
        let edges = [0, 1].map(|k| self.edges(scene, k));
        let [Some((left, right)), Some((other_left, other_right))] = edges else {
            return 0.0;
        };
        let shared = right.min(other_right) - left.max(other_left);
        let narrower = (right - left).min(other_right - other_left);
        if narrower > 0.0 {
            (shared / narrower).max(0.0)
        } else {
            f32::from(shared >= 0.0)
        }
    }

    /// The left and the right edge of a thing's outline in the picture, tangents: columns depend on the outline from above alone.
    fn edges(&self, scene: &SemanticScene<'_>, k: usize) -> Option<(f32, f32)> {
        let shape = shape_of(scene, self.terms[k])?;
        let tangents = shape.outline.points().iter().map(|point| {
            let point = Vec3::new(point.x, 0.0, point.y);
            let point = self.upright_from_world.transform_point(point);
            let x = point.x / (-point.z).max(LEAST_DEPTH_M);
            x.clamp(-WIDEST_TANGENT, WIDEST_TANGENT)
        });
        let edges = tangents.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        (edges.0 <= edges.1).then_some(edges)
    }
}
