//! State-independent facts about a room.

use crate::color::{ColorShare, ColorVocabulary, MaterialColors, color_words};
use crate::english;
use crate::form::Noun;
use crate::open_passages::passages;
use crate::room_contents::RoomContents;
use crate::room_kind::{RoomCategory, preposition, room_kinds};
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::material::library;
use dwell_scene::math;
use dwell_scene::parallel::Threads;
use dwell_scene::rays::RayScene;
use dwell_scene::{Aabb, House, Id, IdVec, MaterialId, RoomId, StructureKind, SurfaceOwner};
use glam::Vec3;
use std::collections::BTreeMap;

/// Number of sample points of a room's floor.
const POINTS: usize = 256;
/// Number of them from which its walls are looked at.
const LOOKS: usize = 12;
/// Number of directions from each.
const DIRECTIONS: usize = 48;
/// Their slopes, in turn: walls may be tiled below and painted above.
const SLOPES: [f32; 3] = [-0.3, 0.0, 0.3];

/// The lasting facts about a room.
#[derive(Clone, Debug)]
pub struct RoomProperties {
    /// Its kind, if the table knows it.
    pub kind: Option<&'static RoomCategory>,
    /// Spoken noun, for one.
    pub noun: String,
    /// Spoken noun, for several.
    pub plural: String,
    /// Every word it may be called by: its kinds' nouns and synonyms.
    pub names: Vec<String>,
    /// A name of its own in the house, without article: "kitchen", "second bedroom".
    pub label: String,
    /// Its place among the rooms that may be called by its noun, in the house's order, counted from 1; `None` for the only one.
    pub number: Option<u32>,
    /// Area of the floor that lies in no smaller room (as rooms of some files do), m².
    pub area_m2: f32,
    /// The adjective of most of its floor: "tiled".
    pub floor_word: Option<&'static str>,
    /// The colour word of most of its floor.
    pub floor_color: Option<&'static str>,
    /// The colour word of most of its walls' inner faces.
    pub wall_color: Option<&'static str>,
    /// The rooms that it is open to without a door between, ascending.
    pub passages: Vec<RoomId>,
}

impl RoomProperties {
    pub(crate) fn gather(
        rays: &RayScene,
        paints: &MaterialColors,
        doors: &[Aabb],
        contents: &RoomContents,
    ) -> IdVec<RoomId, Self> {
        let house = rays.house();
        let surfaces = RoomSurfaces::gather(rays, paints);
        let passages = passages(rays, doors);
        let mut rooms: IdVec<RoomId, Self> = house
            .rooms
            .ids()
            .map(|id| Self::of(house, &surfaces, contents, id))
            .collect();
        for (room, open) in rooms.iter_mut().zip(passages.iter()) {
            room.passages.clone_from(open);
        }
        // As a description with an order counts them: among all rooms that may be called so.
        let mut called: BTreeMap<String, Vec<RoomId>> = BTreeMap::new();
        for (id, room) in rooms.iter_ids() {
            for name in &room.names {
                called.entry(name.clone()).or_default().push(id);
            }
        }
        called.insert(Noun::ANY_ROOM.to_owned(), rooms.ids().collect());
        for (id, room) in rooms.iter_mut().enumerate() {
            let alike = &called[&room.noun];
            if alike.len() > 1 {
                let before = alike.partition_point(|other| other.index() < id);
                room.number = Some(before as u32 + 1);
                room.label = format!("{} {}", english::ordinal(before + 1), room.noun);
            }
        }
        rooms
    }

    fn of(house: &House, surfaces: &RoomSurfaces, contents: &RoomContents, id: RoomId) -> Self {
        let room = &house.rooms[id];
        let labels = room.kinds.iter();
        let mut kinds: Vec<Option<&RoomCategory>> =
            labels.map(|kind| room_kinds().get(kind)).collect();
        // It may still be called by its label.
        if let Some(kind) = contents.kind(id, kinds.first().copied().flatten()) {
            kinds.insert(0, Some(kind));
        }
        let kind = kinds.first().copied().flatten();
        let said = room.kinds.first().map(String::as_str);
        let said = said.filter(|kind| kind.chars().any(char::is_alphanumeric));
        let said = said.unwrap_or(Noun::ANY_ROOM);
        let (noun, plural) = kind.map_or_else(
            || (said.to_owned(), english::plural(said)),
            |kind| (kind.singular.to_owned(), kind.plural.to_owned()),
        );
        let mut names: Vec<String> = vec![noun.clone()];
        for kind in kinds.into_iter().flatten() {
            names.push(kind.singular.to_owned());
            names.extend(kind.synonyms.iter().map(|&name| name.to_owned()));
        }
        names.dedup();
        Self {
            kind,
            label: noun.clone(),
            number: None,
            noun,
            plural,
            names,
            area_m2: house.exclusive_area_m2(id),
            floor_word: surfaces.floor_word(id),
            floor_color: dominant_color_word(&surfaces.floor_paints[id]),
            wall_color: dominant_color_word(&surfaces.walls[id]),
            passages: Vec::new(),
        }
    }

    /// Returns the phrase of place in it: "in the kitchen", "on the second balcony".
    pub fn locative_phrase(&self) -> String {
        format!("{} the {}", preposition(&self.noun), self.label)
    }

    /// Returns whether it may be called `name`; every room is a "room".
    pub fn is_called(&self, name: &str) -> bool {
        name == Noun::ANY_ROOM || self.names.iter().any(|known| known == name) || self.label == name
    }
}

/// Areas of floors by substance and seen walls by material, per room.
struct RoomSurfaces {
    floors: IdVec<RoomId, BTreeMap<String, f32>>,
    floor_paints: IdVec<RoomId, Vec<ColorShare>>,
    walls: IdVec<RoomId, Vec<ColorShare>>,
}

impl RoomSurfaces {
    fn gather(rays: &RayScene, paints: &MaterialColors) -> Self {
        let house = rays.house();
        let count = house.rooms.len();
        let mut floors = IdVec::filled(BTreeMap::new(), count);
        let mut floor_areas = IdVec::filled(BTreeMap::new(), count);
        for piece in &house.structure {
            let mesh = &house.meshes[piece.mesh];
            for triangle in 0..mesh.triangles.len() {
                let [a, b, c] = mesh.corners(triangle);
                let normal = (b - a).cross(c - a);
                let (Some(out), Some(id)) = (
                    normal.try_normalize(),
                    piece.materials.get(usize::from(mesh.slot(triangle))),
                ) else {
                    continue;
                };
                let area_m2 = normal.length() * 0.5;
                match (piece.kind, piece.room) {
                    (StructureKind::Floor, Some(room)) if out.y > 0.5 => {
                        let substance = house.materials[*id].substance.clone();
                        *floors[room].entry(substance).or_insert(0.0) += area_m2;
                        *floor_areas[room].entry(*id).or_insert(0.0) += area_m2;
                    }
                    _ => {}
                }
            }
        }
        let walls = Threads::resolve(None).map(count, |k| {
            let points = house.points_in_room(RoomId::from_index(k), POINTS);
            paints.patches(visible_wall_areas(rays, &points))
        });
        Self {
            floors,
            floor_paints: floor_areas
                .iter()
                .map(|areas: &BTreeMap<MaterialId, f32>| {
                    paints.patches(areas.iter().map(|(id, area_m2)| (*id, *area_m2)))
                })
                .collect(),
            walls: walls.into(),
        }
    }

    fn floor_word(&self, room: RoomId) -> Option<&'static str> {
        let floor = &self.floors[room];
        let total: f32 = floor.values().sum();
        let (name, _) = floor.iter().find(|(_, area)| **area >= 0.5 * total)?;
        let substance = library()
            .get(name)
            .filter(|substance| substance.name != "hard_surface")?;
        Some(&substance.adjective)
    }
}

/// The colour word of at least half of a surface.
fn dominant_color_word(patches: &[ColorShare]) -> Option<&'static str> {
    let words = color_words(patches, ColorVocabulary::Surface);
    let (word, _) = words.first().filter(|(_, share)| *share >= 0.5)?;
    Some(word)
}

/// The visible wall materials of a room, by number of horizontal directions.
///
/// Walls have two shells and rooms may overlap, so a room's own surfaces are not those seen in it.
fn visible_wall_areas(rays: &RayScene, points: &[Vec3]) -> BTreeMap<MaterialId, f32> {
    let mut areas = BTreeMap::new();
    let step = (points.len() / LOOKS).max(1);
    for eye in points.iter().step_by(step) {
        for k in 0..DIRECTIONS {
            let turn = std::f32::consts::TAU * (k as f32 + 0.5) / DIRECTIONS as f32;
            let (x, z) = math::sin_cos(turn);
            let slope = SLOPES[k % SLOPES.len()];
            let hit = rays.closest(&Ray::new(*eye, Vec3::new(x, slope, z)), RayMask::EYE);
            let Some((owner, material)) = hit.map(|hit| rays.owner_and_material(&hit)) else {
                continue;
            };
            if let SurfaceOwner::Structure(piece) = owner
                && rays.house().structure[piece].kind == StructureKind::Wall
            {
                *areas.entry(material).or_insert(0.0) += 1.0;
            }
        }
    }
    areas
}
