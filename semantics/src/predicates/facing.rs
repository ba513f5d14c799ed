//! The predicate `facing`.

use super::{
    OBJECT_OR_AGENT, Predicate, RelationProperties,
    front::front_of,
    shape::{shape_of, share_room},
};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::{Truth, UndecidedReason};

/// Cosine of the largest angle from the front: 30 degrees.
const LEAST_COSINE: f32 = 0.866_025_4;

/// See [`Predicate::definition`].
pub(super) struct Facing;

impl Predicate for Facing {
    fn name(&self) -> &'static str {
        "facing"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT_OR_AGENT, OBJECT_OR_AGENT]
    }

    fn definition(&self) -> &'static str {
        "Seen from above, the direction from the thing's middle to the middle of another in the \
         same room is at most 30 degrees from the thing's own front, or from where the agent \
         faces."
    }

    fn source(&self) -> &'static str {
        "Fronts as of at_front_of; the angle is chosen here."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            irreflexive: true,
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        let Some(front) = front_of(scene, args[0]) else {
            return Truth::Undecided(UndecidedReason::NoFront);
        };
        let (Some(p), Some(q)) = (shape_of(scene, args[0]), shape_of(scene, args[1])) else {
            return Truth::False;
        };
        let towards = (q.middle_xz() - p.middle_xz()).try_normalize();
        let faces = towards.is_some_and(|towards| towards.dot(front) >= LEAST_COSINE);
        Truth::from(args[0] != args[1] && faces && share_room(scene, args[0], args[1]))
    }
}
