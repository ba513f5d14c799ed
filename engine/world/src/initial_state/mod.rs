//! Initial states of the worlds of one house and one config.

mod default_spot;
mod snapshot_base;

pub(crate) use snapshot_base::{SnapshotBase, SnapshotParts, serialize_snapshot_parts};

use crate::config::WorldConfig;
use crate::error::WorldError;
use default_spot::default_spot;
use dwell_physics::{PhysicsConfig, PhysicsModel, PhysicsWorld, StartReport};
use dwell_scene::random::RandomKey;
use dwell_scene::{Address, AgentStart, AgentState, PersonState, State};
use std::sync::{Arc, OnceLock};

/// The initial state of a world: nothing overlaps, things have come to rest where that was requested, doors are shut, agents stand
/// where the house has them start, or on a floor clear of furniture. Worlds begin with a copy of it, and go back to it.
#[derive(Debug)]
pub(crate) struct InitialWorld {
    pub(crate) state: State,
    pub(crate) physics: PhysicsWorld,
    pub(crate) start_report: StartReport,
    base: OnceLock<SnapshotBase>,
}

impl InitialWorld {
    /// Returns the bytes that snapshots are packed beside, made at first use.
    pub(crate) fn snapshot_base(
        &self,
        model: &Arc<PhysicsModel>,
        config: &WorldConfig,
    ) -> &SnapshotBase {
        self.base.get_or_init(|| SnapshotBase::of(model, config))
    }

    /// # Errors
    /// [`WorldError`] names the setting, parameter or law that is wrong.
    pub(crate) fn new(model: &Arc<PhysicsModel>, config: &WorldConfig) -> Result<Self, WorldError> {
        let house = model.house();
        let mut state = State::new(house);
        // Agents come first: parameters and laws may name them.
        let spot = AgentStart {
            position: default_spot(house, &state, &config.agents),
            yaw_rad: 0.0,
        };
        for (k, body) in config.agents.iter().enumerate() {
            let start = house.agent_starts.get(k).copied().unwrap_or(spot);
            let agent = AgentState::new(*body, start.position, start.yaw_rad);
            let id = state.agents.push(agent);
            if let Some(person) = body.person {
                let person = PersonState::new(person, RandomKey::root(0).child(k as u64));
                state.persons.insert(id, person);
            }
        }
        state.laws = crate::laws::normalize_laws(house, &config.laws)?;
        let values: Vec<(Address, f64)> = config
            .parameters
            .iter()
            .map(|(text, value)| Ok((text.parse()?, *value)))
            .collect::<Result<_, WorldError>>()?;
        crate::laws::set_parameters(&mut state, house, &values)?;
        dwell_render::laws::check(&state.laws, state.agents.len())?;
        let physics_config = PhysicsConfig {
            control_rate_hz: config.control_rate_hz as f32,
            physics_rate_hz: config.physics_rate_hz as f32,
            ..PhysicsConfig::default()
        };
        let (mut physics, report) =
            PhysicsWorld::with_model(model.clone(), &physics_config, &mut state)?;
        physics.settle(&mut state, config.settle_s.unwrap_or_default())?;
        Ok(Self {
            state,
            physics,
            start_report: report,
            base: OnceLock::new(),
        })
    }
}
