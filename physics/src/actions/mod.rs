//! What an agent's hand does: take, put, let go, open, close, switch. Each says whether it worked and why.

mod doors;
mod hand;
mod outcome;
mod place;
mod reach;
mod switch;

pub use outcome::{Action, ActionCode, ActionOutcome, Notice};

use crate::world::PhysicsWorld;
use dwell_scene::rays::RayScene;
use dwell_scene::{AgentId, Id, ObjectId, State};
use outcome::fail;

impl PhysicsWorld {
    /// Lets an agent do something with its hand, at once or, for doors, over the next steps.
    ///
    /// `rays` must show `state` as it is. What takes time reports its end through [`PhysicsWorld::notices`].
    pub fn act(
        &mut self,
        state: &mut State,
        rays: &RayScene,
        agent: AgentId,
        action: &Action,
    ) -> ActionOutcome {
        if agent.index() >= self.agents.len() || agent.index() >= state.agents.len() {
            let count = self.agents.len();
            let sentence = format!("There is no agent {}; there are {count}.", agent.0);
            return fail(ActionCode::UnknownAgent, sentence, None);
        }
        if let Some(object) = action.object()
            && object.index() >= self.model().house.objects.len()
        {
            let count = self.model().house.objects.len();
            let sentence = format!("There is no object {}; there are {count}.", object.0);
            return fail(ActionCode::UnknownObject, sentence, None);
        }
        match *action {
            Action::Pick { object } => self.pick(state, rays, agent, object),
            Action::Drop => self.let_go(state, agent),
            Action::Place { on } => self.put_on(state, rays, agent, on),
            Action::Open { object } => self.swing(state, rays, agent, object, true),
            Action::Close { object } => self.swing(state, rays, agent, object, false),
            Action::Toggle { object } => self.toggle(state, rays, agent, object),
        }
    }

    pub(crate) fn call(&self, object: ObjectId) -> String {
        crate::body::name_of(&self.model().house, object)
    }
}
