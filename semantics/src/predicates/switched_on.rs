//! The predicate `switched_on`.

use super::{OBJECT, Predicate, RelationProperties};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::{Truth, UndecidedReason};

/// See [`Predicate::definition`].
pub(super) struct SwitchedOn;

impl Predicate for SwitchedOn {
    fn name(&self) -> &'static str {
        "switched_on"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT]
    }

    fn definition(&self) -> &'static str {
        "Its switch is on. Undecided for what has no switch."
    }

    fn source(&self) -> &'static str {
        "The state of the world."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            excludes: &["switched_off"],
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        let switched = args[0]
            .object()
            .filter(|id| scene.house().objects[*id].switch.is_some());
        switched.map_or(Truth::Undecided(UndecidedReason::NoSwitch), |id| {
            Truth::from(scene.state.switched_on[id])
        })
    }
}
