//! Actions of an agent's hand: pick, put, throw, push, release, open, close, switch, point. Each reports success or the
//! reason for its failure.

mod close;
mod doors;
mod drop;
mod grip;
mod hand;
mod hand_action;
mod open;
mod pick;
mod place;
mod place_at;
mod place_in_pose;
mod placement_trial;
mod point;
mod pull;
mod push;
mod put_in;
mod reach;
mod request;
mod stable_pose;
mod switch;
mod target;
mod throw;

pub use close::Close;
pub use drop::Drop;
pub use grip::Grip;
pub use hand_action::{HandAction, HandContext};
pub use open::Open;
pub use pick::Pick;
pub use place::Place;
pub use place_at::PlaceAt;
pub use place_in_pose::PlaceInPose;
pub use point::Point;
pub use pull::Pull;
pub use push::Push;
pub(crate) use push::{OngoingPush, advance_pushes};
pub use put_in::PutIn;
pub use request::Target;
pub use switch::Toggle;
pub use throw::Throw;

use crate::agents::Agents;
use crate::articulation::WorldJoints;
use crate::dynamics::Dynamics;
use crate::hands::Hands;
use crate::outcome::ActionOutcome;
use dwell_scene::rays::RayScene;
use dwell_scene::{AgentId, State};

/// The agent that performs an action, and its view.
#[derive(Clone, Copy)]
struct Actor<'a> {
    id: AgentId,
    body: dwell_scene::AgentState,
    rays: &'a RayScene,
}

/// The parts of a world that actions read and change.
pub(crate) struct ActionContext<'a> {
    pub(crate) dynamics: &'a mut Dynamics,
    pub(crate) articulation: &'a mut WorldJoints,
    pub(crate) agents: &'a Agents,
    pub(crate) hands: &'a mut Hands,
    pub(crate) pushes: &'a mut Vec<OngoingPush>,
}

impl<'a> ActionContext<'a> {
    /// Returns the hand of an agent that exists. `rays` must show `state` as it is.
    pub(crate) fn hand_of(
        self,
        state: &'a mut State,
        rays: &'a RayScene,
        agent: AgentId,
    ) -> HandContext<'a> {
        let actor = Actor {
            id: agent,
            body: state.agents[agent],
            rays,
        };
        HandContext {
            context: self,
            state,
            actor,
        }
    }
}

/// The outcome of an action; `Err` if it was refused.
pub type ActionResult = Result<ActionOutcome, Box<ActionOutcome>>;
