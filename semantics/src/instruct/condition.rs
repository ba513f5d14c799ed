//! Conditions that the steps of an instruction bring about.

use super::task::{FOUND_M, InstructionGoal};
use crate::line_of_sight::{FieldOfView, is_in_line_of_sight};
use crate::predicates;
use crate::scene::{SemanticScene, Term, Viewer};
use crate::truth::Truth;
use dwell_scene::rays::RayScene;
use dwell_scene::{AgentId, ObjectId, RoomId};
use glam::Vec2;
use serde::{Deserialize, Serialize};

/// Largest distance from a thing's outline at which an agent faces it, m.
const FACED_M: f32 = 3.0;
/// Half the angle within which the thing must lie for the agent to face it, rad: 15 degrees.
const FACED_HALF_ANGLE_RAD: f32 = std::f32::consts::FRAC_PI_4 / 3.0;

/// What conditions are judged by.
#[derive(Clone, Copy)]
pub struct ConditionContext<'a> {
    /// The scene.
    pub scene: &'a SemanticScene<'a>,
    /// Its rays, up to date with its state.
    pub rays: &'a RayScene,
    /// The agent that carries out the step.
    pub agent: AgentId,
    /// What it has just pointed at.
    pub pointed_at: Option<ObjectId>,
}

/// What is so when a step of an instruction is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StepCondition {
    /// The agent stands in a room.
    AgentIn(RoomId),
    /// The agent stands within 1.5 m of a thing and sees it at most 45 degrees from where it looks, or holds it.
    Found(ObjectId),
    /// The agent stands within 3 m of a thing and sees it at most 15 degrees from where it looks.
    Faced(ObjectId),
    /// The agent has pointed at a thing that it sees.
    PointedAt(ObjectId),
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
    /// A thing is on another (the predicate `on`), and nobody holds it.
    On(ObjectId, ObjectId),
    /// A thing is in another (the predicate `inside`), and nobody holds it.
    Inside(ObjectId, ObjectId),
}

impl StepCondition {
    /// Returns whether it is so; `false` for an agent that does not exist.
    pub fn holds(self, view: &ConditionContext<'_>) -> bool {
        let ConditionContext {
            scene, rays, agent, ..
        } = *view;
        match self {
            Self::AgentIn(room) => scene.room_of_agent(agent) == Some(room),
            Self::Found(object) => Self::find_object_goal(object).is_reached(scene, rays, agent),
            Self::Faced(object) => {
                let body = scene.state.agents.get(agent);
                let near = body.is_some_and(|body| {
                    let here = Vec2::new(body.position.x, body.position.z);
                    scene.extent(object).footprint.distance_to(here) <= FACED_M
                });
                near && view.sees(object, FieldOfView::Cone(FACED_HALF_ANGLE_RAD))
            }
            Self::PointedAt(object) => {
                view.pointed_at == Some(object) && view.sees(object, FieldOfView::Around)
            }
            Self::Held(object) => {
                let holder = scene.state.agents.get(agent);
                holder.is_some_and(|holder| holder.holding == Some(object))
            }
            _ => self.holds_of_things(scene),
        }
    }

    /// Returns whether it is so of things alone, whatever an agent does; `false` for conditions that are about an agent.
    pub fn holds_of_things(self, scene: &SemanticScene<'_>) -> bool {
        let is = |predicate: &str, arguments: &[Term]| {
            let found = predicates::find(predicate);
            found.is_ok_and(|found| found.holds(scene, arguments, None) == Truth::True)
        };
        let left = |object: ObjectId, predicate: &str, place: Term| {
            scene.holder(object).is_none() && is(predicate, &[Term::Object(object), place])
        };
        match self {
            Self::AgentIn(_)
            | Self::Found(_)
            | Self::Faced(_)
            | Self::PointedAt(_)
            | Self::Held(_) => false,
            Self::Open(object) => is("open", &[Term::Object(object)]),
            Self::Closed(object) => is("closed", &[Term::Object(object)]),
            Self::SwitchedOn(object) => is("switched_on", &[Term::Object(object)]),
            Self::SwitchedOff(object) => is("switched_off", &[Term::Object(object)]),
            Self::LeftIn(object, room) => left(object, "in_room", Term::Room(room)),
            Self::On(object, support) => left(object, "on", Term::Object(support)),
            Self::Inside(object, container) => left(object, "inside", Term::Object(container)),
        }
    }

    /// The goal of an agent that is to find a thing.
    pub fn find_object_goal(object: ObjectId) -> InstructionGoal {
        InstructionGoal::objects(vec![object], FOUND_M)
    }

    /// The thing that it is about, if it is about one.
    pub fn object(self) -> Option<ObjectId> {
        match self {
            Self::AgentIn(_) => None,
            Self::Found(object)
            | Self::Faced(object)
            | Self::PointedAt(object)
            | Self::Held(object)
            | Self::Open(object)
            | Self::Closed(object)
            | Self::SwitchedOn(object)
            | Self::SwitchedOff(object)
            | Self::LeftIn(object, _)
            | Self::On(object, _)
            | Self::Inside(object, _) => Some(object),
        }
    }

    /// The things that it is about: the thing, and what it is on or in.
    pub fn objects(self) -> Vec<ObjectId> {
        let place = match self {
            Self::On(_, place) | Self::Inside(_, place) => Some(place),
            _ => None,
        };
        self.object().into_iter().chain(place).collect()
    }

    /// The room that it is about, if it is about one.
    pub fn room(self) -> Option<RoomId> {
        match self {
            Self::AgentIn(room) | Self::LeftIn(_, room) => Some(room),
            _ => None,
        }
    }

    /// Returns whether it is about where the agent is and looks alone: once it was so, it need not stay so.
    pub fn is_transient(self) -> bool {
        let of_place = matches!(self, Self::AgentIn(_) | Self::Found(_) | Self::Faced(_));
        of_place || self.is_event()
    }

    /// Returns whether it happens rather than lasts.
    pub fn is_event(self) -> bool {
        matches!(self, Self::PointedAt(_))
    }
}

impl ConditionContext<'_> {
    fn sees(&self, object: ObjectId, field: FieldOfView) -> bool {
        let viewer = Viewer::of_agent(self.scene.state, self.agent);
        viewer.is_some_and(|viewer| {
            is_in_line_of_sight(self.scene, self.rays, &viewer, object, field)
        })
    }
}
