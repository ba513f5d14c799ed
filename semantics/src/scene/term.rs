//! The arguments of predicates, and viewers.

use super::SemanticScene;
use dwell_scene::{
    AgentId, Entity, EntityId, House, LevelId, ObjectId, PartId, Pose, RoomId, State, StructureId,
};
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// An argument of a predicate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Term {
    /// An object.
    Object(ObjectId),
    /// A wall, floor or ceiling piece.
    Structure(StructureId),
    /// A room.
    Room(RoomId),
    /// An agent.
    Agent(AgentId),
    /// A storey.
    Storey(LevelId),
    /// A part of an object.
    Part(PartId),
}

/// Kinds of [`Term`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TermKind {
    /// An object.
    Object,
    /// A wall, floor or ceiling piece.
    Structure,
    /// A room.
    Room,
    /// An agent.
    Agent,
    /// A storey.
    Storey,
    /// A part of an object.
    Part,
}

impl TermKind {
    /// The name in plain lower-case letters.
    pub fn name(self) -> &'static str {
        match self {
            Self::Object => "object",
            Self::Structure => "structure",
            Self::Room => "room",
            Self::Agent => "agent",
            Self::Storey => "storey",
            Self::Part => "part",
        }
    }
}

impl Term {
    /// The kind.
    pub fn kind(self) -> TermKind {
        match self {
            Self::Object(_) => TermKind::Object,
            Self::Structure(_) => TermKind::Structure,
            Self::Room(_) => TermKind::Room,
            Self::Agent(_) => TermKind::Agent,
            Self::Storey(_) => TermKind::Storey,
            Self::Part(_) => TermKind::Part,
        }
    }

    /// The object, if it is one.
    pub fn object(self) -> Option<ObjectId> {
        if let Self::Object(id) = self {
            Some(id)
        } else {
            None
        }
    }

    /// The term of a sensor's id; `None` for void, negative ids, and agents that `state` does not have.
    pub fn from_entity(house: &House, state: &State, id: EntityId) -> Option<Self> {
        match house.entity(id)? {
            Entity::Void => None,
            Entity::Structure(piece) => Some(Self::Structure(piece)),
            Entity::Object(object) => Some(Self::Object(object)),
            Entity::Agent(agent) => state.agents.get(agent).map(|_| Self::Agent(agent)),
        }
    }

    /// Returns whether the house, or the state for agents, has it.
    pub fn exists(self, house: &House, state: &State) -> bool {
        match self {
            Self::Object(id) => house.objects.get(id).is_some(),
            Self::Structure(id) => house.structure.get(id).is_some(),
            Self::Room(id) => house.rooms.get(id).is_some(),
            Self::Agent(id) => state.agents.get(id).is_some(),
            Self::Storey(id) => house.levels.get(id).is_some(),
            Self::Part(id) => house.parts.get(id).is_some(),
        }
    }
}

/// The viewer from whom left and right are meant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Viewer {
    /// A camera's pose: it looks along -Z, +X is right.
    pub world_from_camera: Pose,
}

impl Viewer {
    /// The eyes of an agent.
    pub fn of_agent(state: &State, agent: AgentId) -> Option<Self> {
        let agent = state.agents.get(agent)?;
        Some(Self {
            world_from_camera: agent.world_from_eye(),
        })
    }

    /// `point` in the viewer's **upright** frame, m: +X right, +Y up, -Z ahead, turned as the camera is about the vertical
    /// only, so that looking up or down changes no left or right.
    pub fn upright_from_world(&self, point: Vec3) -> Vec3 {
        self.upright().inverse().transform_point(point)
    }

    /// The viewer's upright frame in the world.
    pub(crate) fn upright(&self) -> Pose {
        let ahead = self.world_from_camera.transform_vector(Vec3::NEG_Z);
        let yaw = dwell_scene::space::yaw_from_forward(ahead);
        Pose::from_position_yaw(self.world_from_camera.position, yaw)
    }
}

impl SemanticScene<'_> {
    /// The middle of a thing, m; `None` for a room, a storey and an unknown agent.
    pub fn center(&self, term: Term) -> Option<Vec3> {
        match term {
            Term::Object(id) => Some(self.extent(id).bounds.center()),
            Term::Structure(id) => Some(self.semantics.structure_bounds(id).center()),
            Term::Part(id) => Some(self.house().part_bounds(self.state, id).center()),
            Term::Room(_) | Term::Storey(_) => None,
            Term::Agent(id) => self
                .state
                .agents
                .get(id)
                .map(|agent| agent.position + Vec3::Y * (agent.body.height_m * 0.5)),
        }
    }

    /// All objects, pieces of the building, rooms, storeys and agents.
    pub fn terms(&self) -> impl Iterator<Item = Term> {
        let house = self.house();
        let objects = house.objects.ids().map(Term::Object);
        let pieces = house.structure.ids().map(Term::Structure);
        let rooms = house.rooms.ids().map(Term::Room);
        let agents = self.state.agents.ids().map(Term::Agent);
        let storeys = house.levels.ids().map(Term::Storey);
        objects
            .chain(pieces)
            .chain(rooms)
            .chain(agents)
            .chain(storeys)
    }
}
