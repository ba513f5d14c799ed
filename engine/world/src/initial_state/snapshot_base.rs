//! The common part of the snapshots of all worlds with one initial state.

use super::InitialWorld;
use crate::config::WorldConfig;
use crate::motion_history::LastStepMotion;
use dwell_physics::{PhysicsModel, PhysicsWorld};
use dwell_scene::random::RandomKey;
use dwell_scene::{House, State};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::Arc;
use xxhash_rust::xxh3::xxh3_64;

/// The parts of a snapshot.
#[derive(Serialize, Deserialize)]
pub(crate) struct SnapshotParts {
    pub(crate) state: Vec<u8>,
    pub(crate) physics: Vec<u8>,
    pub(crate) sound: Vec<u8>,
    pub(crate) key: RandomKey,
    pub(crate) motion_history: LastStepMotion,
}

/// The bytes of the common initial state of worlds.
#[derive(Debug)]
pub(crate) struct SnapshotBase {
    pub(crate) bytes: Vec<u8>,
    pub(crate) checksum: u64,
}

impl SnapshotBase {
    /// Of worlds with the same house, agents and rates: with whatever parameters and laws.
    pub(super) fn of(model: &Arc<PhysicsModel>, config: &WorldConfig) -> Self {
        let plain = WorldConfig {
            parameters: BTreeMap::new(),
            laws: Vec::new(),
            renderer: dwell_render::BackEnd::Cpu,
            ..config.clone()
        };
        // Bodies that only the world's own parameters make small enough have no such base: it is empty.
        let start = InitialWorld::new(model, &plain);
        let bytes = start.map_or_else(
            |_| Vec::new(),
            |start| {
                serialize_snapshot_parts(
                    model.house(),
                    &start.state,
                    &start.physics,
                    (Vec::new(), RandomKey::root(0), LastStepMotion::default()),
                )
            },
        );
        let sum = xxh3_64(&bytes);
        Self {
            bytes,
            checksum: sum,
        }
    }
}

/// The parts of a world as bytes, before they are packed.
pub(crate) fn serialize_snapshot_parts(
    house: &House,
    state: &State,
    physics: &PhysicsWorld,
    (sound, key, past): (Vec<u8>, RandomKey, LastStepMotion),
) -> Vec<u8> {
    let parts = SnapshotParts {
        state: state.to_bytes(house),
        physics: physics.unpacked_snapshot(),
        sound,
        key,
        motion_history: past,
    };
    postcard::to_stdvec(&parts).expect("plain bytes can always be written to memory")
}
