//! The predicate `low`.

use super::{OBJECT, Predicate, RelationProperties, proportions::is_tall};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// See [`Predicate::definition`].
pub(super) struct Low;

impl Predicate for Low {
    fn name(&self) -> &'static str {
        "low"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT]
    }

    fn definition(&self) -> &'static str {
        "Not tall, where that is decided."
    }

    fn source(&self) -> &'static str {
        "M. Bierwisch, E. Lang (eds.), Dimensional Adjectives, Springer 1989: a dimension of a thing \
         against its other ones and against the norm of its kind. The ratios are chosen here."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            excludes: &["tall"],
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        !is_tall(scene, args[0])
    }
}
