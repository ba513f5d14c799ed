//! Laws of wheeled bases and of agents' gyros. Their target is an agent's number, counted from 0; without one they act on
//! every agent.

pub(super) mod gyro_bias_scale;
pub(super) mod unequal_wheels;
pub(super) mod wheel_slip;

use crate::error::PhysicsError;
use crate::laws::target::no_target;
use dwell_scene::{AgentId, Id, LawInfo, LawSpec, State};

/// The agents that a spec acts on.
#[derive(Clone, Copy, Debug)]
struct Riders(Option<AgentId>);

impl Riders {
    fn of(spec: &LawSpec, info: &LawInfo, state: &State) -> Result<Self, PhysicsError> {
        let Some(target) = &spec.target else {
            return Ok(Self(None));
        };
        let found = target
            .parse()
            .ok()
            .filter(|index| *index < state.agents.len());
        let Some(index) = found else {
            let numbers: Vec<String> = (0..state.agents.len()).map(|k| k.to_string()).collect();
            let names = numbers.iter().map(String::as_str);
            return Err(no_target(info.id, "agent", target, names));
        };
        Ok(Self(Some(AgentId::from_index(index))))
    }

    fn holds(self, agent: AgentId) -> bool {
        self.0.is_none_or(|one| one == agent)
    }
}
