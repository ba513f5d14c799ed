//! Targets of hand actions.

use dwell_scene::{EntityId, ObjectId, PartId};
use glam::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The target of an action.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Target {
    /// An object.
    Object(#[schemars(with = "u32")] ObjectId),
    /// A part of an object: one drawer of several.
    Part(#[schemars(with = "u32")] PartId),
    /// The thing with an id that a sensor reports.
    Entity(#[schemars(with = "i32")] EntityId),
    /// The first thing on a ray.
    Ray {
        /// Origin, m: a camera's or the agent's own eye.
        #[schemars(with = "[f32; 3]")]
        origin: Vec3,
        /// Any length but zero.
        #[schemars(with = "[f32; 3]")]
        direction: Vec3,
    },
    /// The thing in the middle of the agent's view.
    #[default]
    Gaze,
}

impl From<ObjectId> for Target {
    fn from(id: ObjectId) -> Self {
        Self::Object(id)
    }
}

impl From<PartId> for Target {
    fn from(id: PartId) -> Self {
        Self::Part(id)
    }
}

impl From<EntityId> for Target {
    fn from(id: EntityId) -> Self {
        Self::Entity(id)
    }
}
