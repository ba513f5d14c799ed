//! The action of switching.

use super::hand_action::{HandAction, HandContext};
use super::request::Target;
use super::{ActionContext, ActionResult, Actor};
use crate::outcome::{ActionOutcome, OutcomeCode, done, fail};
use dwell_scene::{JointId, ObjectId, State};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Switches something on or off.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Toggle {
    /// The thing to switch.
    pub target: Target,
}

impl Toggle {
    /// Switches a thing on or off.
    pub fn new(target: impl Into<Target>) -> Self {
        Self {
            target: target.into(),
        }
    }
}

impl HandAction for Toggle {
    fn perform(&self, hand: &mut HandContext<'_>) -> ActionResult {
        hand.context.toggle(hand.state, hand.actor, &self.target)
    }

    fn check(&self, hand: &HandContext<'_>) -> Result<(), Box<ActionOutcome>> {
        let found = hand
            .context
            .object_to_switch(hand.state, hand.actor, &self.target);
        found.map(|_| ())
    }
}

impl ActionContext<'_> {
    /// Returns the thing with a switch.
    fn object_to_switch(
        &self,
        state: &State,
        actor: Actor<'_>,
        target: &Target,
    ) -> Result<ObjectId, Box<ActionOutcome>> {
        let (object, _) = self.resolve_object_target(state, actor, target)?;
        let name = self.dynamics.name_of(object);
        if self.dynamics.model.house.objects[object].switch.is_none() {
            let sentence = format!("The {name} has no switch. Choose a lamp, radio or television.");
            let refusal = fail(OutcomeCode::NoSwitch, sentence, Some(object));
            return Err(Box::new(refusal));
        }
        match self.check_reach(state, actor, object) {
            Some(refusal) => Err(Box::new(refusal)),
            None => Ok(object),
        }
    }

    pub(super) fn toggle(
        &mut self,
        state: &mut State,
        actor: Actor<'_>,
        target: &Target,
    ) -> ActionResult {
        let object = self.object_to_switch(state, actor, target)?;
        let name = self.dynamics.name_of(object);
        let house = self.dynamics.model.house.clone();
        let levers: Vec<JointId> = house
            .joints_of(object)
            .filter(|id| house.joints[*id].toggles_switch)
            .collect();
        let word = if state.switched_on[object] {
            "off"
        } else {
            "on"
        };
        if !levers.is_empty() {
            // The switch follows its lever, which a hand moves.
            let share = if state.switched_on[object] { 0.0 } else { 1.0 };
            self.drive_joints(state, actor, &levers, share);
            let sentence = format!("You turn the {name} {word}; it takes a moment.");
            return Ok(done(OutcomeCode::Started, sentence, Some(object)));
        }
        let on = !state.switched_on[object];
        state.switched_on[object] = on;
        let sentence = format!("You switch the {name} {word}.");
        Ok(done(OutcomeCode::Done, sentence, Some(object)))
    }
}
