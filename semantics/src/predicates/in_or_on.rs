//! The predicate `in_or_on`.

use super::{OBJECT, OBJECT_OR_STRUCTURE, Predicate, RelationProperties, inside::Inside, on::On};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// See [`Predicate::definition`]; "the cup from the cupboard".
pub(super) struct InOrOn;

impl Predicate for InOrOn {
    fn name(&self) -> &'static str {
        "in_or_on"
    }

    fn places(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT, OBJECT_OR_STRUCTURE]
    }

    fn definition(&self) -> &'static str {
        "The thing is `in` or `on` the other: where it is taken from."
    }

    fn source(&self) -> &'static str {
        "As of `in` and `on`."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            irreflexive: true,
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], viewer: Option<&Viewer>) -> Truth {
        Inside
            .holds(scene, args, viewer)
            .or(On.decide(scene, args, viewer))
    }
}
