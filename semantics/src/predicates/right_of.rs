//! The predicate `right_of`.

use super::{Predicate, RelationProperties, THING, left_of::LeftOf};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// The converse of [`LeftOf`].
pub(super) struct RightOf;

impl Predicate for RightOf {
    fn name(&self) -> &'static str {
        "right_of"
    }

    fn words(&self) -> &'static str {
        "to the right of"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[THING, THING]
    }

    fn definition(&self) -> &'static str {
        "For the viewer, a thing is right of another exactly when the other is left of it."
    }

    fn source(&self) -> &'static str {
        "As of `left_of`."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            antisymmetric: true,
            irreflexive: true,
            transitive: true,
            converse: Some("left_of"),
            excludes: &["left_of"],
            ..RelationProperties::default()
        }
    }

    fn needs_viewer(&self) -> bool {
        true
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], viewer: Option<&Viewer>) -> Truth {
        LeftOf.decide(scene, &[args[1], args[0]], viewer)
    }
}
