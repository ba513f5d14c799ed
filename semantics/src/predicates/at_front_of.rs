//! The predicate `at_front_of`, by the reference's own front.

use super::{OBJECT_OR_AGENT, Predicate, RelationProperties, THING, front::is_at_side};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// See [`Predicate::definition`]; [`super::in_front_of::InFrontOf`] is relative to a viewer.
pub(super) struct AtFrontOf;

impl Predicate for AtFrontOf {
    fn name(&self) -> &'static str {
        "at_front_of"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[THING, OBJECT_OR_AGENT]
    }

    fn definition(&self) -> &'static str {
        "By the reference's own front (the side of a seat, bed, cabinet, appliance, screen or \
         picture that is used or looked at; where an agent faces): the thing's middle is before \
         that side, within its width widened by 45 degrees, in the same room, and their outlines \
         are at most 3.7 m apart."
    }

    fn source(&self) -> &'static str {
        "The intrinsic frame of S. C. Levinson, Space in Language and Cognition, Cambridge 2003, \
         and B. Landau, R. Jackendoff, Behav. Brain Sci. 16, 217 (1993); 3.7 m is where far \
         begins."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            irreflexive: true,
            excludes: &["at_back_of"],
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        is_at_side(scene, args[0], args[1], 1.0)
    }
}
