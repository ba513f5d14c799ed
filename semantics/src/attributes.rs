//! The attributes of objects, as data.

use crate::color::SurfacePattern;
use crate::scene::{SemanticScene, Term};
use crate::size::SizeClass;
use dwell_scene::ObjectId;
use serde::{Deserialize, Serialize};

/// The attributes of an object in one state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ObjectAttributes {
    /// The sensors' id.
    pub id: i32,
    /// The house's name for it.
    pub name: String,
    /// Spoken noun.
    pub noun: String,
    /// Its row in the table of categories; empty where that has none.
    pub category: String,
    /// Name of its synset of `WordNet` 3.0; empty where none is known.
    pub synset: String,
    /// Number of its NYU-40 class; 0 where none is known.
    pub nyu40_id: u8,
    /// Name of its NYU-40 class; empty where none is known.
    pub nyu40_name: String,
    /// Spoken colour words with their shares of what is seen of it, largest first.
    pub colors: Vec<(String, f32)>,
    /// The pattern of most of it, by its predicate's name; `None` for plain things.
    pub pattern: Option<SurfacePattern>,
    /// Substances by name with their shares of its surface, largest first.
    pub substances: Vec<(String, f32)>,
    /// Its size for its kind.
    pub size: SizeClass,
    /// The middle of its box, m.
    pub center: [f32; 3],
    /// The edges of its box, m.
    pub extents: [f32; 3],
    /// The room it is in, counted from 0.
    pub room: Option<u32>,
    /// The storey it is on, counted from 0.
    pub storey: Option<u32>,
    /// Openness, 0 to 1; `None` for an object that does not open.
    pub openness: Option<f32>,
    /// State of its switch, true for on; `None` without a switch.
    pub switched_on: Option<bool>,
    /// The agent that holds it, counted from 0.
    pub held_by: Option<u32>,
}

/// Returns the attributes of an object as it is now.
pub fn object_attributes(scene: &SemanticScene<'_>, id: ObjectId) -> ObjectAttributes {
    let (house, facts) = (scene.house(), scene.facts(id));
    let row = facts.category;
    let bounds = scene.extent(id).bounds;
    let colors = facts.colors.iter();
    let substances = facts.substances.iter();
    let switch = house.objects[id].switch;
    ObjectAttributes {
        id: house.entity_of_object(id).0,
        name: house.objects[id].name.clone(),
        noun: facts.noun.clone(),
        category: row.map_or("", |row| row.name).to_owned(),
        synset: row.map_or("", |row| row.synset).to_owned(),
        nyu40_id: row.map_or(0, |row| row.nyu40_id),
        nyu40_name: row.map_or("", |row| row.nyu40_name).to_owned(),
        colors: colors
            .map(|(word, share)| ((*word).to_owned(), *share))
            .collect(),
        pattern: facts.pattern,
        substances: substances
            .map(|(substance, share)| (substance.name.clone(), *share))
            .collect(),
        size: facts.size,
        center: bounds.center().into(),
        extents: bounds.size().into(),
        room: scene.room_of(id).map(|room| room.0),
        storey: scene.storey_of(Term::Object(id)).map(|storey| storey.0),
        openness: scene.state.openness(house, id),
        switched_on: switch.map(|_| scene.state.switched_on[id]),
        held_by: scene.holder(id).map(|agent| agent.0),
    }
}
