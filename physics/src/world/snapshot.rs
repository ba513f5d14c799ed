//! Serialization of a physics world, without its shapes.
//!
//! Everything between steps that shapes do not determine is written: bodies, islands, the broad phase's tree, contacts with
//! their warm-start impulses, joints, and this crate's own state. Colliders are rebuilt from the model and the state's
//! parameters, in the same order, at the bodies' poses. Between steps no collider is marked as changed, so that a world
//! built this way is the same, bit for bit.

use super::PhysicsWorld;
use crate::actions::OngoingPush;
use crate::agents::{self, PassiveVelocity};
use crate::body::BodyStatus;
use crate::body::pose_of;
use crate::config::PhysicsConfig;
use crate::contact::rolling;
use crate::contact::{
    ColliderMetadata, CollisionExclusions, ContactHooks, ContactProperties, ContactTable,
    ContactTracker, ExcessEventTotals,
};
use crate::dynamics::{AssembledWorld, BodyMasses, assemble};
use crate::engine::{RapierWorld, SleepingIslandCache};
use crate::error::PhysicsError;
use crate::hands::HeldObject;
use crate::joints::{self, JointActuation, ManualJointDrives};
use crate::laws::{self, LawSet};
use crate::limits::PairLoad;
use dwell_scene::columnar;
use dwell_scene::packing::{pack_to_size, unpack};
use dwell_scene::{AgentId, Id, State};
use rapier3d::dynamics::{ImpulseJointSet, IslandManager, RigidBodySet};
use rapier3d::geometry::{BroadPhaseBvh, NarrowPhase};
use rapier3d::math::Pose as RapierPose;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use xxhash_rust::xxh3::xxh3_64;

/// The header of a snapshot, and of a light snapshot, which is not packed.
const MAGIC: &[u8; 4] = b"dwph";
const MAGIC_OF_MOMENTS: &[u8; 4] = b"dwpm";
const VERSION: u32 = 13;
const HEADER: usize = 4 + 4 + 8 + 8 + 8;

/// State of this crate between steps.
#[derive(Clone, Serialize, Deserialize)]
struct NonRapierState {
    tick: u64,
    statuses: Vec<BodyStatus>,
    passive_velocities: Vec<PassiveVelocity>,
    excluded: CollisionExclusions,
    grips: Vec<HeldObject>,
    released_overlapping: Vec<(u32, AgentId)>,
    drives: ManualJointDrives,
    ongoing_pushes: Vec<OngoingPush>,
    pulls: Vec<Option<JointActuation>>,
    contact_tracker: ContactTracker,
    sleeping_cache: SleepingIslandCache,
    laws: Vec<Vec<f32>>,
}

/// State of rapier between steps.
#[derive(Serialize, Deserialize)]
struct SnapshotData<'a> {
    memory: NonRapierState,
    #[serde(borrow)]
    islands: CowField<'a, IslandManager>,
    broad_phase: CowField<'a, BroadPhaseBvh>,
    narrow_phase: CowField<'a, NarrowPhase>,
    bodies: CowField<'a, RigidBodySet>,
    joints: CowField<'a, ImpulseJointSet>,
}

/// Written by reference, read by value.
struct CowField<'a, T: Clone>(Cow<'a, T>);

impl<T: Clone + Serialize> Serialize for CowField<'_, T> {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.serialize(serializer)
    }
}

impl<'de, T: Clone + Deserialize<'de>> Deserialize<'de> for CowField<'_, T> {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        T::deserialize(deserializer).map(|value| Self(Cow::Owned(value)))
    }
}

fn config_hash(config: &PhysicsConfig) -> u64 {
    let bytes = postcard::to_stdvec(config)
        .expect("a config is plain data that postcard can always write to memory");
    xxh3_64(&bytes)
}

fn refuse<T>(why: impl Into<String>) -> Result<T, PhysicsError> {
    Err(PhysicsError::Snapshot(why.into()))
}

impl PhysicsWorld {
    /// Returns a snapshot to be stored: header, version, fingerprints of house and config, checksum, packed body. It holds
    /// no shape, and not the state: store [`State::to_bytes`] of the same time beside it.
    ///
    /// # Panics
    /// Never: writing plain data to memory cannot fail.
    pub fn snapshot(&self) -> Vec<u8> {
        let most = self.target_snapshot_bytes() - HEADER;
        self.with_header(
            MAGIC,
            &pack_to_size(&self.encode_snapshot_data(), &[], most),
        )
    }

    /// Returns the target size of a snapshot: 256 KiB and 2 KiB for each body that can move. A larger one is packed harder;
    /// a heap in motion may exceed it.
    pub fn target_snapshot_bytes(&self) -> usize {
        (256 + 2 * self.dynamics.bodies.len()) * 1024
    }

    /// As [`PhysicsWorld::snapshot`], but not packed: some three times as large and many times as fast, to go back within a
    /// run, or to be packed beside others.
    ///
    /// # Panics
    /// Never: writing plain data to memory cannot fail.
    pub fn unpacked_snapshot(&self) -> Vec<u8> {
        self.with_header(MAGIC_OF_MOMENTS, &self.encode_snapshot_data())
    }

    fn collect_snapshot_data(&self) -> SnapshotData<'_> {
        SnapshotData {
            memory: NonRapierState {
                tick: self.dynamics.tick,
                statuses: self.dynamics.statuses.clone(),
                passive_velocities: self.agents.passive_velocities.clone(),
                excluded: self.dynamics.collision_exclusions.clone(),
                grips: self.hands.held_objects.clone(),
                released_overlapping: self.hands.released_overlapping.clone(),
                drives: self.articulation.hand_drives.clone(),
                ongoing_pushes: self.pushes.clone(),
                pulls: self.articulation.actuations.clone(),
                contact_tracker: self.contacts.tracker.clone(),
                sleeping_cache: self.dynamics.engine.sleeping_cache.clone(),
                laws: self.dynamics.laws.law_states(),
            },
            islands: CowField(Cow::Borrowed(&self.dynamics.engine.islands)),
            broad_phase: CowField(Cow::Borrowed(&self.dynamics.engine.broad_phase)),
            narrow_phase: CowField(Cow::Borrowed(&self.dynamics.engine.narrow_phase)),
            bodies: CowField(Cow::Borrowed(&self.dynamics.engine.bodies)),
            joints: CowField(Cow::Borrowed(&self.dynamics.engine.joints)),
        }
    }

    fn encode_snapshot_data(&self) -> Vec<u8> {
        columnar::to_bytes(&self.collect_snapshot_data())
            .expect("rapier's sets are plain data that say how long they are")
    }

    /// Returns a hash of all that [`PhysicsWorld::snapshot`] holds: equal worlds have equal ones.
    ///
    /// # Panics
    /// Never: writing plain data to memory cannot fail.
    pub fn hash(&self) -> u64 {
        // Rows are three times as fast as columns, and need not pack well.
        let rows = postcard::to_stdvec(&self.collect_snapshot_data())
            .expect("rapier's sets are plain data that postcard can always write to memory");
        xxh3_64(&rows)
    }

    fn with_header(&self, magic: &[u8; 4], body: &[u8]) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(HEADER + body.len());
        bytes.extend_from_slice(magic);
        bytes.extend_from_slice(&VERSION.to_le_bytes());
        bytes.extend_from_slice(&self.dynamics.model.house.fingerprint().to_le_bytes());
        bytes.extend_from_slice(&config_hash(&self.dynamics.settings.config).to_le_bytes());
        bytes.extend_from_slice(&xxh3_64(body).to_le_bytes());
        bytes.extend_from_slice(body);
        bytes
    }

    /// Restores a [`PhysicsWorld::snapshot`] or a [`PhysicsWorld::unpacked_snapshot`]; `state` must be the state of the same time. The
    /// next steps then give the same bits as they did there.
    ///
    /// # Errors
    /// [`PhysicsError::Snapshot`] for foreign, damaged or older bytes, another house, other settings or another time's
    /// state; the world is then as it was before.
    pub fn restore(&mut self, state: &mut State, bytes: &[u8]) -> Result<(), PhysicsError> {
        let body = self.check_header(bytes)?;
        let shot: SnapshotData = columnar::from_bytes(&body)
            .map_err(|error| PhysicsError::Snapshot(error.to_string()))?;
        let memory = shot.memory;
        let bodies = shot.bodies.0.into_owned();
        let foreign = memory.statuses.len() != self.dynamics.bodies.len()
            || memory.pulls.len() != self.articulation.joints.len()
            || memory.passive_velocities.len() != state.agents.len();
        if foreign {
            return refuse(format!(
                "it has {} bodies and {} agents; the world has {} and the state {}",
                memory.statuses.len(),
                memory.passive_velocities.len(),
                self.dynamics.bodies.len(),
                state.agents.len()
            ));
        }
        let model = self.dynamics.model.clone();
        let mut laws = laws::install(&model, state, &LawSet::default())?;
        if laws.specs().len() != memory.laws.len() {
            return refuse("it was taken with other laws than the state has");
        }
        for (law, remembered) in memory.laws.iter().enumerate() {
            laws.restore_law_state(law, remembered);
        }
        // The same overrides and laws give the same values.
        let same = state.overrides == self.applied;
        let table = if same {
            self.dynamics.table.clone()
        } else {
            ContactTable::new(&model.house, state)
        };
        let weights = if same && laws.specs() == self.dynamics.laws.specs() {
            self.dynamics.masses.clone()
        } else {
            BodyMasses::new(&model, state, &laws)
        };
        let values = laws.contact_properties(&model.house, &table);
        // Bodies are at the poses of the snapshot while colliders are built.
        let place = |index: usize| {
            let handle = self.dynamics.bodies[index].handle;
            let place = bodies
                .get(handle)
                .map_or(RapierPose::IDENTITY, |rigid| *rigid.position());
            (place, BodyStatus::Frozen)
        };
        let gravity = state.gravity_m_s2();
        let sizes = (gravity, state.agents.len(), &PairLoad::LOW);
        let mut built = assemble(
            &model,
            &self.dynamics.settings,
            values,
            laws.compliance,
            sizes,
            place,
            &weights,
        );
        let mut agents = Vec::with_capacity(state.agents.len());
        for (id, agent) in state.agents.iter_ids() {
            let force = self.dynamics.settings.event_force_n();
            let (engine, entries) = (&mut built.engine, &mut built.entries);
            agents.push(agents::insert(engine, values, entries, id, agent, force));
        }
        let (engine, handles, entries) = (&mut built.engine, &built.bodies, &built.entries);
        let asked = |entry: &ColliderMetadata| values.self_contact_and_hook(entry).1;
        rolling::restore_rolling_hooks(
            &model.rolling_cylinders,
            (engine, handles, entries),
            &bodies,
            asked,
        );
        apply_external_changes(&mut built, values, &memory.excluded);
        let AssembledWorld {
            engine: scaffold,
            entries,
            ..
        } = built;
        let mut engine = RapierWorld::new(&self.dynamics.settings, gravity);
        engine.set_compliance(&self.dynamics.settings, laws.compliance);
        engine.islands = shot.islands.0.into_owned();
        engine.broad_phase = shot.broad_phase.0.into_owned();
        engine.narrow_phase = shot.narrow_phase.0.into_owned();
        engine.bodies = bodies;
        engine.sleeping_cache = memory.sleeping_cache;
        engine.joints = shot.joints.0.into_owned();
        engine.colliders = scaffold.colliders;
        for (plan, body) in model.bodies.iter().zip(&self.dynamics.bodies) {
            if pose_of(&engine, body) != Some(state.part_pose[plan.root()]) {
                return refuse(
                    "the state is of another moment: restore the state that was saved with it first",
                );
            }
        }
        for (agent, there) in agents.iter().zip(&state.agents) {
            let rigid = engine.bodies.get(agent.handle);
            if rigid.is_none_or(|rigid| rigid.translation() != there.position) {
                return refuse("the state's agents are of another moment");
            }
        }
        if memory
            .grips
            .iter()
            .any(|grip| grip.agent.index() >= agents.len())
        {
            return refuse("an agent that does not exist holds something");
        }
        self.dynamics.engine = engine;
        self.dynamics.entries = entries;
        self.dynamics.table = table;
        self.dynamics.masses = weights;
        self.applied.clone_from(&state.overrides);
        self.agents.list = agents;
        *self.dynamics.laws = laws;
        self.dynamics.tick = memory.tick;
        self.dynamics.statuses = memory.statuses;
        self.agents.passive_velocities = memory.passive_velocities;
        self.dynamics.collision_exclusions = memory.excluded;
        self.hands.held_objects = memory.grips;
        self.hands.released_overlapping = memory.released_overlapping;
        self.articulation.hand_drives = memory.drives;
        self.pushes = memory.ongoing_pushes;
        self.articulation.actuations = memory.pulls;
        for joint in &mut self.articulation.joints {
            joints::update_joint_parameters(&mut self.dynamics.engine, &model, joint, state);
        }
        self.contacts.tracker = memory.contact_tracker;
        self.contacts.merged_events = ExcessEventTotals::default();
        self.notices.clear();
        Ok(())
    }

    fn check_header<'a>(&self, bytes: &'a [u8]) -> Result<Cow<'a, [u8]>, PhysicsError> {
        let packed = bytes.starts_with(MAGIC);
        if bytes.len() < HEADER || !(packed || bytes.starts_with(MAGIC_OF_MOMENTS)) {
            return refuse(format!(
                "{} bytes that do not begin with \"dwph\"",
                bytes.len()
            ));
        }
        let word = |at: usize| u64::from_le_bytes(std::array::from_fn(|k| bytes[at + k]));
        let version = u32::from_le_bytes(std::array::from_fn(|k| bytes[4 + k]));
        if version != VERSION {
            return refuse(format!("version {version}; this build reads {VERSION}"));
        }
        if word(8) != self.dynamics.model.house.fingerprint() {
            return refuse(format!(
                "it belongs to another house than {:?}",
                self.dynamics.model.house.name
            ));
        }
        if word(16) != config_hash(&self.dynamics.settings.config) {
            return refuse("it was taken with other settings");
        }
        let body = &bytes[HEADER..];
        if word(24) != xxh3_64(body) {
            return refuse("its check sum does not fit: it is damaged");
        }
        if !packed {
            return Ok(Cow::Borrowed(body));
        }
        Ok(Cow::Owned(unpack(body, &[])?))
    }
}

fn apply_external_changes(
    assembly: &mut AssembledWorld,
    properties: ContactProperties<'_>,
    excluded: &CollisionExclusions,
) {
    let entries = &assembly.entries;
    let kept = assembly.engine.friction_storage();
    assembly.engine.flush(&ContactHooks {
        entries,
        properties,
        excluded,
        friction_storage: kept,
        dt_s: 0.0,
    });
}
