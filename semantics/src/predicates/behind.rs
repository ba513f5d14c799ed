//! The predicate `behind`, relative to a viewer.

use super::{Predicate, RelationProperties, THING, in_front_of::InFrontOf};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// The converse of [`InFrontOf`].
pub(super) struct Behind;

impl Predicate for Behind {
    fn name(&self) -> &'static str {
        "behind"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[THING, THING]
    }

    fn definition(&self) -> &'static str {
        "From the viewer: a thing is behind another exactly when the other is in front of it. The \
         reference's own back does not matter: see at_back_of."
    }

    fn source(&self) -> &'static str {
        "As of `in_front_of`."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            antisymmetric: true,
            irreflexive: true,
            converse: Some("in_front_of"),
            excludes: &["in_front_of"],
            ..RelationProperties::default()
        }
    }

    fn needs_viewer(&self) -> bool {
        true
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], viewer: Option<&Viewer>) -> Truth {
        InFrontOf.decide(scene, &[args[1], args[0]], viewer)
    }
}
