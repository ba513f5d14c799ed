//! A running world, and Python's names for its contents.

use crate::errors::PyFault;
use dwell::{ShortestPathFollower, StepSizes, World};
use dwell_physics::ActionOutcome;
use dwell_scene::{AgentId, Entity, Id, IdVec, JointId, ObjectId, PartId};
use serde_json::json;

/// Number of names that an error lists, the nearest first.
const NAMES: usize = 12;

/// A guide, and the bits of its goal.
pub(crate) type ActiveGuide = Option<([u32; 3], ShortestPathFollower)>;

/// The world that a `World` of Python works on: one of its own, or that of an environment.
pub(crate) struct WorldAccess<'a> {
    pub(crate) world: &'a mut World,
    pub(crate) guide: &'a mut ActiveGuide,
    /// Lengths and angles of each agent's movement actions; agents beyond its end have the default. Shape (agent,).
    pub(crate) strides: IdVec<AgentId, StepSizes>,
}

impl WorldAccess<'_> {
    pub(crate) fn object(&self, named: &serde_json::Value) -> Result<ObjectId, PyFault> {
        let house = self.world.house();
        let by_id = named
            .as_i64()
            .and_then(|id| house.entity(dwell_scene::EntityId(i32::try_from(id).ok()?)));
        let found = match by_id {
            Some(dwell_scene::Entity::Object(object)) => Some(object),
            _ => named.as_str().and_then(|name| house.object_named(name)),
        };
        found.ok_or_else(|| {
            if named.is_number() {
                return PyFault::Config(self.no_object_with_id(named));
            }
            let known = house.objects.iter().map(|object| object.name.as_str());
            let near =
                dwell_houses::nearest_names(named.as_str().unwrap_or_default(), known, NAMES);
            PyFault::Config(format!(
                "no object {named}; of the {} the nearest are {near:?}",
                house.objects.len()
            ))
        })
    }

    /// The error for a number that is no object's.
    fn no_object_with_id(&self, number: &serde_json::Value) -> String {
        let house = self.world.house();
        let first = house.structure.len() + 1;
        let last = house.structure.len() + house.objects.len();
        let piece = number
            .as_i64()
            .and_then(|id| house.entity(dwell_scene::EntityId(i32::try_from(id).ok()?)));
        let what = match piece {
            Some(Entity::Structure(id)) => {
                format!(
                    " (it is the piece {:?} of the building)",
                    house.structure[id].name
                )
            }
            _ => String::new(),
        };
        if house.objects.is_empty() {
            return format!("no object {number}{what}; there are none");
        }
        format!("no object {number}{what}; objects have the ids {first} to {last}, or names")
    }

    /// A part by its object's name and its own; without one the object's first part that moves.
    pub(crate) fn part(&self, object: &str, part: Option<&str>) -> Result<PartId, PyFault> {
        let house = self.world.house();
        let id = self.object(&json!(object))?;
        let mut parts = house.objects[id].parts();
        let Some(name) = part else {
            let moving = parts.find(|id| !house.parts[*id].fixed);
            return Ok(moving.unwrap_or(house.objects[id].first_part));
        };
        parts
            .find(|id| house.parts[*id].name == name)
            .ok_or_else(|| {
                let parts = house.objects[id].parts();
                let known: Vec<_> = parts.map(|id| &house.parts[id].name).collect();
                PyFault::Config(format!("no part {name:?}; {object:?} has {known:?}"))
            })
    }

    /// Returns how far discrete actions of an agent go.
    pub(crate) fn step_sizes(&self, agent: AgentId) -> StepSizes {
        self.strides.get(agent).copied().unwrap_or_default()
    }

    pub(crate) fn agent(&self, agent: usize) -> Result<AgentId, PyFault> {
        let count = self.world.state().agents.len();
        if agent < count {
            Ok(AgentId::from_index(agent))
        } else {
            Err(PyFault::Config(format!(
                "no agent {agent}; there are {count}, counted from 0"
            )))
        }
    }

    pub(crate) fn joint(&self, joint: u32) -> Result<JointId, PyFault> {
        let count = self.world.house().joints.len();
        let id = JointId(joint);
        if id.index() < count {
            Ok(id)
        } else {
            Err(PyFault::Config(format!(
                "no joint {joint}; there are {count}, counted from 0"
            )))
        }
    }

    pub(crate) fn outcome(&self, outcome: &ActionOutcome) -> Result<serde_json::Value, PyFault> {
        let house = self.world.house();
        let name = |object: ObjectId| house.objects[object].name.clone();
        let pointed = outcome.pointed.map(|pointed| {
            let (kind, name) = match house.entity(pointed.entity) {
                Some(Entity::Object(id)) => ("object", name(id)),
                Some(Entity::Structure(id)) => ("structure", house.structure[id].name.clone()),
                Some(Entity::Agent(id)) => ("agent", id.0.to_string()),
                _ => ("void", String::new()),
            };
            json!({
                "id": pointed.entity.0,
                "kind": kind,
                "name": name,
                "point": pointed.point.to_array(),
                "distance_m": pointed.distance_m,
            })
        });
        let object = outcome.object.map(name);
        let code = serde_json::to_value(outcome.code)?;
        Ok(json!({
            "success": outcome.success,
            "code": code,
            "sentence": outcome.sentence,
            "object": object,
            "pointed": pointed,
        }))
    }
}
