//! Serialization and hash of a state.

use super::{PersonState, State};
use crate::error::SceneError;
use crate::house::House;
use crate::ids::{AgentId, Id};
use std::collections::BTreeMap;
use xxhash_rust::xxh3::xxh3_64;

const MAGIC: &[u8; 4] = b"dwst";
const VERSION: u32 = 6;
const HEADER: usize = 4 + 4 + 8 + 8;

impl State {
    fn snapshot_body(&self) -> Vec<u8> {
        let mut body = postcard::to_stdvec(self)
            .expect("a state is plain data that postcard can always write to memory");
        if !self.persons.is_empty() {
            let persons = postcard::to_stdvec(&self.persons);
            body.extend(persons.expect("persons are plain data that can always be written"));
        }
        body
    }

    /// Returns a hash that changes with any bit of the state, derived fields and stored order included.
    ///
    /// # Determinism
    /// Equal states give equal numbers on every machine (XXH3 over the snapshot's body).
    pub fn hash(&self) -> u64 {
        xxh3_64(&self.snapshot_body())
    }

    /// Returns the state as bytes: header, version, fingerprint of the house, checksum, body.
    pub fn to_bytes(&self, house: &House) -> Vec<u8> {
        let body = self.snapshot_body();
        let mut bytes = Vec::with_capacity(HEADER + body.len());
        bytes.extend_from_slice(MAGIC);
        bytes.extend_from_slice(&VERSION.to_le_bytes());
        bytes.extend_from_slice(&house.fingerprint().to_le_bytes());
        bytes.extend_from_slice(&xxh3_64(&body).to_le_bytes());
        bytes.extend_from_slice(&body);
        bytes
    }

    /// Reads bytes written by [`State::to_bytes`].
    ///
    /// # Errors
    /// [`SceneError::Snapshot`] for foreign or corrupted bytes, another version, or another house.
    pub fn from_bytes(house: &House, bytes: &[u8]) -> Result<Self, SceneError> {
        let refuse = |why: String| Err(SceneError::Snapshot(why));
        if bytes.len() < HEADER || &bytes[..4] != MAGIC {
            return refuse(format!(
                "{} bytes that do not begin with \"dwst\"",
                bytes.len()
            ));
        }
        let word = |at: usize| u64::from_le_bytes(std::array::from_fn(|k| bytes[at + k]));
        let version = u32::from_le_bytes(std::array::from_fn(|k| bytes[4 + k]));
        if version != VERSION {
            return refuse(format!("version {version}; this build reads {VERSION}"));
        }
        if word(8) != house.fingerprint() {
            return refuse(format!("it belongs to another house than {:?}", house.name));
        }
        let body = &bytes[HEADER..];
        if word(16) != xxh3_64(body) {
            return refuse("its check sum does not fit: it is damaged".to_owned());
        }
        let damaged = |error: postcard::Error| SceneError::Snapshot(error.to_string());
        let (mut state, rest): (Self, &[u8]) = postcard::take_from_bytes(body).map_err(damaged)?;
        if !rest.is_empty() {
            let persons = postcard::from_bytes(rest).map_err(damaged)?;
            state.take_persons(persons)?;
        }
        for address in state.overrides.keys() {
            if state.canonical(house, address)? != *address {
                return refuse(format!(
                    "its parameter {address} has another spelling in this build"
                ));
            }
        }
        for agent in &state.agents {
            agent.body.check()?;
            let most = agent.body.height_m - 2.0 * agent.body.radius_m;
            if !(0.0..=most.max(0.0)).contains(&agent.crouched_by_m) {
                let found = agent.crouched_by_m;
                return refuse(format!(
                    "an agent in it crouches by {found} m; its body can by 0 to {most}"
                ));
            }
        }
        let lengths = (
            state.part_pose.len(),
            state.part_velocity.len(),
            state.joint_position.len(),
            state.joint_command.len(),
            state.held_by.len(),
        );
        if lengths
            != (
                house.parts.len(),
                house.parts.len(),
                house.joints.len(),
                house.joints.len(),
                house.objects.len(),
            )
        {
            return refuse(format!(
                "it has other counts of parts, joints and objects ({lengths:?}) than the house"
            ));
        }
        Ok(state)
    }

    /// Takes the persons of a snapshot.
    fn take_persons(&mut self, persons: BTreeMap<AgentId, PersonState>) -> Result<(), SceneError> {
        for (agent, person) in &persons {
            let count = self.agents.len();
            let refuse = |why: &str| {
                let why = format!("its person {} {why}; there are {count} agents", agent.0);
                Err(SceneError::Snapshot(why))
            };
            if agent.index() >= count {
                return refuse("is no agent");
            }
            if !person.is_finite() {
                return refuse("has numbers that are not finite");
            }
            self.agents[*agent].body.person = Some(person.body);
        }
        self.persons = persons;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use crate::random::RandomKey;
    use crate::{AgentBody, AgentState, House, PersonState, ShoeboxMaterials, State};
    use glam::Vec3;

    #[test]
    fn a_snapshot_comes_back_equal_and_damage_is_refused() {
        let house = House::shoebox([6.0, 3.0, 5.0], &ShoeboxMaterials::default()).unwrap();
        let mut state = State::new(&house);
        state.agents.push(AgentState::new(
            AgentBody::default(),
            Vec3::new(1.0, 0.0, 2.0),
            0.4,
        ));
        let bytes = state.to_bytes(&house);
        let again = State::from_bytes(&house, &bytes).unwrap();
        assert_eq!(again, state);
        assert_eq!(again.hash(), state.hash());
        for k in 0..bytes.len() {
            let mut damaged = bytes.clone();
            damaged[k] ^= 0x10;
            assert!(State::from_bytes(&house, &damaged).is_err(), "byte {k}");
        }
        assert!(State::from_bytes(&house, &bytes[..bytes.len() - 1]).is_err());
    }

    #[test]
    fn persons_come_back_with_their_bodies_and_cost_nothing_where_there_are_none() {
        let house = House::shoebox([6.0, 3.0, 5.0], &ShoeboxMaterials::default()).unwrap();
        let mut state = State::new(&house);
        let body = AgentBody::person(1.8);
        let mut agent = AgentState::new(body, Vec3::ZERO, 0.4);
        let id = state.agents.push(agent);
        let bare = state.to_bytes(&house).len();
        let mut person = PersonState::new(body.person.unwrap(), RandomKey::root(2));
        person.gait.phase = 0.3;
        state.persons.insert(id, person);
        let bytes = state.to_bytes(&house);
        assert_eq!(State::from_bytes(&house, &bytes).unwrap(), state);
        let mut moved = state.clone();
        moved.persons.get_mut(&id).unwrap().gait.phase = 0.4;
        assert_ne!(moved.hash(), state.hash());
        // A capsule of the same numbers has the bytes that it always had.
        agent.body.person = None;
        let mut capsule = State::new(&house);
        capsule.agents.push(agent);
        assert_eq!(capsule.to_bytes(&house).len(), bare);
        person.gait.phase = f32::NAN;
        state.persons.insert(id, person);
        assert!(State::from_bytes(&house, &state.to_bytes(&house)).is_err());
    }

    #[test]
    fn the_hash_sees_every_field() {
        let house = House::shoebox([6.0, 3.0, 5.0], &ShoeboxMaterials::default()).unwrap();
        let state = State::new(&house);
        let mut later = state.clone();
        later.time_s += 1e-12;
        assert_ne!(later.hash(), state.hash());
        let mut other = state.clone();
        other
            .overrides
            .insert("world/gravity_m_s2".parse().unwrap(), 9.7);
        assert_ne!(other.hash(), state.hash());
    }
}
