//! The predicate `half_open`.

use super::openness::{CLOSED, OPEN, openness_satisfies};
use super::{OBJECT, Predicate, RelationProperties};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// See [`Predicate::definition`].
pub(super) struct HalfOpen;

impl Predicate for HalfOpen {
    fn name(&self) -> &'static str {
        "half_open"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT]
    }

    fn definition(&self) -> &'static str {
        "Its joint that is open widest is open by more than 2 % and at most half. Undecided for what \
         does not open."
    }

    fn source(&self) -> &'static str {
        "As captions say it."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            excludes: &["open", "closed"],
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        openness_satisfies(scene, args[0], |share| share > CLOSED && share <= OPEN)
    }
}
