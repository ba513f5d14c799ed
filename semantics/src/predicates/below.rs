//! The predicate `below`.

use super::{Predicate, RelationProperties, THING, above::Above};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// The converse of [`Above`].
pub(super) struct Below;

impl Predicate for Below {
    fn name(&self) -> &'static str {
        "below"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[THING, THING]
    }

    fn definition(&self) -> &'static str {
        "A thing is below another exactly when the other is above it."
    }

    fn source(&self) -> &'static str {
        "As of `above`."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            antisymmetric: true,
            irreflexive: true,
            converse: Some("above"),
            excludes: &["above", "on", "in"],
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], viewer: Option<&Viewer>) -> Truth {
        Above.decide(scene, &[args[1], args[0]], viewer)
    }
}
