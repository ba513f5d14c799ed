//! Predicates, relations and attributes for Python.

use crate::answers::PyValue;
use crate::engine_call::EngineCall;
use crate::errors::PyFault;
use crate::values::JsonArgument;
use crate::world::PyWorld;
use crate::world_access::WorldAccess;
use dwell_scene::space::rotation_from_yaw_pitch;
use dwell_scene::{AgentId, EntityId, Id, LevelId, Pose, RoomId};
use dwell_semantics::color::ColorVocabulary;
use dwell_semantics::graph::{RelationTriple, default_relation_codes, relations, scene_graph};
use dwell_semantics::predicates::{Predicate, all, find};
use dwell_semantics::selections::{self, Selection};
use dwell_semantics::{SemanticScene, Term, UndecidedReason, Viewer, object_attributes};
use glam::Vec3;
use numpy::{IntoPyArray, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use serde::Deserialize;
use serde_json::{Value, json};

/// Number of names that an error lists, the nearest first.
const NAMES: usize = 12;
/// From which number down negative numbers of the array are storeys; above it they are rooms.
const STOREYS: i32 = -1001;

/// Somebody who looks: an agent, or a camera's pose.
#[derive(Deserialize)]
#[serde(untagged)]
enum ViewerArgument {
    Agent(usize),
    Pose(PoseArgument),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PoseArgument {
    position: [f32; 3],
    #[serde(default)]
    yaw_deg: f32,
    #[serde(default)]
    pitch_deg: f32,
}

impl WorldAccess<'_> {
    pub(crate) fn scene(&self) -> SemanticScene<'_> {
        self.world.engines().semantics().scene(self.world.state())
    }

    /// A term by its name or the sensors' id: `chair_2`, `room:kitchen`, `storey:0`, `agent:0`, `part:door_1/leaf`.
    pub(crate) fn term(&self, named: &Value) -> Result<Term, PyFault> {
        let (house, state) = (self.world.house(), self.world.state());
        if let Some(id) = named.as_i64() {
            let entity = i32::try_from(id).ok().map(EntityId);
            let found = entity.and_then(|id| Term::from_entity(house, state, id));
            let gone = || PyFault::Config(format!("no object, agent or structure with id {id}"));
            return found.ok_or_else(gone);
        }
        let Some((kind, name)) = named.as_str().and_then(|text| text.split_once(':')) else {
            return self.thing(named);
        };
        let number = || name.parse::<usize>().ok();
        match kind {
            "room" => {
                let rooms = house.rooms.iter_ids();
                let mut called = rooms.filter(|(_, room)| room.name == name);
                called.next().map(|(id, _)| Term::Room(id)).ok_or_else(|| {
                    let known: Vec<&str> = house.rooms.iter().map(|r| r.name.as_str()).collect();
                    PyFault::Config(format!("no room {name:?}; there are {known:?}"))
                })
            }
            "agent" => Ok(Term::Agent(self.agent(number().unwrap_or(usize::MAX))?)),
            "storey" => {
                let found = number().filter(|k| *k < house.levels.len());
                let gone = || {
                    let count = house.levels.len();
                    PyFault::Config(format!("no storey {name:?}; there are {count}, from 0"))
                };
                found
                    .map(|k| Term::Storey(LevelId::from_index(k)))
                    .ok_or_else(gone)
            }
            "part" => {
                let (object, part) = name.split_once('/').ok_or_else(|| {
                    PyFault::Config(format!("{named}: expected part:OBJECT/PART"))
                })?;
                Ok(Term::Part(self.part(object, Some(part))?))
            }
            _ => self.thing(named),
        }
    }

    /// An object, or else a piece of the building, by its name.
    fn thing(&self, named: &Value) -> Result<Term, PyFault> {
        let house = self.world.house();
        let name = named.as_str().unwrap_or_default();
        if let Some(id) = house.object_named(name) {
            return Ok(Term::Object(id));
        }
        let mut pieces = house.structure.iter_ids();
        if let Some((id, _)) = pieces.find(|(_, piece)| piece.name == name) {
            return Ok(Term::Structure(id));
        }
        let known = house.objects.iter().map(|object| object.name.as_str());
        let near = dwell_houses::nearest_names(name, known, NAMES);
        Err(PyFault::Config(format!(
            "nothing is called {named}; of the {} objects the nearest are {near:?}; \
             rooms, storeys and agents are room:NAME, storey:0 and agent:0",
            house.objects.len()
        )))
    }

    pub(crate) fn name_of(&self, term: Term) -> String {
        let house = self.world.house();
        match term {
            Term::Object(id) => house.objects[id].name.clone(),
            Term::Structure(id) => house.structure[id].name.clone(),
            Term::Room(RoomId(k)) => format!("room:{}", house.rooms[RoomId(k)].name),
            Term::Agent(AgentId(k)) => format!("agent:{k}"),
            Term::Storey(LevelId(k)) => format!("storey:{k}"),
            Term::Part(id) => {
                let part = &house.parts[id];
                format!("part:{}/{}", house.objects[part.object].name, part.name)
            }
        }
    }

    fn terms(&self, named: JsonArgument) -> Result<Vec<Term>, PyFault> {
        let named: Vec<Value> = named.read()?;
        named.iter().map(|named| self.term(named)).collect()
    }

    pub(crate) fn viewer(&self, viewer: JsonArgument) -> Result<Option<Viewer>, PyFault> {
        let viewer: Value = viewer.read()?;
        if viewer.is_null() {
            return Ok(None);
        }
        let read = serde_json::from_value(viewer.clone());
        let viewer: ViewerArgument = read.map_err(|_| {
            PyFault::Config(format!(
                "viewer is {viewer}; expected an agent's number, or position with yaw_deg and pitch_deg"
            ))
        })?;
        Ok(match viewer {
            ViewerArgument::Agent(agent) => {
                Viewer::of_agent(self.world.state(), self.agent(agent)?)
            }
            ViewerArgument::Pose(pose) => {
                let angles = (pose.yaw_deg.to_radians(), pose.pitch_deg.to_radians());
                let rotation = rotation_from_yaw_pitch(angles.0, angles.1);
                let world_from_camera = Pose::new(Vec3::from_array(pose.position), rotation);
                if !world_from_camera.is_valid() {
                    let text = "viewer: position and angles must be finite";
                    return Err(PyFault::Config(text.to_owned()));
                }
                Some(Viewer { world_from_camera })
            }
        })
    }

    /// The relations by some predicates; without names those that tables list unasked.
    fn related(
        &self,
        names: Option<Vec<String>>,
        viewer: Option<&Viewer>,
    ) -> Result<Vec<RelationTriple>, PyFault> {
        let codes = match names {
            None => default_relation_codes(viewer.is_some()),
            Some(names) => {
                let mut codes = Vec::with_capacity(names.len());
                for name in &names {
                    let code = binary_predicate_index(name, viewer)?;
                    // Whoever asks twice is told once.
                    if !codes.contains(&code) {
                        codes.push(code);
                    }
                }
                codes
            }
        };
        Ok(relations(&self.scene(), &codes, viewer))
    }
}

/// The place of a predicate of two places in the list of all.
fn binary_predicate_index(name: &str, viewer: Option<&Viewer>) -> Result<usize, PyFault> {
    let predicate = predicate_called(name)?;
    if predicate.arity() != 2 {
        return Err(PyFault::Config(format!(
            "{name:?} is said of {}; relations are between two things",
            match predicate.arity() {
                1 => "one thing".to_owned(),
                count => format!("{count} things"),
            }
        )));
    }
    if predicate.needs_viewer() && viewer.is_none() {
        return Err(PyFault::Config(format!("{name:?} needs a viewer")));
    }
    let place = all().iter().position(|known| known.name() == name);
    Ok(place.unwrap_or_default())
}

fn predicate_called(name: &str) -> Result<&'static dyn Predicate, PyFault> {
    find(name).map_err(|error| PyFault::Config(error.to_string()))
}

fn selection_called(name: &str) -> Result<&'static dyn Selection, PyFault> {
    selections::find(name).map_err(|error| PyFault::Config(error.to_string()))
}

/// The number of a term in arrays: the sensors' id, or a negative number for a room or a storey.
fn number(house: &dwell_scene::House, term: Term) -> i32 {
    match term {
        Term::Room(id) => -1 - id.0 as i32,
        Term::Storey(id) => STOREYS - id.0 as i32,
        other => dwell_semantics::graph::node_id(house, other),
    }
}

/// Returns whether a predicate holds of things; where that is undecided, `None` and the reason.
#[pyfunction]
pub(crate) fn world_holds(
    py: Python<'_>,
    world: &Bound<'_, PyWorld>,
    name: &str,
    things: JsonArgument,
    viewer: JsonArgument,
) -> PyResult<(Option<bool>, Option<&'static str>)> {
    world.get().read_interruptible(py, |running| {
        let predicate = predicate_called(name)?;
        let (terms, viewer) = (running.terms(things)?, running.viewer(viewer)?);
        let truth = predicate.holds(&running.scene(), &terms, viewer.as_ref());
        let why = truth.reason();
        Ok((truth.value(), why.map(UndecidedReason::sentence)))
    })
}

/// The n-th of things in an order, nothing where it cannot be told, and why it cannot.
#[pyfunction]
pub(crate) fn world_select(
    py: Python<'_>,
    world: &Bound<'_, PyWorld>,
    name: &str,
    things: JsonArgument,
    n: usize,
    reference: JsonArgument,
    viewer: JsonArgument,
) -> PyResult<(Option<String>, Option<&'static str>)> {
    world.get().read_interruptible(py, |running| {
        let selection = selection_called(name)?;
        let (terms, viewer) = (running.terms(things)?, running.viewer(viewer)?);
        let reference: Value = reference.read()?;
        let reference = if reference.is_null() {
            None
        } else {
            Some(running.term(&reference)?)
        };
        let scene = running.scene();
        let found = selection.select(&scene, &terms, n, reference, viewer.as_ref());
        Ok(match found {
            Ok(term) => (Some(running.name_of(term)), None),
            Err(why) => (None, Some(why.sentence())),
        })
    })
}

/// Relations that hold, by name: subject, predicate, object.
#[pyfunction]
pub(crate) fn world_relations(
    py: Python<'_>,
    world: &Bound<'_, PyWorld>,
    names: Option<Vec<String>>,
    viewer: JsonArgument,
) -> PyResult<Vec<(String, &'static str, String)>> {
    world.get().read_interruptible(py, |running| {
        let viewer = running.viewer(viewer)?;
        let found = running.related(names, viewer.as_ref())?.into_iter();
        let named = found.map(|(subject, code, object)| {
            let (subject, object) = (running.name_of(subject), running.name_of(object));
            (subject, all()[code].name(), object)
        });
        Ok(named.collect())
    })
}

/// Relations that hold, by number. Shape (relation, 3).
#[pyfunction]
pub(crate) fn world_relation_array<'py>(
    py: Python<'py>,
    world: &Bound<'_, PyWorld>,
    names: Option<Vec<String>>,
    viewer: JsonArgument,
) -> PyResult<Bound<'py, PyArray2<i32>>> {
    let (rows, count) = world.get().read_interruptible(py, |running| {
        let viewer = running.viewer(viewer)?;
        let found = running.related(names, viewer.as_ref())?;
        let house = running.world.house();
        let rows = found.iter().flat_map(|(subject, code, object)| {
            [
                number(house, *subject),
                *code as i32,
                number(house, *object),
            ]
        });
        Ok((rows.collect::<Vec<i32>>(), found.len()))
    })?;
    rows.into_pyarray(py).reshape([count, 3])
}

/// Returns the attributes of an object as one mapping.
#[pyfunction]
pub(crate) fn world_attributes(
    py: Python<'_>,
    world: &Bound<'_, PyWorld>,
    named: JsonArgument,
) -> PyResult<PyValue> {
    world.get().read_interruptible(py, |running| {
        let id = running.object(&named.read()?)?;
        PyValue::of(&object_attributes(&running.scene(), id))
    })
}

/// The words for an object's colours out of a vocabulary of so many, with their shares.
#[pyfunction]
pub(crate) fn world_color_names(
    py: Python<'_>,
    world: &Bound<'_, PyWorld>,
    named: JsonArgument,
    vocabulary: usize,
) -> PyResult<Vec<(&'static str, f32)>> {
    world.get().read_interruptible(py, |running| {
        let id = running.object(&named.read()?)?;
        let known = ColorVocabulary::of_size(vocabulary).ok_or_else(|| {
            PyFault::Config(format!(
                "vocabulary is {vocabulary}; allowed are 12, 16, 139 and 949"
            ))
        })?;
        let semantics = running.world.engines().semantics();
        Ok(semantics.facts(id).color_shares(known))
    })
}

/// The scene graph as one JSON object.
#[pyfunction]
pub(crate) fn world_graph_json(
    py: Python<'_>,
    world: &Bound<'_, PyWorld>,
    viewer: JsonArgument,
) -> PyResult<String> {
    world.get().read_interruptible(py, |running| {
        let viewer = running.viewer(viewer)?;
        let graph = scene_graph(&running.scene(), viewer.as_ref());
        Ok(serde_json::to_string(&graph)?)
    })
}

/// Every predicate and every order, in order: one JSON object.
#[pyfunction]
pub(crate) fn predicates_json(py: Python<'_>) -> PyResult<String> {
    py.engine(|| {
        let predicates = all().iter().map(|predicate| {
            let kinds = |kinds: &&[dwell_semantics::TermKind]| -> Vec<&str> {
                kinds.iter().map(|kind| kind.name()).collect()
            };
            let places: Vec<Vec<&str>> = predicate.argument_kinds().iter().map(kinds).collect();
            json!({
                "name": predicate.name(),
                "places": places,
                "definition": predicate.definition(),
                "source": predicate.source(),
                "laws": predicate.properties().names(),
                "needs_viewer": predicate.needs_viewer(),
                "listed": predicate.is_listed(),
            })
        });
        let orders = selections::all().iter().map(|selection| {
            json!({
                "name": selection.name(),
                "definition": selection.definition(),
                "source": selection.source(),
                "margin": selection.margin(),
                "needs_viewer": selection.needs_viewer(),
                "needs_reference": selection.needs_reference(),
            })
        });
        let table = json!({
            "predicates": predicates.collect::<Vec<Value>>(),
            "orders": orders.collect::<Vec<Value>>(),
        });
        Ok::<_, PyFault>(table.to_string())
    })
}
