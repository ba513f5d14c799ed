//! The action of releasing an object.

use super::ActionResult;
use super::hand_action::{HandAction, HandContext};
use crate::outcome::ActionOutcome;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Releases the held object.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Drop {}

impl HandAction for Drop {
    fn perform(&self, hand: &mut HandContext<'_>) -> ActionResult {
        Ok(hand.context.release(hand.state, hand.actor.id))
    }

    fn check(&self, hand: &HandContext<'_>) -> Result<(), Box<ActionOutcome>> {
        hand.context.grip_of(hand.actor).map(|_| ())
    }
}
