//! The predicate `open`.

use super::{OBJECT, Predicate, RelationProperties};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::{Truth, UndecidedReason};

/// The openness beyond which a thing is open.
const OPEN: f32 = 0.5;

/// See [`Predicate::definition`].
pub(super) struct Open;

impl Predicate for Open {
    fn name(&self) -> &'static str {
        "open"
    }

    fn places(&self) -> &'static [&'static [TermKind]] {
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
            excludes: &["closed"],
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        let openness = args[0]
            .object()
            .and_then(|id| scene.state.openness(scene.house(), id));
        openness.map_or(Truth::Undecided(UndecidedReason::DoesNotOpen), |share| {
            Truth::from(share > OPEN)
        })
    }
}
