//! A house in one state, as predicates see it.

mod distractor_set;
mod object_cache;
mod term;

pub(crate) use distractor_set::{
    Attribute, DistractorSet, LandmarkQuery, ObjectList, RelatedPairs,
};
pub(crate) use object_cache::ObjectCache;
pub use object_cache::SupportShare;
pub use term::{Term, TermKind, Viewer};

use crate::facts::ObjectFacts;
use crate::geometry::Extent;
use crate::reachable_area::ReachableArea;
use crate::semantics::Semantics;
use dwell_scene::bvh::BoxTree;
use dwell_scene::interrupt;
use dwell_scene::rays::RayScene;
use dwell_scene::{
    Aabb, AgentId, House, Id, IdVec, LevelId, ObjectId, ReceptacleKind, RoomId, State,
};
use std::cell::{OnceCell, RefCell};
use std::collections::BTreeMap;
use std::rc::Rc;

/// Largest number of things near a thing (beside it, under it, behind it) that are looked at: those about its middle.
pub(crate) const MOST_NEAR: usize = 128;

/// A house in one state, with a cache of measurements. Cheap to make: everything is measured at first use.
pub struct SemanticScene<'a> {
    /// The state-independent facts.
    pub semantics: &'a Semantics,
    /// The state.
    pub state: &'a State,
    known: IdVec<ObjectId, ObjectCache>,
    boxes: OnceCell<BoxTree>,
    in_rooms: OnceCell<IdVec<RoomId, Vec<ObjectId>>>,
    /// The loads of each carrier and the contents of each container; filled by predicates.
    pub(crate) loads: OnceCell<BTreeMap<Term, Vec<ObjectId>>>,
    pub(crate) contents: OnceCell<BTreeMap<ObjectId, Vec<ObjectId>>>,
    rays: OnceCell<RayScene>,
    reach: RefCell<BTreeMap<AgentId, Rc<ReachableArea>>>,
    /// The things that each noun can name, by noun.
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
            loads: OnceCell::new(),
            contents: OnceCell::new(),
            rays: OnceCell::new(),
            reach: RefCell::default(),
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
    pub fn is_in_initial_pose(&self, object: ObjectId) -> bool {
        let house = self.house();
        house.objects[object]
            .parts()
            .all(|part| self.state.part_pose[part] == house.parts[part].world_from_part)
    }

    /// Returns the object's extent.
    pub fn extent(&self, object: ObjectId) -> &Extent {
        if self.is_in_initial_pose(object) {
            return self.semantics.initial_extent(object);
        }
        let extent = &self.known[object].extent;
        extent.get_or_init(|| self.semantics.moved_extent(self.state, object))
    }

    /// Returns at most `most` things whose boxes share a point with `reach` and for which `counts` is true, ascending; of more than
    /// that, those about its middle.
    pub(crate) fn objects_near(
        &self,
        reach: &Aabb,
        most: usize,
        mut counts: impl FnMut(ObjectId) -> bool,
    ) -> Vec<ObjectId> {
        let boxes = self.boxes.get_or_init(|| {
            let boxes = self.house().objects.ids().map(|object| {
                interrupt::unwind_if_cancelled();
                self.extent(object).bounds
            });
            BoxTree::new(boxes.collect())
        });
        let counts = |k| counts(ObjectId::from_index(k));
        let found = boxes
            .k_nearest_intersecting(reach, most, counts)
            .into_iter();
        found.map(ObjectId::from_index).collect()
    }

    /// Returns the measurements of an object so far.
    pub(crate) fn cache(&self, object: ObjectId) -> &ObjectCache {
        &self.known[object]
    }

    /// Returns whether things lie on it, never in it, in everyday speech: a book between the arms of a sofa lies on the sofa.
    pub(crate) fn is_seat_or_bed(&self, object: ObjectId) -> bool {
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
                .filter(|_| self.is_in_initial_pose(object))
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
                interrupt::unwind_if_cancelled();
                if let Some(room) = self.room_of(object) {
                    rooms[room].push(object);
                }
            }
            rooms
        });
        &rooms[room]
    }

    /// The storey a thing is on: its room's; outside of rooms, the one that the house's file names while it was not moved, else
    /// the highest whose lowest room floor lies at most 0.3 m above its foot.
    pub fn storey_of(&self, term: Term) -> Option<LevelId> {
        let house = self.house();
        let (room, foot_m) = match term {
            Term::Storey(id) => return Some(id),
            Term::Structure(id) => return Some(house.structure[id].level),
            Term::Room(id) => return Some(house.rooms[id].level),
            Term::Part(id) => return self.storey_of(Term::Object(house.parts[id].object)),
            Term::Object(id) => (self.room_of(id), self.extent(id).bounds.min.y),
            Term::Agent(id) => (
                self.room_of_agent(id),
                self.state.agents.get(id)?.position.y,
            ),
        };
        if let Some(room) = room {
            return Some(house.rooms[room].level);
        }
        if let Term::Object(id) = term
            && self.is_in_initial_pose(id)
        {
            return Some(house.objects[id].level);
        }
        let floors = house
            .rooms
            .iter()
            .filter(|room| room.floor_y <= foot_m + 0.3);
        let under = floors.map(|room| room.level).max();
        under.or_else(|| house.levels.ids().next())
    }

    /// The surfaces of the house in this state, for rays.
    pub fn rays(&self) -> &RayScene {
        self.rays.get_or_init(|| {
            let mut rays = RayScene::new(self.semantics.shared_house().clone());
            rays.update(self.state);
            rays
        })
    }

    /// Returns the area that an agent can reach from its place; `None` for an unknown agent, and for one that does not stand on
    /// walkable floor.
    pub(crate) fn reachable_area(&self, agent: AgentId) -> Option<Rc<ReachableArea>> {
        if let Some(known) = self.reach.borrow().get(&agent) {
            return Some(known.clone());
        }
        let area = Rc::new(self.semantics.reachable_area(self.state, agent)?);
        self.reach.borrow_mut().insert(agent, area.clone());
        Some(area)
    }

    /// The things that each noun can name, of the nouns that were looked up so far.
    pub(crate) fn distractor_cache(&self) -> &RefCell<BTreeMap<String, Rc<DistractorSet>>> {
        &self.alike
    }
}

impl Semantics {
    /// The scene of the house in `state`.
    pub fn scene<'a>(&'a self, state: &'a State) -> SemanticScene<'a> {
        SemanticScene::new(self, state)
    }
}
