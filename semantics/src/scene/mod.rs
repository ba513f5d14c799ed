//! A house in one state, as predicates read it.

mod distractor_set;
mod object_cache;

pub(crate) use distractor_set::{
    Attribute, DistractorSet, LandmarkQuery, ObjectList, RelatedPairs,
};
pub(crate) use object_cache::ObjectCache;
pub use object_cache::SurfaceSupport;

use crate::facts::ObjectFacts;
use crate::geometry::Extent;
use crate::semantics::Semantics;
use dwell_scene::bvh::BoxTree;
use dwell_scene::interrupt;
use dwell_scene::{
    Aabb, AgentId, Entity, EntityId, House, Id, IdVec, ObjectId, Pose, ReceptacleKind, RoomId,
    State, StructureId,
};
use glam::Vec3;
use serde::{Deserialize, Serialize};
use std::cell::{OnceCell, RefCell};
use std::collections::BTreeMap;
use std::rc::Rc;

/// Largest number of neighbours that a thing is beside, on, or hung before: where more lie in each other, those about its
/// middle count.
pub(crate) const MOST_NEAR: usize = 128;

/// A term of a predicate.
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
}

impl Term {
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
}

/// A viewer, from which left and right are meant.
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
        let ahead = self.world_from_camera.transform_vector(Vec3::NEG_Z);
        let yaw = dwell_scene::space::yaw_from_forward(ahead);
        Pose::from_position_yaw(self.world_from_camera.position, yaw)
            .inverse()
            .transform_point(point)
    }
}

/// A house in one state, with the measurements so far. Cheap to make: everything is measured at first use.
pub struct SemanticScene<'a> {
    /// The state-independent facts.
    pub semantics: &'a Semantics,
    /// The state.
    pub state: &'a State,
    known: IdVec<ObjectId, ObjectCache>,
    boxes: OnceCell<BoxTree>,
    in_rooms: OnceCell<IdVec<RoomId, Vec<ObjectId>>>,
    windows: OnceCell<IdVec<RoomId, usize>>,
    /// Distractor sets by noun.
    alike: RefCell<BTreeMap<String, Rc<DistractorSet>>>,
}

impl<'a> SemanticScene<'a> {
    fn new(semantics: &'a Semantics, state: &'a State) -> Self {
        let count = semantics.house().objects.len();
        Self {
            semantics,
            state,
            known: (0..count).map(|_| ObjectCache::default()).collect(),
            boxes: OnceCell::new(),
            in_rooms: OnceCell::new(),
            windows: OnceCell::new(),
            alike: RefCell::default(),
        }
    }

    /// The house.
    pub fn house(&self) -> &'a House {
        self.semantics.house()
    }

    /// Returns the state-independent facts about an object.
    pub fn facts(&self, object: ObjectId) -> &'a ObjectFacts {
        self.semantics.facts(object)
    }

    /// Returns whether every part of the object is in its initial pose.
    pub fn at_rest(&self, object: ObjectId) -> bool {
        let house = self.house();
        house.objects[object]
            .parts()
            .all(|part| self.state.part_pose[part] == house.parts[part].world_from_part)
    }

    /// Returns the object's extent.
    pub fn extent(&self, object: ObjectId) -> &Extent {
        if self.at_rest(object) {
            return self.semantics.rest_extent(object);
        }
        let extent = &self.known[object].extent;
        extent.get_or_init(|| Extent::measure(self.house(), self.state, object))
    }

    /// At most `most` things whose boxes share a point with `reach` and for which `counts` is true, rising; of more than that those
    /// about its middle.
    pub(crate) fn within(
        &self,
        reach: &Aabb,
        most: usize,
        mut counts: impl FnMut(ObjectId) -> bool,
    ) -> Vec<ObjectId> {
        let boxes = self.boxes.get_or_init(|| {
            let boxes = self.house().objects.ids().map(|object| {
                interrupt::check();
                self.extent(object).bounds
            });
            BoxTree::new(boxes.collect())
        });
        let counts = |k| counts(ObjectId::from_index(k));
        let found = boxes.nearest(reach, most, counts).into_iter();
        found.map(ObjectId::from_index).collect()
    }

    /// Returns the measurements of an object so far.
    pub(crate) fn cache(&self, object: ObjectId) -> &ObjectCache {
        &self.known[object]
    }

    /// Returns whether things lie on it, never in it, in everyday speech: a book between the arms of a sofa lies on the sofa.
    pub(crate) fn is_lain_upon(&self, object: ObjectId) -> bool {
        let seats = ["chair", "sofa", "bed"];
        let row = self.facts(object).category;
        let mut places = self.house().receptacles_of(object);
        row.is_some_and(|row| seats.contains(&row.nyu40_name) && !row.contains)
            && !places.any(|place| place.holding == ReceptacleKind::In)
    }

    /// Returns the agent that holds the object.
    pub fn holder(&self, object: ObjectId) -> Option<AgentId> {
        self.state.held_by.get(object).copied().flatten()
    }

    /// The room of an object: that of its holder, else the one around the middle of its box (the smallest where rooms
    /// overlap), else, while it stands where the house puts it, the one that the house's file names. `None` outside.
    pub fn room_of(&self, object: ObjectId) -> Option<RoomId> {
        let room = &self.known[object].room;
        *room.get_or_init(|| self.find_room(object))
    }

    fn find_room(&self, object: ObjectId) -> Option<RoomId> {
        if let Some(agent) = self.holder(object) {
            return self.room_of_agent(agent);
        }
        let here = self.house().room_at(self.extent(object).bounds.center());
        here.or_else(|| {
            self.house().objects[object]
                .room
                .filter(|_| self.at_rest(object))
        })
    }

    /// The room an agent stands in; `None` outside.
    pub fn room_of_agent(&self, agent: AgentId) -> Option<RoomId> {
        let agent = self.state.agents.get(agent)?;
        self.house().room_at(agent.position)
    }

    /// The objects in a room, in order.
    pub fn objects_in(&self, room: RoomId) -> &[ObjectId] {
        let rooms = self.in_rooms.get_or_init(|| {
            let mut rooms = IdVec::filled(Vec::new(), self.house().rooms.len());
            for object in self.house().objects.ids() {
                interrupt::check();
                if let Some(room) = self.room_of(object) {
                    rooms[room].push(object);
                }
            }
            rooms
        });
        &rooms[room]
    }

    /// Returns the number of windows of a room.
    pub(crate) fn windows_in(&self, room: RoomId) -> usize {
        let rooms = self.windows.get_or_init(|| {
            let mut rooms = IdVec::filled(0, self.house().rooms.len());
            for window in self.semantics.kinds().windows() {
                if let Some(room) = self.room_of(*window) {
                    rooms[room] += 1;
                }
            }
            rooms
        });
        rooms[room]
    }

    /// The things that may be called by the nouns that were looked up so far.
    pub(crate) fn distractor_cache(&self) -> &RefCell<BTreeMap<String, Rc<DistractorSet>>> {
        &self.alike
    }

    /// The middle of a thing, m; `None` for a room and for an unknown agent.
    pub fn center(&self, term: Term) -> Option<Vec3> {
        match term {
            Term::Object(id) => Some(self.extent(id).bounds.center()),
            Term::Structure(id) => {
                let mesh = self.house().structure[id].mesh;
                Some(self.house().meshes[mesh].bounds().center())
            }
            Term::Room(_) => None,
            Term::Agent(id) => self
                .state
                .agents
                .get(id)
                .map(|agent| agent.position + Vec3::Y * (agent.body.height_m * 0.5)),
        }
    }
}

impl Semantics {
    /// The scene of the house in `state`.
    pub fn scene<'a>(&'a self, state: &'a State) -> SemanticScene<'a> {
        SemanticScene::new(self, state)
    }
}
