//! The predicate `has`.

use super::{OBJECT, Predicate, RelationProperties, belongs_to::BelongsTo};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// See [`Predicate::definition`]; "the table with a lamp", "the window has a curtain".
pub(super) struct Has;

impl Predicate for Has {
    fn name(&self) -> &'static str {
        "has"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT, OBJECT]
    }

    fn definition(&self) -> &'static str {
        "The second thing belongs to the first: the converse of `belongs_to` between objects."
    }

    fn source(&self) -> &'static str {
        "As of `belongs_to`."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            irreflexive: true,
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], viewer: Option<&Viewer>) -> Truth {
        BelongsTo.decide(scene, &[args[1], args[0]], viewer)
    }
}
