//! Switching things on and off.

use super::outcome::{ActionCode, ActionOutcome, done, fail};
use crate::world::PhysicsWorld;
use dwell_scene::rays::RayScene;
use dwell_scene::{AgentId, ObjectId, State};

impl PhysicsWorld {
    pub(super) fn toggle(
        &mut self,
        state: &mut State,
        rays: &RayScene,
        agent: AgentId,
        object: ObjectId,
    ) -> ActionOutcome {
        let holder = state.agents[agent];
        let name = self.call(object);
        if self.model().house.objects[object].switch.is_none() {
            let sentence = format!("The {name} has no switch. Choose a lamp, radio or television.");
            return fail(ActionCode::NoSwitch, sentence, Some(object));
        }
        if let Some(refusal) = self.refuse_reach(state, rays, &holder, object) {
            return refusal;
        }
        let on = !state.switched_on[object];
        state.switched_on[object] = on;
        let word = if on { "on" } else { "off" };
        done(
            ActionCode::Done,
            format!("You switch the {name} {word}."),
            Some(object),
        )
    }
}
