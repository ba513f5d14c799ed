//! The predicate `narrow`.

use super::{OBJECT, Predicate, RelationProperties, proportions::is_wide};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// See [`Predicate::definition`].
pub(super) struct Narrow;

impl Predicate for Narrow {
    fn name(&self) -> &'static str {
        "narrow"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT]
    }

    fn definition(&self) -> &'static str {
        "Not wide, where that is decided."
    }

    fn source(&self) -> &'static str {
        "M. Bierwisch, E. Lang (eds.), Dimensional Adjectives, Springer 1989: a dimension of a thing \
         against its other ones and against the norm of its kind. The ratios are chosen here."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            excludes: &["wide"],
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        !is_wide(scene, args[0])
    }
}
