//! The predicate `left_of`.

use super::{Predicate, RelationProperties, THING, view::image_x};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::{Truth, UndecidedReason};

/// The least difference of direction, as tangent in the picture: 0.035 is 2 degrees at the middle.
pub(crate) const LEAST_TANGENT: f32 = 0.035;

/// See [`Predicate::definition`].
pub(super) struct LeftOf;

impl Predicate for LeftOf {
    fn name(&self) -> &'static str {
        "left_of"
    }

    fn words(&self) -> &'static str {
        "to the left of"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[THING, THING]
    }

    fn definition(&self) -> &'static str {
        "Seen by the viewer, both middles are in front of it (at most 75 degrees to either side \
         of where it looks, pitch left aside), and that of the thing falls at least 0.035 (a \
         tangent: 2 degrees in the middle) further left in its picture."
    }

    fn source(&self) -> &'static str {
        "The viewer's frame is the relative one of S. C. Levinson, Space in Language and \
         Cognition, Cambridge 2003; the threshold is chosen here."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            antisymmetric: true,
            irreflexive: true,
            transitive: true,
            converse: Some("right_of"),
            excludes: &["right_of"],
            ..RelationProperties::default()
        }
    }

    fn needs_viewer(&self) -> bool {
        true
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], viewer: Option<&Viewer>) -> Truth {
        let x = |term| image_x(scene, viewer?, term);
        let (Some(a), Some(b)) = (x(args[0]), x(args[1])) else {
            return Truth::Undecided(UndecidedReason::NotInFront);
        };
        Truth::from(b - a >= LEAST_TANGENT)
    }
}
