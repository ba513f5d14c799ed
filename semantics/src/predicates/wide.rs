//! The predicate `wide`.

use super::{OBJECT, Predicate, RelationProperties, proportions::is_wide};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// See [`Predicate::definition`].
pub(super) struct Wide;

impl Predicate for Wide {
    fn name(&self) -> &'static str {
        "wide"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT]
    }

    fn definition(&self) -> &'static str {
        "Its longer horizontal side is at least 1.2 times as long as is usual for its kind, or at \
         least 1.5 times as long as it is high; not wide where it is at most 1/1.2 times as long as \
         usual or at most a third of the height; undecided where neither or both is so."
    }

    fn source(&self) -> &'static str {
        "M. Bierwisch, E. Lang (eds.), Dimensional Adjectives, Springer 1989: a dimension of a thing \
         against its other ones and against the norm of its kind. The ratios are chosen here."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            excludes: &["narrow"],
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        is_wide(scene, args[0])
    }
}
