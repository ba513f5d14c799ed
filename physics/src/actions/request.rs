//! What an agent's hand can be asked to do.

use crate::hands::Grasp;
use dwell_scene::{EntityId, ObjectId, PartId};
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// What an action is done to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Target {
    /// An object.
    Object(ObjectId),
    /// A part of an object: one drawer of several.
    Part(PartId),
    /// What a sensor's id names.
    Entity(EntityId),
    /// The first thing on a ray.
    Ray {
        /// Where it starts, m: a camera's or the agent's own eye.
        origin: Vec3,
        /// Any length but zero.
        direction: Vec3,
    },
    /// What is in the middle of the agent's view.
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

/// Something an agent's hand does.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "action", rename_all = "snake_case", deny_unknown_fields)]
pub enum Action {
    /// Takes an object.
    Pick {
        /// What to take.
        target: Target,
        /// How to hold it.
        #[serde(default)]
        grasp: Grasp,
    },
    /// Lets go of what it holds.
    Drop,
    /// Puts what it holds down at a free, steady spot.
    Place {
        /// What to put it on: an object, or the floor that a ray meets (the spot nearest to where it does). `None`: any
        /// level surface in view, the one nearest to the middle of the view first.
        #[serde(default)]
        on: Option<Target>,
    },
    /// Puts what it holds down with the middle of its foot at a point.
    PlaceAt {
        /// m; a surface must lie within 3 cm of it.
        point: Vec3,
    },
    /// Puts what it holds into a container: a drawer, cupboard, bowl, box or basin.
    PutIn {
        /// The container.
        container: Target,
    },
    /// Throws what it holds.
    Throw {
        /// In world space; any length but zero.
        direction: Vec3,
        /// m/s; more than the agent's strength allows is cut.
        speed_m_s: f32,
    },
    /// Pushes something away for a quarter of a second.
    Push {
        /// What to push; a ray says where.
        target: Target,
        /// N; more than the agent's strength is cut. `None`: all of it.
        #[serde(default)]
        force_n: Option<f32>,
    },
    /// Pulls something near for a quarter of a second; needs a free hand.
    Pull {
        /// What to pull; a ray says where.
        target: Target,
        /// N; more than the agent's strength is cut. `None`: all of it.
        #[serde(default)]
        force_n: Option<f32>,
    },
    /// Opens a door, drawer or lid.
    Open {
        /// What to open; all of an object's joints, or the one that moves the part that a ray meets.
        target: Target,
        /// How far: 0 is closed, 1 fully open.
        #[serde(default = "fully")]
        fraction: f32,
    },
    /// Closes a door, drawer or lid.
    Close {
        /// What to close.
        target: Target,
    },
    /// Switches something on or off.
    Toggle {
        /// What to switch.
        target: Target,
    },
    /// Points: answers with what is there, where, and how far from the eye. Nothing is too far.
    Point {
        /// What to point at.
        target: Target,
    },
}

fn fully() -> f32 {
    1.0
}

impl Action {
    /// Takes a thing, held as usual.
    pub fn pick(target: impl Into<Target>) -> Self {
        Self::Pick {
            target: target.into(),
            grasp: Grasp::default(),
        }
    }

    /// Puts what is held on a thing.
    pub fn place(on: impl Into<Target>) -> Self {
        Self::Place {
            on: Some(on.into()),
        }
    }

    /// Opens a thing fully.
    pub fn open(target: impl Into<Target>) -> Self {
        Self::Open {
            target: target.into(),
            fraction: 1.0,
        }
    }

    /// Closes a thing.
    pub fn close(target: impl Into<Target>) -> Self {
        Self::Close {
            target: target.into(),
        }
    }

    /// Switches a thing on or off.
    pub fn toggle(target: impl Into<Target>) -> Self {
        Self::Toggle {
            target: target.into(),
        }
    }
}
