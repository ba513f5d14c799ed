//! Letting go.

use super::ActionResult;
use super::hand_action::{Hand, HandAction};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Lets go of what it holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Drop {}

impl HandAction for Drop {
    fn perform(&self, hand: &mut Hand<'_>) -> ActionResult {
        Ok(hand.context.let_go(hand.state, hand.actor.id))
    }
}
