//! The interface common to all hand actions.

use super::{ActionContext, ActionResult, Actor};
use crate::outcome::ActionOutcome;
use dwell_scene::State;
use std::fmt::Debug;

/// An action of an agent's hand. Each kind is a type in a file of its own.
pub trait HandAction: Debug + Send + Sync {
    /// Performs it with a hand.
    ///
    /// # Errors
    /// The outcome with the reason why it is refused.
    fn perform(&self, hand: &mut HandContext<'_>) -> ActionResult;

    /// Returns whether anything known beforehand rules it out: a full hand, a thing out of reach, a door that is open already.
    /// Whatever passes may still fail, as where a search finds no free spot.
    ///
    /// # Errors
    /// The outcome with the reason why it would be refused.
    fn check(&self, hand: &HandContext<'_>) -> Result<(), Box<ActionOutcome>>;
}

impl<A: HandAction + ?Sized> HandAction for &A {
    fn perform(&self, hand: &mut HandContext<'_>) -> ActionResult {
        (**self).perform(hand)
    }

    fn check(&self, hand: &HandContext<'_>) -> Result<(), Box<ActionOutcome>> {
        (**self).check(hand)
    }
}

/// The hand of an agent, and the world that it acts on.
pub struct HandContext<'a> {
    pub(super) context: ActionContext<'a>,
    pub(super) state: &'a mut State,
    pub(super) actor: Actor<'a>,
}

impl Debug for HandContext<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Hand")
            .field("agent", &self.actor.id)
            .finish_non_exhaustive()
    }
}

impl HandContext<'_> {
    /// Performs an action, and returns its outcome.
    pub(crate) fn perform(&mut self, action: &dyn HandAction) -> ActionOutcome {
        action.perform(self).unwrap_or_else(|refusal| *refusal)
    }
}
