//! What an agent's hand does: take, put, throw, push, let go, open, close, switch, point. Each says whether it worked and
//! why.

mod clearance;
mod doors;
mod hand;
mod outcome;
mod place;
mod place_at;
mod placement_trial;
mod point;
mod push;
mod put_in;
mod reach;
mod request;
mod stable_pose;
mod switch;
mod target;
mod throw;

pub use outcome::{ActionOutcome, DelayedOutcome, OutcomeCode, PointedTarget};
pub(crate) use push::OngoingPush;
pub use request::{Action, Grasp, Target};

use crate::world::PhysicsWorld;
use dwell_scene::rays::RayScene;
use dwell_scene::{AgentId, Id, ObjectId, State};
use outcome::fail;

/// What an action works with: who does it, and what it sees.
#[derive(Clone, Copy)]
struct Actor<'a> {
    id: AgentId,
    body: dwell_scene::AgentState,
    rays: &'a RayScene,
}

impl PhysicsWorld {
    /// Lets an agent do something with its hand, at once or, for doors and pushes, over the next steps.
    ///
    /// `rays` must show `state` as it is. What takes time reports its end through [`PhysicsWorld::notices`]. A state of
    /// another world or an agent that does not exist is refused like any other action that cannot be.
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
            return fail(OutcomeCode::UnknownAgent, sentence, None);
        }
        if let Err(error) = self.check_state(state) {
            return fail(
                OutcomeCode::ForeignState,
                format!("Nothing was done: {error}."),
                None,
            );
        }
        let actor = Actor {
            id: agent,
            body: state.agents[agent],
            rays,
        };
        let outcome = match *action {
            Action::Pick { target, grasp } => self.pick(state, actor, &target, grasp),
            Action::Drop => Ok(self.let_go(state, agent)),
            Action::Place { on } => self.put_on(state, actor, on.as_ref()),
            Action::PlaceAt { point } => self.put_at(state, actor, point),
            Action::PutIn { container } => self.put_in(state, actor, &container),
            Action::Throw {
                direction,
                speed_m_s,
            } => self.throw(state, actor, direction, speed_m_s),
            Action::Push { target, force_n } => {
                self.start_push(state, actor, &target, force_n, 1.0)
            }
            Action::Pull { target, force_n } => {
                self.start_push(state, actor, &target, force_n, -1.0)
            }
            Action::Open { target, fraction } => self.swing(state, actor, &target, fraction),
            Action::Close { target } => self.swing(state, actor, &target, 0.0),
            Action::Toggle { target } => self.toggle(state, actor, &target),
            Action::Point { target } => self.point(state, actor, &target),
        };
        outcome.unwrap_or_else(|refusal| *refusal)
    }

    pub(crate) fn call(&self, object: ObjectId) -> String {
        crate::body::name_of(&self.model().house, object)
    }
}

/// What an action comes to, or why it was refused.
type ActionResult = Result<ActionOutcome, Box<ActionOutcome>>;
