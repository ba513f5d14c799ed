//! Switching things on and off.

use super::outcome::{ActionCode, done, fail};
use super::request::Target;
use super::{Actor, Told};
use crate::world::PhysicsWorld;
use dwell_scene::State;

impl PhysicsWorld {
    pub(super) fn toggle(&mut self, state: &mut State, actor: Actor<'_>, target: &Target) -> Told {
        let (object, _) = self.aim_at_object(state, actor, target)?;
        let name = self.call(object);
        if self.model().house.objects[object].switch.is_none() {
            let sentence = format!("The {name} has no switch. Choose a lamp, radio or television.");
            return Ok(fail(ActionCode::NoSwitch, sentence, Some(object)));
        }
        if let Some(refusal) = self.refuse_reach(state, actor, object) {
            return Ok(refusal);
        }
        let on = !state.switched_on[object];
        state.switched_on[object] = on;
        let word = if on { "on" } else { "off" };
        let sentence = format!("You switch the {name} {word}.");
        Ok(done(ActionCode::Done, sentence, Some(object)))
    }
}
