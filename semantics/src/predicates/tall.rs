//! The predicate `tall`.

use super::{OBJECT, Predicate, RelationProperties, proportions::is_tall};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// See [`Predicate::definition`].
pub(super) struct Tall;

impl Predicate for Tall {
    fn name(&self) -> &'static str {
        "tall"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT]
    }

    fn definition(&self) -> &'static str {
        "It is at least 1.2 times as high as is usual for its kind, or at least 1.5 times as high as \
         long; not tall where it is at most 1/1.2 times as high as usual or at least 3 times as \
         long as high; undecided where neither or both is so. Its length is the longer horizontal \
         side of its box."
    }

    fn source(&self) -> &'static str {
        "M. Bierwisch, E. Lang (eds.), Dimensional Adjectives, Springer 1989: a dimension of a thing \
         against its other ones and against the norm of its kind. The ratios are chosen here."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            excludes: &["low"],
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        is_tall(scene, args[0])
    }
}
