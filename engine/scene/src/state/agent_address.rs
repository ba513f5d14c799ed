//! Parameters of agents: `agent/N/body/FIELD`, `agent/N/base/FIELD`, `agent/N/camera/fov_deg`.

use super::{Address, AgentBody, Locomotion, Parameter, State};
use crate::error::SceneError;
use crate::ids::{AgentId, Id};

impl State {
    fn find_agent(&self, address: &Address, word: &str) -> Result<AgentId, SceneError> {
        let index = word
            .parse::<usize>()
            .ok()
            .filter(|index| *index < self.agents.len());
        index.map(AgentId::from_index).ok_or_else(|| {
            address.invalid(format!(
                "no agent {word:?}; there are {}, counted from 0",
                self.agents.len()
            ))
        })
    }

    /// Returns an agent's locomotion in this world: its body's numbers with overrides.
    ///
    /// # Panics
    /// For an agent that does not exist.
    pub fn locomotion(&self, agent: AgentId) -> Locomotion {
        let nominal = self.agents[agent].body.locomotion;
        if self.overrides.is_empty() {
            return nominal;
        }
        nominal.with_overrides(|field| {
            self.override_value(format!("agent/{}/base/{field}", agent.index()))
        })
    }

    /// Returns the overridden horizontal field of view of the cameras at an agent's eyes, degrees; `None`: each has its own.
    pub fn overridden_fov_deg(&self, agent: AgentId) -> Option<f32> {
        self.override_value(format!("agent/{}/camera/fov_deg", agent.index()))
    }

    /// Returns the horizontal field of view of a camera at an agent's eyes that states none of its own, degrees.
    ///
    /// # Panics
    /// For an agent that does not exist.
    pub fn camera_fov_deg(&self, agent: AgentId) -> f32 {
        let own = self.agents[agent].body.camera_fov_deg;
        self.overridden_fov_deg(agent).unwrap_or(own)
    }

    /// Returns the parameter at `agent/N/WORDS`.
    pub(super) fn agent_parameter(
        &self,
        address: &Address,
        agent: &str,
        words: &[&str],
    ) -> Result<Parameter, SceneError> {
        let id = self.find_agent(address, agent)?;
        let body = &self.agents[id].body;
        let (parameters, kind) = match words {
            ["body", _] => (body.parameters(), "its body"),
            ["base", _] => (self.locomotion(id).parameters(), body.locomotion.name()),
            ["camera", "fov_deg"] => {
                let [low, high] = AgentBody::FOV_RANGE_DEG;
                return Ok(Parameter {
                    value: self.camera_fov_deg(id).into(),
                    unit: "deg",
                    low,
                    high,
                });
            }
            _ => {
                return Err(address.invalid(
                    "an agent has agent/N/body/FIELD, agent/N/base/FIELD and agent/N/camera/fov_deg",
                ));
            }
        };
        let found = parameters.iter().find(|(name, _)| *name == words[1]);
        found.map(|(_, parameter)| *parameter).ok_or_else(|| {
            let names: Vec<_> = parameters.iter().map(|(name, _)| *name).collect();
            address.invalid(format!(
                "no field {:?}; agent {agent} ({kind}) has {names:?}",
                words[1]
            ))
        })
    }
}
