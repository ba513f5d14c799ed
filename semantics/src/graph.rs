//! The scene graph: rooms, objects with their properties, and every relation that holds.

use crate::predicates;
use crate::scene::{SemanticScene, Term, Viewer};
use dwell_scene::ObjectId;
use dwell_scene::interrupt;
use serde::{Deserialize, Serialize};

/// Largest number of things with relations of left and right: each has a side of each other.
const MOST_IN_FRONT: usize = 1000;

/// A scene graph. Ids are those of sensors; rooms are counted from 0.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SceneGraph {
    /// Rooms in order.
    pub rooms: Vec<RoomNode>,
    /// Objects in order.
    pub objects: Vec<ObjectNode>,
    /// Relations, sorted by subject, then predicate, then object.
    pub relations: Vec<RelationEdge>,
}

/// A room.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RoomNode {
    /// Counted from 0.
    pub room: u32,
    /// Spoken name of its own in the house: "kitchen", "second bedroom".
    pub name: String,
    /// Floor area, m².
    pub area_m2: f32,
    /// The rooms that it is open to without a door between, rising.
    #[serde(default)]
    pub passages: Vec<u32>,
}

/// An object.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ObjectNode {
    /// The sensors' id.
    pub id: i32,
    /// The house's name for it.
    pub name: String,
    /// Spoken noun.
    pub noun: String,
    /// Plain colour words, largest share first.
    pub colors: Vec<String>,
    /// Substances by name, largest share first.
    pub substances: Vec<String>,
    /// Its size for its kind.
    pub size: crate::SizeClass,
    /// The room it is in.
    pub room: Option<u32>,
    /// The middle of its box, m.
    pub center: [f32; 3],
    /// The edges of its box, m.
    pub extents: [f32; 3],
    /// Openness, 0 to 1; `None` for an object that does not open.
    pub openness: Option<f32>,
    /// True if it is switched on; `None` for an object without a switch.
    pub switched_on: Option<bool>,
    /// The agent that holds it, counted from 0.
    pub held_by: Option<u32>,
}

/// One relation that holds.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RelationEdge {
    /// The sensors' id of an object.
    pub subject: i32,
    /// The predicate's name.
    pub predicate: String,
    /// The sensors' id of an object or structure piece; for `in_room` the room.
    pub object: i32,
}

fn node(scene: &SemanticScene<'_>, id: ObjectId) -> ObjectNode {
    let (house, facts) = (scene.house(), scene.facts(id));
    let bounds = scene.extent(id).bounds;
    ObjectNode {
        id: house.entity_of_object(id).0,
        name: house.objects[id].name.clone(),
        noun: facts.noun.clone(),
        colors: facts
            .colors
            .iter()
            .map(|(word, _)| (*word).to_owned())
            .collect(),
        substances: facts
            .substances
            .iter()
            .map(|(substance, _)| substance.name.clone())
            .collect(),
        size: facts.size,
        room: scene.room_of(id).map(|room| room.0),
        center: bounds.center().into(),
        extents: bounds.size().into(),
        openness: scene.state.openness(house, id),
        switched_on: house.objects[id]
            .switch
            .map(|_| scene.state.switched_on[id]),
        held_by: scene.holder(id).map(|agent| agent.0),
    }
}

/// The objects and pieces of the building whose middles are in front of a viewer, the nearest of them; in order.
fn in_front(scene: &SemanticScene<'_>, viewer: &Viewer) -> Vec<Term> {
    let house = scene.house();
    let objects = house.objects.ids().map(Term::Object);
    let terms = objects.chain(house.structure.ids().map(Term::Structure));
    let eye = viewer.world_from_camera.position;
    let mut front: Vec<(f32, Term)> = terms
        .filter(|term| predicates::is_in_front(scene, viewer, *term))
        .filter_map(|term| Some((scene.center(term)?.distance_squared(eye), term)))
        .collect();
    front.sort_by(|p, q| p.0.total_cmp(&q.0).then(p.1.cmp(&q.1)));
    front.truncate(MOST_IN_FRONT);
    let mut front: Vec<Term> = front.into_iter().map(|(_, term)| term).collect();
    front.sort_unstable();
    front
}

/// The whole scene as data; with a viewer, left and right too, of the 1,000 things nearest before
/// it.
///
/// Relations are those between objects, between an object and a structure piece it rests or hangs on, and `in_room`.
pub fn scene_graph(scene: &SemanticScene<'_>, viewer: Option<&Viewer>) -> SceneGraph {
    let house = scene.house();
    let rooms = house.rooms.ids().map(|id| {
        let facts = scene.semantics.room(id);
        RoomNode {
            room: id.0,
            name: facts.label.clone(),
            area_m2: facts.area_m2,
            passages: facts.passages.iter().map(|room| room.0).collect(),
        }
    });
    let front = viewer.map_or_else(Vec::new, |viewer| in_front(scene, viewer));
    let mut relations = Vec::new();
    for subject in house.objects.ids() {
        interrupt::check();
        let own = Term::Object(subject);
        for predicate in predicates::all() {
            let found = if !predicate.needs_viewer() {
                predicate.related(scene, subject)
            } else if front.binary_search(&own).is_ok() {
                let holds =
                    |term: &&Term| **term != own && predicate.holds(scene, own, **term, viewer);
                front.iter().filter(holds).copied().collect()
            } else {
                Vec::new()
            };
            relations.extend(found.into_iter().map(|term| RelationEdge {
                subject: house.entity_of_object(subject).0,
                predicate: predicate.name().to_owned(),
                object: match term {
                    Term::Object(id) => house.entity_of_object(id).0,
                    Term::Structure(id) => house.entity_of_structure(id).0,
                    Term::Room(id) => id.0 as i32,
                    Term::Agent(id) => house.entity_of_agent(id).0,
                },
            }));
        }
    }
    relations.sort_by(|p, q| {
        (p.subject, &p.predicate, p.object).cmp(&(q.subject, &q.predicate, q.object))
    });
    SceneGraph {
        rooms: rooms.collect(),
        objects: house.objects.ids().map(|id| node(scene, id)).collect(),
        relations,
    }
}

impl SceneGraph {
    /// The relations of one object, by sensors' id.
    pub fn of(&self, id: i32) -> impl Iterator<Item = &RelationEdge> {
        self.relations.iter().filter(move |edge| edge.subject == id)
    }

    /// The number of rooms and objects.
    pub fn node_count(&self) -> usize {
        self.rooms.len() + self.objects.len()
    }

    /// The object with a sensors' id.
    pub fn object(&self, id: i32) -> Option<&ObjectNode> {
        self.objects.iter().find(|node| node.id == id)
    }
}
