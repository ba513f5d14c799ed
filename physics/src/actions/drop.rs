//! The action of releasing an object.

use super::ActionResult;
use super::hand_action::{Hand, HandAction};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Releases the held object.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Drop {}

impl HandAction for Drop {
    fn perform(&self, hand: &mut Hand<'_>) -> ActionResult {
        Ok(hand.context.release(hand.state, hand.actor.id))
    }
}
