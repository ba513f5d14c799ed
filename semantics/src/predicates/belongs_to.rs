//! The predicate `belongs_to`.

use super::{
    OBJECT, OBJECT_OR_STRUCTURE, Predicate, RelationProperties, attached_to::AttachedTo,
    inside::Inside, on::On,
};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// See [`Predicate::definition`]; "the cup from the cupboard", "the tap of the sink".
pub(super) struct BelongsTo;

impl Predicate for BelongsTo {
    fn name(&self) -> &'static str {
        "belongs_to"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT, OBJECT_OR_STRUCTURE]
    }

    fn definition(&self) -> &'static str {
        "The thing is `in` or `on` the other, or `attached_to` it."
    }

    fn source(&self) -> &'static str {
        "As of `in`, `on` and `attached_to`."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            irreflexive: true,
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], viewer: Option<&Viewer>) -> Truth {
        // `in` says nothing of pieces of the building.
        let inside = match args[1] {
            Term::Structure(_) => Truth::False,
            _ => Inside.holds(scene, args, viewer),
        };
        let on = On.decide(scene, args, viewer);
        inside.or(on).or(AttachedTo.decide(scene, args, viewer))
    }
}
