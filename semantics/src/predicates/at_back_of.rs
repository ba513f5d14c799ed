//! The predicate `at_back_of`, by the reference's own front.

use super::{OBJECT_OR_AGENT, Predicate, RelationProperties, THING, front::is_at_side};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// See [`Predicate::definition`]; [`super::behind::Behind`] is relative to a viewer.
pub(super) struct AtBackOf;

impl Predicate for AtBackOf {
    fn name(&self) -> &'static str {
        "at_back_of"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[THING, OBJECT_OR_AGENT]
    }

    fn definition(&self) -> &'static str {
        "By the reference's own front: the thing's middle is behind the side opposite to its \
         front, within its width widened by 45 degrees, in the same room, and their outlines are \
         at most 3.7 m apart."
    }

    fn source(&self) -> &'static str {
        "The intrinsic frame of S. C. Levinson, Space in Language and Cognition, Cambridge 2003, \
         and B. Landau, R. Jackendoff, Behav. Brain Sci. 16, 217 (1993); 3.7 m is where far \
         begins."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            irreflexive: true,
            excludes: &["at_front_of"],
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        is_at_side(scene, args[0], args[1], -1.0)
    }
}
