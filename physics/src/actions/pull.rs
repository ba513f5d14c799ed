//! The action of pulling.

use super::ActionResult;
use super::hand_action::{HandAction, HandContext};
use super::request::Target;
use crate::outcome::ActionOutcome;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Pulls an object towards the agent for a quarter of a second; needs a free hand.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Pull {
    /// The object to pull; a ray also gives the point.
    pub target: Target,
    /// Force, N, above 0; limited to the agent's strength. Default: all of it.
    pub force_n: Option<f32>,
}

impl HandAction for Pull {
    fn perform(&self, hand: &mut HandContext<'_>) -> ActionResult {
        hand.context
            .start_push(hand.state, hand.actor, &self.target, self.force_n, -1.0)
    }

    fn check(&self, hand: &HandContext<'_>) -> Result<(), Box<ActionOutcome>> {
        let found =
            hand.context
                .object_to_push(hand.state, hand.actor, &self.target, self.force_n, -1.0);
        found.map(|_| ())
    }
}
