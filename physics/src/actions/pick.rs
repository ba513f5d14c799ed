//! The action of picking up an object.

use super::ActionResult;
use super::hand_action::{HandAction, HandContext};
use super::request::Target;
use crate::hands::Grasp;
use crate::outcome::ActionOutcome;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Picks up an object.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Pick {
    /// The object to pick up.
    pub target: Target,
    /// Kind of grasp: `"kinematic"` or `{"spring": {"frequency_hz": 4, "damping_ratio": 1}}`.
    pub grasp: Grasp,
}

impl Pick {
    /// Picks up an object with the default grasp.
    pub fn new(target: impl Into<Target>) -> Self {
        Self {
            target: target.into(),
            grasp: Grasp::default(),
        }
    }
}

impl HandAction for Pick {
    fn perform(&self, hand: &mut HandContext<'_>) -> ActionResult {
        hand.context
            .pick(hand.state, hand.actor, &self.target, self.grasp)
    }

    fn check(&self, hand: &HandContext<'_>) -> Result<(), Box<ActionOutcome>> {
        let found = hand
            .context
            .object_to_pick(hand.state, hand.actor, &self.target, self.grasp);
        found.map(|_| ())
    }
}
