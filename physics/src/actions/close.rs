//! The action of closing.

use super::ActionResult;
use super::hand_action::{HandAction, HandContext};
use super::request::Target;
use crate::outcome::ActionOutcome;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Closes a door, drawer or lid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Close {
    /// The thing to close.
    pub target: Target,
}

impl Close {
    /// Closes a thing.
    pub fn new(target: impl Into<Target>) -> Self {
        Self {
            target: target.into(),
        }
    }
}

impl HandAction for Close {
    fn perform(&self, hand: &mut HandContext<'_>) -> ActionResult {
        hand.context
            .swing_door(hand.state, hand.actor, &self.target, 0.0)
    }

    fn check(&self, hand: &HandContext<'_>) -> Result<(), Box<ActionOutcome>> {
        let found = hand
            .context
            .joints_to_swing(hand.state, hand.actor, &self.target, 0.0);
        found.map(|_| ())
    }
}
