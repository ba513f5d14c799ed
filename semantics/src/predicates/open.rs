//! The predicate `open`.

use super::openness::{OPEN, openness_satisfies};
use super::{OBJECT, Predicate, RelationProperties};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// See [`Predicate::definition`].
pub(super) struct Open;

impl Predicate for Open {
    fn name(&self) -> &'static str {
        "open"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT]
    }

    fn definition(&self) -> &'static str {
        "Its joint that is open widest is open by more than half. Undecided for what does not \
         open."
    }

    fn source(&self) -> &'static str {
        "As captions say it; between open and closed a thing is half-open."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            excludes: &["closed", "half_open"],
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        openness_satisfies(scene, args[0], |share| share > OPEN)
    }
}
