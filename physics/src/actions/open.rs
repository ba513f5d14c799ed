//! The action of opening.

use super::ActionResult;
use super::hand_action::{HandAction, HandContext};
use super::request::Target;
use crate::outcome::ActionOutcome;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Opens a door, drawer or lid.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Open {
    /// The thing to open: all of an object's joints, or the one that moves the part that a ray hits.
    pub target: Target,
    /// Openness: 0 is closed, 1 fully open.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub fraction: f32,
}

impl Default for Open {
    fn default() -> Self {
        Self {
            target: Target::default(),
            fraction: 1.0,
        }
    }
}

impl Open {
    /// Opens a thing fully.
    pub fn new(target: impl Into<Target>) -> Self {
        Self {
            target: target.into(),
            ..Self::default()
        }
    }
}

impl HandAction for Open {
    fn perform(&self, hand: &mut HandContext<'_>) -> ActionResult {
        hand.context
            .swing_door(hand.state, hand.actor, &self.target, self.fraction)
    }

    fn check(&self, hand: &HandContext<'_>) -> Result<(), Box<ActionOutcome>> {
        let found =
            hand.context
                .joints_to_swing(hand.state, hand.actor, &self.target, self.fraction);
        found.map(|_| ())
    }
}
