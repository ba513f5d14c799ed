//! The scene graph: storeys, rooms, agents, objects with their properties, and the relations that hold.

use crate::attributes::object_attributes;
use crate::predicates::{self, Predicate};
use crate::scene::{SemanticScene, Term, Viewer};
use dwell_scene::interrupt;
use dwell_scene::{AgentId, House, LevelId, ObjectId};
use serde::{Deserialize, Serialize};

/// Largest number of things with relations of left and right: each has a side of each other.
const MOST_IN_FRONT: usize = 1000;

/// A scene graph. Ids are those of sensors; rooms are counted from 0.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SceneGraph {
    /// Storeys in order, from the lowest.
    #[serde(default)]
    pub storeys: Vec<StoreyNode>,
    /// Rooms in order.
    pub rooms: Vec<RoomNode>,
    /// Objects in order.
    pub objects: Vec<ObjectNode>,
    /// Agents in order.
    #[serde(default)]
    pub agents: Vec<AgentNode>,
    /// Relations, sorted by subject, then predicate, then object.
    pub relations: Vec<RelationEdge>,
}

/// A storey.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StoreyNode {
    /// Counted from 0.
    pub storey: u32,
    /// The house's name for it.
    pub name: String,
    /// The height of its lowest room's floor, m; nothing without rooms.
    pub floor_m: Option<f32>,
}

/// An agent.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AgentNode {
    /// The sensors' id.
    pub id: i32,
    /// Counted from 0.
    pub agent: u32,
    /// The point between its feet, m.
    pub position: [f32; 3],
    /// Heading, rad to the left of -Z.
    pub yaw_rad: f32,
    /// The room it is in.
    pub room: Option<u32>,
    /// The storey it is on.
    pub storey: Option<u32>,
    /// The sensors' id of what it holds.
    pub holding: Option<i32>,
}

/// A room.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RoomNode {
    /// Counted from 0.
    pub room: u32,
    /// Spoken name of its own in the house: "kitchen", "second bedroom".
    pub name: String,
    /// Its storey.
    #[serde(default)]
    pub storey: u32,
    /// Floor area, m².
    pub area_m2: f32,
    /// The rooms that it is open to without a door between, ascending.
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
    /// Its row in the table of categories; empty where that has none.
    #[serde(default)]
    pub category: String,
    /// Name of its synset of `WordNet` 3.0; empty where none is known.
    #[serde(default)]
    pub synset: String,
    /// Number of its NYU-40 class; 0 where none is known.
    #[serde(default)]
    pub nyu40_id: u8,
    /// Spoken colour words, largest share first.
    pub colors: Vec<String>,
    /// Substances by name, largest share first.
    pub substances: Vec<String>,
    /// Its size for its kind.
    pub size: crate::SizeClass,
    /// The room it is in.
    pub room: Option<u32>,
    /// The storey it is on.
    #[serde(default)]
    pub storey: Option<u32>,
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
    /// The sensors' id of an object or an agent.
    pub subject: i32,
    /// The predicate's name.
    pub predicate: String,
    /// The sensors' id of an object, a structure piece or an agent; for predicates that lead to rooms or storeys alone
    /// (`in_room`, `on_storey`, `in_corner_of`, `in_middle_of`) the number of that, counted from 0.
    pub object: i32,
}

fn node(scene: &SemanticScene<'_>, id: ObjectId) -> ObjectNode {
    let of = object_attributes(scene, id);
    ObjectNode {
        id: of.id,
        name: of.name,
        noun: of.noun,
        category: of.category,
        synset: of.synset,
        nyu40_id: of.nyu40_id,
        colors: of.colors.into_iter().map(|(word, _)| word).collect(),
        substances: of.substances.into_iter().map(|(name, _)| name).collect(),
        size: of.size,
        room: of.room,
        storey: of.storey,
        center: of.center,
        extents: of.extents,
        openness: of.openness,
        switched_on: of.switched_on,
        held_by: of.held_by,
    }
}

fn agent_node(scene: &SemanticScene<'_>, id: AgentId) -> AgentNode {
    let (house, agent) = (scene.house(), &scene.state.agents[id]);
    AgentNode {
        id: house.entity_of_agent(id).0,
        agent: id.0,
        position: agent.position.into(),
        yaw_rad: agent.yaw_rad,
        room: scene.room_of_agent(id).map(|room| room.0),
        storey: scene.storey_of(Term::Agent(id)).map(|storey| storey.0),
        holding: agent.holding.map(|held| house.entity_of_object(held).0),
    }
}

fn storey_node(house: &House, id: LevelId) -> StoreyNode {
    let rooms = house.rooms.iter().filter(|room| room.level == id);
    StoreyNode {
        storey: id.0,
        name: house.levels[id].name.clone(),
        floor_m: rooms.map(|room| room.floor_y).reduce(f32::min),
    }
}

/// The number that stands for a term in a graph: the sensors' id of a thing, the number of a room or a storey.
pub fn node_id(house: &House, term: Term) -> i32 {
    match term {
        Term::Object(id) => house.entity_of_object(id).0,
        Term::Structure(id) => house.entity_of_structure(id).0,
        Term::Agent(id) => house.entity_of_agent(id).0,
        Term::Room(id) => id.0 as i32,
        Term::Storey(id) => id.0 as i32,
        Term::Part(id) => id.0 as i32,
    }
}

/// The objects and pieces of the building whose middles are in front of a viewer, the nearest of them; in order.
fn nearest_in_front(scene: &SemanticScene<'_>, viewer: &Viewer) -> Vec<Term> {
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

/// One relation that holds: subject, predicate by its place in [`predicates::all`], object.
pub type RelationTriple = (Term, usize, Term);

/// Returns the relations of objects and agents by the binary predicates at `codes` of [`predicates::all`]; by subject, then by
/// predicate. A relation that needs a viewer is evaluated for the 1,000 things nearest before it, and left out without one.
pub fn relations(
    scene: &SemanticScene<'_>,
    codes: &[usize],
    viewer: Option<&Viewer>,
) -> Vec<RelationTriple> {
    let all = predicates::all();
    let known = codes
        .iter()
        .filter_map(|code| Some((*code, *all.get(*code)?)));
    let known: Vec<(usize, &dyn Predicate)> = known.filter(|(_, p)| p.arity() == 2).collect();
    let viewed = known.iter().any(|(_, predicate)| predicate.needs_viewer());
    let viewer = viewer.filter(|_| viewed);
    let front = viewer.map_or_else(Vec::new, |viewer| nearest_in_front(scene, viewer));
    let objects = scene.house().objects.ids().map(Term::Object);
    let subjects = objects.chain(scene.state.agents.ids().map(Term::Agent));
    let mut found: Vec<RelationTriple> = Vec::new();
    for subject in subjects {
        interrupt::unwind_if_cancelled();
        for (code, predicate) in &known {
            let mut terms = if !predicate.needs_viewer() {
                predicate.related(scene, subject)
            } else if front.binary_search(&subject).is_ok() {
                let holds = |term: &&Term| {
                    **term != subject
                        && predicate.holds(scene, &[subject, **term], viewer).is_true()
                };
                front.iter().filter(holds).copied().collect()
            } else {
                Vec::new()
            };
            terms.sort_unstable();
            found.extend(terms.into_iter().map(|term| (subject, *code, term)));
        }
    }
    found
}

/// The places in [`predicates::all`] of the predicates that tables list unasked; with a viewer also of those that need one and
/// lead to few.
pub fn default_relation_codes(with_viewer: bool) -> Vec<usize> {
    let all = predicates::all().iter().enumerate();
    let listed = all.filter(|(_, predicate)| {
        predicate.arity() == 2
            && (predicate.is_listed() || (with_viewer && predicate.needs_viewer()))
    });
    listed.map(|(code, _)| code).collect()
}

/// Everything that can be said about the scene, as data; with a viewer, sides too, of the 1,000 things nearest before it.
///
/// Relations are those of objects and agents that [`default_relation_codes`] has.
pub fn scene_graph(scene: &SemanticScene<'_>, viewer: Option<&Viewer>) -> SceneGraph {
    let house = scene.house();
    let rooms = house.rooms.iter_ids().map(|(id, room)| {
        let facts = scene.semantics.room(id);
        RoomNode {
            room: id.0,
            name: facts.label.clone(),
            storey: room.level.0,
            area_m2: facts.area_m2,
            passages: facts.passages.iter().map(|room| room.0).collect(),
        }
    });
    let found = relations(scene, &default_relation_codes(viewer.is_some()), viewer);
    let edges = found
        .into_iter()
        .map(|(subject, code, object)| RelationEdge {
            subject: node_id(house, subject),
            predicate: predicates::all()[code].name().to_owned(),
            object: node_id(house, object),
        });
    let mut relations: Vec<RelationEdge> = edges.collect();
    relations.sort_by(|p, q| {
        (p.subject, &p.predicate, p.object).cmp(&(q.subject, &q.predicate, q.object))
    });
    let agents = scene.state.agents.ids();
    SceneGraph {
        storeys: house
            .levels
            .ids()
            .map(|id| storey_node(house, id))
            .collect(),
        rooms: rooms.collect(),
        objects: house.objects.ids().map(|id| node(scene, id)).collect(),
        agents: agents.map(|id| agent_node(scene, id)).collect(),
        relations,
    }
}

impl SceneGraph {
    /// The relations of one object, by sensors' id.
    pub fn relations_of(&self, id: i32) -> impl Iterator<Item = &RelationEdge> {
        self.relations.iter().filter(move |edge| edge.subject == id)
    }

    /// The number of storeys, rooms, objects and agents.
    pub fn node_count(&self) -> usize {
        self.storeys.len() + self.rooms.len() + self.objects.len() + self.agents.len()
    }

    /// The object with a sensors' id.
    pub fn object(&self, id: i32) -> Option<&ObjectNode> {
        self.objects.iter().find(|node| node.id == id)
    }
}
