//! The entry point: a house with its semantics.

use crate::color::{self, ColorVocabulary, MaterialColors, color_words};
use crate::doorways::RoomDoorway;
use crate::extent_cache::ExtentCache;
use crate::facts::ObjectFacts;
use crate::geometry::{Extent, Hull};
use crate::language::Language;
use crate::noun_index::NounIndex;
use crate::reachable_area::{NavGridPool, ReachableArea};
use crate::room_contents::RoomContents;
use crate::room_kind::preposition;
use crate::room_outline::RoomOutline;
use crate::rooms::RoomProperties;
use crate::visible_area::visible_surface_areas;
use dwell_scene::bvh::BoxTree;
use dwell_scene::navigation::NavGrid;
use dwell_scene::parallel::Threads;
use dwell_scene::rays::RayScene;
use dwell_scene::{
    Aabb, AgentBody, AgentId, House, Id, IdVec, MaterialId, ObjectId, RoomId, State, StructureId,
};
use glam::Vec2;
use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

/// State-independent semantics of a house. Make it once and share it.
#[derive(Debug)]
pub struct Semantics {
    house: Arc<House>,
    facts: IdVec<ObjectId, ObjectFacts>,
    kinds: NounIndex,
    rest_extents: IdVec<ObjectId, Extent>,
    moved_extents: ExtentCache,
    structure: IdVec<StructureId, (Aabb, Hull)>,
    structure_boxes: BoxTree,
    rooms: IdVec<RoomId, RoomProperties>,
    outlines: IdVec<RoomId, RoomOutline>,
    walkers: NavGridPool,
    doorways: BTreeMap<ObjectId, RoomDoorway>,
    colors: MaterialColors,
    language: OnceLock<Language>,
}

impl Semantics {
    /// Computes the facts of `house`.
    pub fn new(house: &Arc<House>) -> Self {
        let state = State::new(house);
        let threads = Threads::resolve(None);
        let ((), (paints, structure, rest_extents)) = threads.join(
            || house.bake_geometry(threads),
            || {
                // Whoever asks for facts goes on to say them. One thread compiles the grammar and reads the names of colours, for
                // which both would wait later, while the other bakes; they share what follows.
                Language::english();
                color::read_tables();
                (
                    MaterialColors::gather(house),
                    structure_outlines(house),
                    rest_extents(house, &state),
                )
            },
        );
        let rays = RayScene::new(house.clone());
        let bounds: IdVec<ObjectId, Aabb> =
            rest_extents.iter().map(|extent| extent.bounds).collect();
        let seen = visible_surface_areas(&rays, &bounds);
        let facts: IdVec<ObjectId, ObjectFacts> = threads
            .map(house.objects.len(), |k| {
                let id = ObjectId::from_index(k);
                ObjectFacts::gather(house, &paints, &seen[id], id)
            })
            .into();
        let doors = facts.iter_ids().filter(|(_, facts)| facts.is_door());
        let doors: Vec<ObjectId> = doors.map(|(id, _)| id).collect();
        let ways = threads.map(doors.len(), |k| {
            RoomDoorway::gather(&rays, &state, doors[k], bounds[doors[k]])
        });
        let doorways: BTreeMap<ObjectId, RoomDoorway> = doors.into_iter().zip(ways).collect();
        let doors: Vec<Aabb> = doorways.keys().map(|id| bounds[*id]).collect();
        let contents = RoomContents::gather(house, &bounds, &facts);
        Self {
            structure_boxes: BoxTree::new(structure.iter().map(|(bounds, _)| *bounds).collect()),
            structure,
            kinds: NounIndex::gather(&facts),
            rooms: RoomProperties::gather(&rays, &paints, &doors, &contents),
            outlines: house.rooms.iter().map(RoomOutline::gather).collect(),
            walkers: NavGridPool::default(),
            doorways,
            facts,
            rest_extents,
            moved_extents: ExtentCache::new(house),
            colors: paints,
            language: OnceLock::new(),
            house: house.clone(),
        }
    }

    /// The house.
    pub fn house(&self) -> &House {
        &self.house
    }

    /// English with the nouns of this house: those of things and rooms outside the tables, too.
    pub fn language(&self) -> &Language {
        self.language.get_or_init(|| {
            let things = self.facts.iter();
            let nouns = things.map(|facts| (facts.noun.as_str(), facts.plural.as_str()));
            let rooms = self.rooms.iter();
            let rooms = rooms.map(|room| {
                let (one, several) = (room.noun.as_str(), room.plural.as_str());
                (one, several, preposition(one))
            });
            Language::english().with_nouns(nouns, rooms)
        })
    }

    /// The colours of walls or a floor in words with their shares, largest first, by the rays that meet each material.
    pub(crate) fn surface_color_words(
        &self,
        rays: &[(MaterialId, f32)],
    ) -> Vec<(&'static str, f32)> {
        let patches = self.colors.patches(rays.iter().copied());
        color_words(&patches, ColorVocabulary::Surface)
    }

    pub(crate) fn shared_house(&self) -> &Arc<House> {
        &self.house
    }

    /// Returns the area that an agent can reach as things stand; `None` for an unknown agent, and off walkable floor.
    pub(crate) fn reachable_area(&self, state: &State, agent: AgentId) -> Option<ReachableArea> {
        let agent = state.agents.get(agent)?;
        self.walkers.reachable_area(&self.house, state, agent)
    }

    /// Returns what `query` finds on the navigation grid of a body that opens doors; `None` where it can't walk.
    pub(crate) fn with_open_doors<T>(
        &self,
        state: &State,
        body: &AgentBody,
        query: impl FnOnce(&NavGrid) -> T,
    ) -> Option<T> {
        self.walkers
            .with_open_doors(&self.house, state, body, query)
    }

    /// A room seen from above.
    pub(crate) fn room_outline(&self, room: RoomId) -> &RoomOutline {
        &self.outlines[room]
    }

    /// Returns the state-independent facts about an object.
    pub fn facts(&self, object: ObjectId) -> &ObjectFacts {
        &self.facts[object]
    }

    /// Returns the state-independent facts about a room.
    pub fn room(&self, room: RoomId) -> &RoomProperties {
        &self.rooms[room]
    }

    /// Returns the rooms that a door or archway connects; `None` for other things.
    pub fn doorway(&self, door: ObjectId) -> Option<&RoomDoorway> {
        self.doorways.get(&door)
    }

    /// The doors and archways with their rooms, ascending.
    pub(crate) fn doorways(&self) -> impl Iterator<Item = (ObjectId, &RoomDoorway)> {
        self.doorways.iter().map(|(door, doorway)| (*door, doorway))
    }

    /// The colour that most of each material has.
    pub(crate) fn material_colors(&self) -> &MaterialColors {
        &self.colors
    }

    pub(crate) fn initial_extent(&self, object: ObjectId) -> &Extent {
        &self.rest_extents[object]
    }

    /// Returns where an object is that does not stand where the house puts it.
    pub(crate) fn moved_extent(&self, state: &State, object: ObjectId) -> Arc<Extent> {
        self.moved_extents.get(&self.house, state, object)
    }

    pub(crate) fn structure_bounds(&self, piece: StructureId) -> &Aabb {
        &self.structure[piece].0
    }

    pub(crate) fn structure_outline(&self, piece: StructureId) -> &Hull {
        &self.structure[piece].1
    }

    /// The structure pieces whose boxes share a point with `reach`, ascending.
    pub(crate) fn structures_in_box(
        &self,
        reach: &Aabb,
    ) -> impl Iterator<Item = StructureId> + use<> {
        let touching = self.structure_boxes.intersecting(reach).into_iter();
        touching.map(StructureId::from_index)
    }

    pub(crate) fn noun_index(&self) -> &NounIndex {
        &self.kinds
    }

    /// The numbers of the kinds of things that may be called `noun`.
    pub(crate) fn kinds_called(&self, noun: &str) -> Vec<u32> {
        self.kinds.kinds_called(&self.facts, noun)
    }
}

/// The box around each structure piece and its outline from above.
fn structure_outlines(house: &House) -> IdVec<StructureId, (Aabb, Hull)> {
    let pieces = house.structure.as_slice();
    Threads::resolve(None)
        .map(pieces.len(), |k| {
            let mesh = &house.meshes[pieces[k].mesh];
            let outline = mesh.positions.iter().map(|p| Vec2::new(p.x, p.z));
            (mesh.bounds(), Hull::around(outline))
        })
        .into()
}

/// The extent of each object in the initial state.
fn rest_extents(house: &House, state: &State) -> IdVec<ObjectId, Extent> {
    Threads::resolve(None)
        .map(house.objects.len(), |k| {
            Extent::measure(house, state, ObjectId::from_index(k))
        })
        .into()
}
