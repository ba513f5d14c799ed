//! The predicate `switched_off`.

use super::{OBJECT, Predicate, RelationProperties, switched_on::SwitchedOn};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// See [`Predicate::definition`].
pub(super) struct SwitchedOff;

impl Predicate for SwitchedOff {
    fn name(&self) -> &'static str {
        "switched_off"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT]
    }

    fn definition(&self) -> &'static str {
        "Its switch is off. Undecided for what has no switch."
    }

    fn source(&self) -> &'static str {
        "The state of the world."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            excludes: &["switched_on"],
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], viewer: Option<&Viewer>) -> Truth {
        !SwitchedOn.decide(scene, args, viewer)
    }
}
