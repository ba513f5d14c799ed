//! Snapshots of worlds as bytes.
//!
//! A world begins like all worlds of its house and agents; most of it stays as it was. Its bytes are packed beside those of the
//! initial state, which a restoring process has as well: unchanged parts take next to nothing.

use crate::error::WorldError;
use crate::initial_state::{SnapshotBase, SnapshotParts, serialize_snapshot_parts};
use crate::sound::WorldSound;
use crate::world::World;
use dwell_scene::packing::{pack_to_size, unpack};
use dwell_scene::{AgentBody, Id, PersonBody, State};
use xxhash_rust::xxh3::xxh3_64;

/// Header of a world's snapshot: its kind and version.
const MAGIC: &[u8] = b"dwworld9";

/// The fields that are checked before the rest is unpacked.
#[derive(serde::Serialize, serde::Deserialize)]
struct SnapshotHeader {
    /// The house's fingerprint.
    house: u64,
    /// The agents' bodies as the world was made with them.
    agents: Vec<AgentBody>,
    /// Those of them that are persons. Shape (agent,).
    persons: Vec<Option<PersonBody>>,
    /// Hash of the initial state's bytes.
    base: u64,
}

/// What makes bodies persons'. Shape (agent,).
fn persons_of(bodies: &[AgentBody]) -> Vec<Option<PersonBody>> {
    bodies.iter().map(|body| body.person).collect()
}

impl World {
    /// The whole world as bytes: state, physics with its contact caches, sound queues, the key of the episode and the motion of the last
    /// step; packed.
    ///
    /// # Panics
    /// Never: plain bytes can always be written to memory.
    pub fn snapshot(&self) -> Vec<u8> {
        let base = self.base();
        let head = SnapshotHeader {
            house: self.house().fingerprint(),
            agents: self.config().agents.clone(),
            persons: persons_of(&self.config().agents),
            base: base.checksum,
        };
        let mut told =
            postcard::to_stdvec(&head).expect("plain bytes can always be written to memory");
        let (state, physics) = (self.state(), &self.physics);
        let body = serialize_snapshot_parts(
            self.house(),
            state,
            physics,
            (self.sound.to_bytes(), self.key, self.motion_history.clone()),
        );
        let most = physics.target_snapshot_bytes() - told.len() - MAGIC.len() - size_of::<u64>();
        told.extend_from_slice(&pack_to_size(&body, &base.bytes, most));
        let mut bytes = MAGIC.to_vec();
        bytes.extend_from_slice(&xxh3_64(&told).to_le_bytes());
        bytes.extend_from_slice(&told);
        bytes
    }

    /// Restores [`World::snapshot`]; the next steps give the same bits as they did then.
    ///
    /// # Errors
    /// [`WorldError`] with the reason; the world is then as it was before.
    pub fn restore(&mut self, bytes: &[u8]) -> Result<(), WorldError> {
        let (parts, mut state) = self.unpack_snapshot(bytes)?;
        let mut sound = WorldSound::from_bytes(
            &self.config,
            (&self.engines, &state),
            parts.key.child("sound"),
            &parts.sound,
        )?;
        let parts_of_past = parts
            .motion_history
            .previous_part_poses
            .iter()
            .map(|(part, _)| part.index());
        if parts_of_past.max() >= Some(state.part_pose.len()) {
            return Err(WorldError::Snapshot(
                "parts moved that the house does not have".to_owned(),
            ));
        }
        self.physics.restore(&mut state, &parts.physics)?;
        self.state = state;
        sound.set_threads(self.sound.threads());
        self.sound = sound;
        self.key = parts.key;
        self.motion_history = parts.motion_history;
        self.events.clear();
        self.rays.update(&self.state);
        Ok(())
    }

    /// Returns the state that a snapshot of this world holds, to compare it with the present one.
    ///
    /// # Errors
    /// [`WorldError`] as [`World::restore`].
    pub fn state_of_snapshot(&self, bytes: &[u8]) -> Result<State, WorldError> {
        self.unpack_snapshot(bytes).map(|(_, state)| state)
    }

    fn unpack_snapshot(&self, bytes: &[u8]) -> Result<(SnapshotParts, State), WorldError> {
        let refuse = |why: String| WorldError::Snapshot(why);
        let told = bytes
            .strip_prefix(MAGIC)
            .ok_or_else(|| refuse("it does not begin with \"dwworld9\"".to_owned()))?;
        let (sum, told) = told
            .split_first_chunk::<8>()
            .ok_or_else(|| refuse("it is too short".to_owned()))?;
        if u64::from_le_bytes(*sum) != xxh3_64(told) {
            return Err(refuse(
                "its check sum does not fit: it is damaged".to_owned(),
            ));
        }
        let (head, packed): (SnapshotHeader, &[u8]) =
            postcard::take_from_bytes(told).map_err(|error| refuse(error.to_string()))?;
        if head.house != self.house().fingerprint() {
            let name = &self.house().name;
            return Err(refuse(format!("it belongs to another house than {name:?}")));
        }
        // Bodies as they were made: what was set since is in the state.
        let mut agents = head.agents;
        for (body, person) in agents.iter_mut().zip(&head.persons) {
            body.person = *person;
        }
        if agents != self.config().agents {
            let (found, allowed) = (agents.len(), self.config().agents.len());
            let mut pairs = agents.iter().zip(&self.config().agents);
            let other = pairs.position(|(found, own)| found != own);
            return Err(refuse(match other {
                Some(k) if found == allowed => format!(
                    "its agent {k} was made with another body than the world's; the bodies they were made with must be the same"
                ),
                _ => format!(
                    "it has {found} agents, and the world {allowed}; their number must be the same"
                ),
            }));
        }
        let base = self.base();
        if head.base != base.checksum {
            return Err(refuse(
                "its world began otherwise: with other rates, or on another kind of machine"
                    .to_owned(),
            ));
        }
        let body = unpack(packed, &base.bytes)?;
        let parts: SnapshotParts =
            postcard::from_bytes(&body).map_err(|error| refuse(error.to_string()))?;
        let state = State::from_bytes(self.house(), &parts.state)?;
        let persons = state
            .persons
            .iter()
            .map(|(id, person)| (id.index(), person.body));
        let told = head.persons.iter().enumerate();
        if state.agents.len() != agents.len()
            || !persons.eq(told.filter_map(|(k, person)| Some((k, (*person)?))))
        {
            return Err(refuse("its state has other agents than it says".to_owned()));
        }
        Ok((parts, state))
    }

    fn base(&self) -> &SnapshotBase {
        let model = self.engines.physics_model();
        self.initial.snapshot_base(model, &self.config)
    }
}
