//! Where sound starts and where it is heard.

use dwell_scene::Pose;
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// A point that radiates equally in all directions.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Source {
    /// Where it is in the world, m.
    pub position: Vec3,
}

impl Source {
    /// A source at `position`.
    pub const fn at(position: Vec3) -> Self {
        Self { position }
    }
}

/// What listens.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Receiver {
    /// A small microphone that hears equally from all directions: one channel.
    Omni {
        /// Where it is in the world, m.
        position: Vec3,
    },
    /// Two ears on a rigid sphere: channel 0 left, channel 1 right.
    Binaural {
        /// The head: its centre, and its axes (forward -Z, left -X).
        world_from_head: Pose,
    },
}

impl Receiver {
    /// A microphone at `position`.
    pub const fn omni(position: Vec3) -> Self {
        Self::Omni { position }
    }

    /// A head at a pose, such as [`AgentState::world_from_head`](dwell_scene::AgentState::world_from_head).
    pub const fn binaural(world_from_head: Pose) -> Self {
        Self::Binaural { world_from_head }
    }

    /// Its centre, m.
    pub fn position(&self) -> Vec3 {
        match self {
            Self::Omni { position } => *position,
            Self::Binaural { world_from_head } => world_from_head.position,
        }
    }

    /// How many channels it has.
    pub fn channels(&self) -> usize {
        match self {
            Self::Omni { .. } => 1,
            Self::Binaural { .. } => 2,
        }
    }

    /// How it is turned; nothing turns a microphone.
    pub fn rotation(&self) -> glam::Quat {
        match self {
            Self::Omni { .. } => glam::Quat::IDENTITY,
            Self::Binaural { world_from_head } => world_from_head.rotation,
        }
    }
}
