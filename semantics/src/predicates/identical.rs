//! The predicate `identical`.

use super::{OBJECT_OR_ROOM, Predicate, RelationProperties};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// See [`Predicate::definition`].
pub(super) struct Identical;

impl Predicate for Identical {
    fn name(&self) -> &'static str {
        "identical"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT_OR_ROOM, OBJECT_OR_ROOM]
    }

    fn definition(&self) -> &'static str {
        "Both are one thing, or one room: \"the sofa is the largest thing in the room\"."
    }

    fn source(&self) -> &'static str {
        "Identity, as in first-order logic."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            symmetric: true,
            reflexive: true,
            transitive: true,
            functional: true,
            ..RelationProperties::default()
        }
    }

    fn decide(&self, _: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        Truth::from(args[0] == args[1])
    }
}
