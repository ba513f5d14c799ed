//! Openness: the share by which the joint of a thing that is open widest is open.

use crate::scene::{SemanticScene, Term};
use crate::truth::{Truth, UndecidedReason};

/// The openness beyond which a thing is open.
pub(super) const OPEN: f32 = 0.5;
/// The openness up to which a thing is closed.
pub(super) const CLOSED: f32 = 0.02;

/// Returns whether the openness of a thing is as `test` says; undecided for what does not open.
pub(super) fn openness_satisfies(
    scene: &SemanticScene<'_>,
    term: Term,
    test: impl Fn(f32) -> bool,
) -> Truth {
    let openness = term
        .object()
        .and_then(|id| scene.state.openness(scene.house(), id));
    openness.map_or(Truth::Undecided(UndecidedReason::DoesNotOpen), |share| {
        Truth::from(test(share))
    })
}
