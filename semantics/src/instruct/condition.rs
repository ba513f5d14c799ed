//! Conditions that the steps of an instruction bring about.

use super::task::{FOUND_M, InstructionGoal};
use crate::predicates;
use crate::scene::{SemanticScene, Term};
use crate::truth::Truth;
use dwell_scene::rays::RayScene;
use dwell_scene::{AgentId, ObjectId, RoomId};
use serde::{Deserialize, Serialize};

/// What is so when a step of an instruction is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StepCondition {
    /// The agent stands in a room.
    AgentIn(RoomId),
    /// The agent stands within 1.5 m of a thing and sees it at most 45 degrees from where it looks, or holds it.
    Found(ObjectId),
    /// The agent holds a thing.
    Held(ObjectId),
    /// A thing is open: the predicate `open`.
    Open(ObjectId),
    /// A thing is closed: the predicate `closed`.
    Closed(ObjectId),
    /// A thing is switched on: the predicate `switched_on`.
    SwitchedOn(ObjectId),
    /// A thing is switched off: the predicate `switched_off`.
    SwitchedOff(ObjectId),
    /// A thing is in a room (the predicate `in_room`), and nobody holds it.
    LeftIn(ObjectId, RoomId),
}

impl StepCondition {
    /// Returns whether it is so; `false` for an agent that does not exist.
    ///
    /// `rays` must be up to date with the scene's state.
    pub fn holds(self, scene: &SemanticScene<'_>, rays: &RayScene, agent: AgentId) -> bool {
        let is = |predicate: &str, arguments: &[Term]| {
            let found = predicates::find(predicate);
            found.is_ok_and(|found| found.holds(scene, arguments, None) == Truth::True)
        };
        match self {
            Self::AgentIn(room) => scene.room_of_agent(agent) == Some(room),
            Self::Found(object) => Self::found_goal(object).is_reached(scene, rays, agent),
            Self::Held(object) => {
                let holder = scene.state.agents.get(agent);
                holder.is_some_and(|holder| holder.holding == Some(object))
            }
            Self::Open(object) => is("open", &[Term::Object(object)]),
            Self::Closed(object) => is("closed", &[Term::Object(object)]),
            Self::SwitchedOn(object) => is("switched_on", &[Term::Object(object)]),
            Self::SwitchedOff(object) => is("switched_off", &[Term::Object(object)]),
            Self::LeftIn(object, room) => {
                let place = [Term::Object(object), Term::Room(room)];
                scene.holder(object).is_none() && is("in_room", &place)
            }
        }
    }

    /// The goal of an agent that is to find a thing.
    pub fn found_goal(object: ObjectId) -> InstructionGoal {
        InstructionGoal::objects(vec![object], FOUND_M)
    }

    /// The thing that it is about, if it is about one.
    pub fn object(self) -> Option<ObjectId> {
        match self {
            Self::AgentIn(_) => None,
            Self::Found(object)
            | Self::Held(object)
            | Self::Open(object)
            | Self::Closed(object)
            | Self::SwitchedOn(object)
            | Self::SwitchedOff(object)
            | Self::LeftIn(object, _) => Some(object),
        }
    }

    /// The room that it is about, if it is about one.
    pub fn room(self) -> Option<RoomId> {
        match self {
            Self::AgentIn(room) | Self::LeftIn(_, room) => Some(room),
            _ => None,
        }
    }

    /// Returns whether it is about where the agent is alone: once it was so, it need not stay so.
    pub fn is_passing(self) -> bool {
        matches!(self, Self::AgentIn(_) | Self::Found(_))
    }
}
