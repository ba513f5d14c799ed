//! What an agent's hand does: take, put, throw, push, let go, open, close, switch, point. Each says whether it worked and
//! why.

mod doors;
mod hand;
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

pub(crate) use push::{OngoingPush, advance_pushes};
pub use request::{Action, Target};

use crate::agents::Agents;
use crate::articulation::JointSystem;
use crate::dynamics::Dynamics;
use crate::hands::Hands;
use crate::outcome::ActionOutcome;
use dwell_scene::rays::RayScene;
use dwell_scene::{AgentId, State};

/// What an action works with: who does it, and what it sees.
#[derive(Clone, Copy)]
struct Actor<'a> {
    id: AgentId,
    body: dwell_scene::AgentState,
    rays: &'a RayScene,
}

/// The parts of a world that actions read and change.
pub(crate) struct ActionContext<'a> {
    pub(crate) dynamics: &'a mut Dynamics,
    pub(crate) articulation: &'a mut JointSystem,
    pub(crate) agents: &'a Agents,
    pub(crate) hands: &'a mut Hands,
    pub(crate) pushes: &'a mut Vec<OngoingPush>,
}

impl ActionContext<'_> {
    /// Lets an agent do something with its hand. `rays` must show `state` as it is.
    pub(crate) fn perform(
        &mut self,
        state: &mut State,
        rays: &RayScene,
        agent: AgentId,
        action: &Action,
    ) -> ActionOutcome {
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
}

/// What an action comes to, or why it was refused.
type ActionResult = Result<ActionOutcome, Box<ActionOutcome>>;
