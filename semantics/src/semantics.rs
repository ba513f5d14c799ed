//! The entry point: a house, and what can be said about it.

use crate::color::material_colors;
use crate::error::SemanticsError;
use crate::facts::Facts;
use crate::geometry::{Extent, Hull};
use crate::predicates;
use crate::rooms::RoomFacts;
use crate::scene::{Scene, Term, Viewer};
use crate::seen::seen_surfaces;
use dwell_scene::rays::RayScene;
use dwell_scene::{Aabb, House, IdVec, MaterialId, ObjectId, RoomId, State, StructureId};
use glam::Vec2;
use std::sync::Arc;

/// Everything about a house that stays true in every state. Make it once and share it.
#[derive(Debug)]
pub struct Semantics {
    house: Arc<House>,
    facts: IdVec<ObjectId, Facts>,
    rest_extents: IdVec<ObjectId, Extent>,
    structure: IdVec<StructureId, (Aabb, Hull)>,
    rooms: IdVec<RoomId, RoomFacts>,
    colors: IdVec<MaterialId, [f32; 3]>,
}

impl Semantics {
    /// Gathers the lasting facts of `house`.
    pub fn new(house: &Arc<House>) -> Self {
        let state = State::new(house);
        let colors = material_colors(house);
        let objects = || house.objects.ids();
        let structure = house.structure.iter().map(|piece| {
            let mesh = &house.meshes[piece.mesh];
            let outline = mesh.positions.iter().map(|p| Vec2::new(p.x, p.z));
            (mesh.bounds(), Hull::around(outline))
        });
        let rest_extents: IdVec<ObjectId, Extent> = objects()
            .map(|id| Extent::measure(house, &state, id))
            .collect();
        let rays = RayScene::new(house.clone());
        let bounds = rest_extents.iter().map(|extent| extent.bounds).collect();
        let seen = seen_surfaces(&rays, &bounds);
        let facts: IdVec<ObjectId, Facts> = objects()
            .map(|id| Facts::gather(house, &colors, &seen[id], id))
            .collect();
        let doors = facts.iter_ids().filter(|(_, facts)| facts.is_door());
        let doors: Vec<Aabb> = doors.map(|(id, _)| bounds[id]).collect();
        Self {
            structure: structure.collect(),
            rooms: RoomFacts::gather(&rays, &colors, &doors),
            facts,
            rest_extents,
            colors,
            house: house.clone(),
        }
    }

    /// The house.
    pub fn house(&self) -> &House {
        &self.house
    }

    /// What is always true of an object.
    pub fn facts(&self, object: ObjectId) -> &Facts {
        &self.facts[object]
    }

    /// What is always true of a room.
    pub fn room(&self, room: RoomId) -> &RoomFacts {
        &self.rooms[room]
    }

    /// Mean colour of a material in linear light: texture times base colour.
    pub fn material_color(&self, material: MaterialId) -> [f32; 3] {
        self.colors[material]
    }

    pub(crate) fn rest_extent(&self, object: ObjectId) -> &Extent {
        &self.rest_extents[object]
    }

    pub(crate) fn structure_bounds(&self, piece: StructureId) -> &Aabb {
        &self.structure[piece].0
    }

    pub(crate) fn structure_outline(&self, piece: StructureId) -> &Hull {
        &self.structure[piece].1
    }

    /// The house in `state`, ready for questions.
    pub fn scene<'a>(&'a self, state: &'a State) -> Scene<'a> {
        Scene::new(self, state)
    }

    /// Whether the relation `predicate` holds between two things.
    ///
    /// # Errors
    /// [`SemanticsError::UnknownPredicate`] for a name that [`predicates::all`] lacks.
    pub fn evaluate(
        &self,
        state: &State,
        predicate: &str,
        subject: Term,
        object: Term,
        viewer: Option<&Viewer>,
    ) -> Result<bool, SemanticsError> {
        Ok(predicates::find(predicate)?.holds(&self.scene(state), subject, object, viewer))
    }
}
