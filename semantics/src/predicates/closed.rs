//! The predicate `closed`.

use super::{OBJECT, Predicate, RelationProperties};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::{Truth, UndecidedReason};

/// The openness up to which a thing is closed.
const CLOSED: f32 = 0.02;

/// See [`Predicate::definition`].
pub(super) struct Closed;

impl Predicate for Closed {
    fn name(&self) -> &'static str {
        "closed"
    }

    fn places(&self) -> &'static [&'static [TermKind]] {
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
            excludes: &["open"],
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        let openness = args[0]
            .object()
            .and_then(|id| scene.state.openness(scene.house(), id));
        openness.map_or(Truth::Undecided(UndecidedReason::DoesNotOpen), |share| {
            Truth::from(share <= CLOSED)
        })
    }
}
