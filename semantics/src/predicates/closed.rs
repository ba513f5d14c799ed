//! The predicate `closed`.

use super::openness::{CLOSED, openness_satisfies};
use super::{OBJECT, Predicate, RelationProperties};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// See [`Predicate::definition`].
pub(super) struct Closed;

impl Predicate for Closed {
    fn name(&self) -> &'static str {
        "closed"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT]
    }

    fn definition(&self) -> &'static str {
        "None of its joints is open by more than 2 %. Undecided for what does not open."
    }

    fn source(&self) -> &'static str {
        "As captions say it."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            excludes: &["open", "half_open"],
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        openness_satisfies(scene, args[0], |share| share <= CLOSED)
    }
}
