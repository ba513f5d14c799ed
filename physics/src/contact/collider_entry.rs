//! The owner of each collider. A collider's user data is its index in the list of entries.

use crate::model::PieceOwner;
use dwell_scene::{AgentId, PartId, StructureId};
use rapier3d::geometry::Collider;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// An entity in contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactEntity {
    /// A wall, floor or ceiling.
    Structure(StructureId),
    /// A part of an object.
    Part(PartId),
    /// An agent's body.
    Agent(AgentId),
}

/// The contact class of a piece, or of each of its triangles.
#[derive(Clone, Debug)]
pub(crate) enum SurfaceContactClasses {
    Uniform(u16),
    PerTriangle(Arc<[u16]>),
}

impl SurfaceContactClasses {
    /// Returns the class at a triangle of the shape; `subshape` is ignored where there is one class.
    pub(crate) fn class(&self, subshape: u32) -> u16 {
        match self {
            Self::Uniform(class) => *class,
            Self::PerTriangle(classes) => classes
                .get(subshape as usize)
                .or(classes.first())
                .copied()
                .unwrap_or(0),
        }
    }

    /// Returns whether `is` holds for some class of the surface.
    pub(crate) fn any_material(&self, is: impl Fn(u16) -> bool) -> bool {
        match self {
            Self::Uniform(class) => is(*class),
            Self::PerTriangle(classes) => classes.iter().any(|class| is(*class)),
        }
    }
}

/// The owner and the materials of a collider.
#[derive(Clone, Debug)]
pub(crate) struct ColliderMetadata {
    /// Its owner; `None` for the fallback box.
    pub(crate) contact_entity: Option<ContactEntity>,
    /// The rigid body it moves with, unless it is static or an agent's.
    pub(crate) body: Option<u32>,
    pub(crate) surface: SurfaceContactClasses,
}

impl ColliderMetadata {
    pub(crate) fn new(
        owner: PieceOwner,
        body: Option<u32>,
        surface: SurfaceContactClasses,
    ) -> Self {
        let contact_entity = match owner {
            PieceOwner::Structure(id) => Some(ContactEntity::Structure(id)),
            PieceOwner::Part(id) => Some(ContactEntity::Part(id)),
            PieceOwner::BoundingBox => None,
        };
        Self {
            contact_entity,
            body,
            surface,
        }
    }

    pub(crate) fn agent(&self) -> Option<AgentId> {
        match self.contact_entity {
            Some(ContactEntity::Agent(agent)) => Some(agent),
            _ => None,
        }
    }
}

/// Returns the index of a collider's entry.
pub(crate) fn entry_index(collider: &Collider) -> usize {
    collider.user_data as usize
}
