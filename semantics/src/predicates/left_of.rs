//! Left of.

use super::{Predicate, RelationProperties};
use crate::scene::{SemanticScene, Term, Viewer};
use dwell_scene::ObjectId;

/// Smallest difference of direction that counts, as tangent in the picture: 0.035 is 2 degrees at the middle.
const LEAST_TANGENT: f32 = 0.035;
/// Smallest depth in front of a viewer, m.
const LEAST_DEPTH_M: f32 = 0.05;
/// Largest tangent that is still in front: 75 degrees to the side.
const WIDEST_TANGENT: f32 = 3.73;

/// Returns the image of a thing's middle in the viewer's picture: x over depth, growing to the right; `None` when it is not in
/// front of the viewer.
pub(super) fn picture_x(scene: &SemanticScene<'_>, viewer: &Viewer, term: Term) -> Option<f32> {
    let point = viewer.upright_from_world(scene.center(term)?);
    let depth = -point.z;
    let x = point.x / depth;
    (depth >= LEAST_DEPTH_M && x.abs() <= WIDEST_TANGENT).then_some(x)
}

/// Returns whether a thing's middle is in front of a viewer.
pub(crate) fn is_in_front(scene: &SemanticScene<'_>, viewer: &Viewer, term: Term) -> bool {
    picture_x(scene, viewer, term).is_some()
}

/// `a` is left of `b` for a viewer: both middles are in front of the viewer (at most 75 degrees to either side of where it looks,
/// pitch left aside) and the one of `a` falls at least 0.035 further left in its picture (tangents; 2 degrees in the middle).
pub(super) struct LeftOf;

impl Predicate for LeftOf {
    fn name(&self) -> &'static str {
        "left_of"
    }

    fn words(&self) -> &'static str {
        "to the left of"
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            antisymmetric: true,
            irreflexive: true,
            converse: Some("right_of"),
            ..RelationProperties::default()
        }
    }

    fn needs_viewer(&self) -> bool {
        true
    }

    fn holds(
        &self,
        scene: &SemanticScene<'_>,
        subject: Term,
        object: Term,
        viewer: Option<&Viewer>,
    ) -> bool {
        let x = |term| picture_x(scene, viewer?, term);
        matches!((x(subject), x(object)), (Some(a), Some(b)) if b - a >= LEAST_TANGENT)
    }

    fn related(&self, _: &SemanticScene<'_>, _: ObjectId) -> Vec<Term> {
        Vec::new()
    }
}
