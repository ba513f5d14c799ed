//! Configuration of environments.

use crate::actions::{self, ActionMode, ActionSet, DiscreteAction, StepSizes};
use crate::config::WorldConfig;
use crate::error::{WorldError, no_agent};
use crate::tasks;
use dwell_scene::{AgentId, Id};
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// The configuration of an environment. Every field has a default; unknown fields are refused.
///
/// Task, strides and sensors hold for every agent that states no others.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct EnvConfig {
    /// The task's name.
    pub task: String,
    /// The task's settings.
    pub task_settings: Value,
    /// Rates, laws, parameters, and the bodies of all agents.
    pub world: WorldConfig,
    /// Lengths and angles of movement actions.
    pub stride: StepSizes,
    /// The form of actions.
    pub action_mode: ActionMode,
    /// The discrete actions to choose from, by name, in the order of their numbers; `None`: those that are usual in the mode, and
    /// with [`ActionMode::Discrete`] those of the tasks.
    pub actions: Option<Vec<String>>,
    /// Sensors by name with their settings; `None`: the task's own choice.
    pub sensors: Option<Vec<SensorConfig>>,
    /// Those who act, each once, in the order of actions, infos and observations; default agent 0 alone. All others stand
    /// still.
    pub agents: Vec<AgentConfig>,
}

/// An agent that acts. What it does not state is as the environment says.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct AgentConfig {
    /// Which of the world's agents, by the number of its body; default 0.
    pub agent: u32,
    /// Its task's name.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub task: Option<String>,
    /// The settings of its task. Where it has a task of its own and states none: the task's defaults.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub task_settings: Option<Value>,
    /// Lengths and angles of its movement actions.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stride: Option<StepSizes>,
    /// The form of its actions.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub action_mode: Option<ActionMode>,
    /// The discrete actions that it chooses from, by name; where it has a form of its own and states none: those that are usual in it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub actions: Option<Vec<String>>,
    /// Its sensors by name with their settings.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sensors: Option<Vec<SensorConfig>>,
    /// Whether it acts as its task's expert says, whatever action it is given.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub scripted: bool,
}

/// A sensor that is asked for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SensorConfig {
    /// The kind's name.
    pub kind: String,
    /// Its settings.
    #[serde(default)]
    pub settings: Value,
}

impl Default for EnvConfig {
    fn default() -> Self {
        Self {
            task: "InstructionFollowing".to_owned(),
            task_settings: Value::Null,
            world: WorldConfig::default(),
            stride: StepSizes::default(),
            action_mode: ActionMode::Discrete,
            actions: None,
            sensors: None,
            agents: vec![AgentConfig::default()],
        }
    }
}

/// An agent that acts, with all that holds for it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ResolvedAgentConfig<'a> {
    pub(crate) agent: AgentId,
    pub(crate) task: &'a str,
    pub(crate) task_settings: &'a Value,
    pub(crate) stride: StepSizes,
    pub(crate) action_mode: ActionMode,
    /// The discrete actions that it has.
    pub(crate) actions: ActionSet,
    /// `None`: the task's own choice.
    pub(crate) sensors: Option<&'a [SensorConfig]>,
    /// Whether it acts as its task's expert says.
    pub(crate) scripted: bool,
}

impl EnvConfig {
    /// The discrete actions that an agent chooses from, in the order of their numbers; `agent`: its place among those who act.
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] for an agent that does not act; [`WorldError::Unknown`] for a name that no action has;
    /// [`WorldError::Config`] for none, one twice, and names in a mode that has none to choose from.
    pub fn chosen_actions(&self, agent: usize) -> Result<Vec<DiscreteAction>, WorldError> {
        let own = self.agents.get(agent);
        self.actions_of(own.ok_or_else(|| no_agent(agent, self.agents.len()))?)
    }

    fn actions_of(&self, own: &AgentConfig) -> Result<Vec<DiscreteAction>, WorldError> {
        let mode = own.action_mode.unwrap_or(self.action_mode);
        let general = self.actions.as_ref().filter(|_| own.action_mode.is_none());
        match (own.actions.as_ref().or(general), mode) {
            (None, mode) => {
                let task = own.task.as_ref().unwrap_or(&self.task);
                let usual = tasks::find(task).map_or(DiscreteAction::DEFAULT, |kind| kind.actions);
                let has = |action: &DiscreteAction| usual.contains(action);
                Ok(mode.default_actions(DiscreteAction::ALL.into_iter().filter(has).collect()))
            }
            (Some(names), ActionMode::Velocity) => Err(WorldError::Config {
                field: "actions",
                found: names.join(", "),
                allowed: "none with action_mode velocity: velocities are all it has".to_owned(),
            }),
            (Some(names), _) => actions::actions_named(names),
        }
    }

    /// The agents that act, in order.
    ///
    /// # Errors
    /// [`WorldError::Config`] for none, one that does not exist or is there twice, and a stride out of range.
    pub(crate) fn resolved_agents(&self) -> Result<Vec<ResolvedAgentConfig<'_>>, WorldError> {
        let fault = |field: &'static str, found: String, allowed: String| WorldError::Config {
            field,
            found,
            allowed,
        };
        if self.agents.is_empty() {
            let allowed = "at least one agent that acts".to_owned();
            return Err(fault("agents", "[]".to_owned(), allowed));
        }
        for (k, own) in self.agents.iter().enumerate() {
            let count = self.world.agents.len();
            // A task says itself that it needs an agent.
            if own.agent as usize >= count.max(1) {
                let allowed = format!("below the number of agents, {count}");
                return Err(fault("agent", own.agent.to_string(), allowed));
            }
            if self.agents[..k]
                .iter()
                .any(|other| other.agent == own.agent)
            {
                let found = format!("agent {} twice", own.agent);
                return Err(fault("agents", found, "each agent once".to_owned()));
            }
        }
        let roles = self.agents.iter();
        let roles: Vec<_> = roles
            .map(|own| self.resolve_agent(own))
            .collect::<Result<_, _>>()?;
        let mut kinds = roles.iter().filter_map(|role| tasks::find(role.task).ok());
        if let Some(kind) = kinds.find(|kind| kind.min_agents > roles.len()) {
            let found = format!("{} with {} agent", kind.name, roles.len());
            let allowed = format!("at least {} agents in {}", kind.min_agents, kind.name);
            return Err(fault("agents", found, allowed));
        }
        Ok(roles)
    }

    fn resolve_agent<'a>(
        &'a self,
        own: &'a AgentConfig,
    ) -> Result<ResolvedAgentConfig<'a>, WorldError> {
        let general = match own.task {
            Some(_) => &Value::Null,
            None => &self.task_settings,
        };
        let stride = own.stride.unwrap_or(self.stride);
        stride.check()?;
        Ok(ResolvedAgentConfig {
            agent: AgentId::from_index(own.agent as usize),
            task: own.task.as_deref().unwrap_or(&self.task),
            task_settings: own.task_settings.as_ref().unwrap_or(general),
            stride,
            action_mode: own.action_mode.unwrap_or(self.action_mode),
            actions: ActionSet::of(&self.actions_of(own)?),
            sensors: own.sensors.as_deref().or(self.sensors.as_deref()),
            scripted: own.scripted,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::AgentBody;
    use serde_json::json;

    fn config(text: &Value) -> EnvConfig {
        let mut config: EnvConfig = serde_json::from_value(text.clone()).unwrap();
        config.world.agents = vec![AgentBody::default(); 3];
        config
    }

    #[test]
    fn an_agent_has_what_it_states_and_else_what_holds_for_all() {
        let config = config(&json!({
            "task": "Free",
            "task_settings": {"start": "anywhere"},
            "sensors": [{"kind": "gps"}],
            "agents": [
                {"agent": 2},
                {"task": "InstructionFollowing", "sensors": [], "stride": {"forward_m": 0.5}},
                {"agent": 1, "task_settings": {"start": "house"}},
            ],
        }));
        let [last, first, second] = config.resolved_agents().unwrap().try_into().unwrap();
        assert_eq!((last.agent.index(), last.task), (2, "Free"));
        assert_eq!(last.task_settings, &json!({"start": "anywhere"}));
        assert_eq!(last.sensors.unwrap()[0].kind, "gps");
        assert_eq!(
            (first.agent.index(), first.task),
            (0, "InstructionFollowing")
        );
        assert_eq!(first.task_settings, &Value::Null);
        assert!(first.sensors.unwrap().is_empty());
        assert!((first.stride.forward_m - 0.5).abs() < 1e-6);
        assert_eq!((second.agent.index(), second.task), (1, "Free"));
        assert_eq!(second.task_settings, &json!({"start": "house"}));
        assert_eq!(second.stride, StepSizes::default());
    }

    #[test]
    fn one_agent_acts_by_default_and_none_or_one_twice_is_refused() {
        let default = EnvConfig::default();
        let roles = default.resolved_agents().unwrap();
        assert_eq!((roles.len(), roles[0].agent.index()), (1, 0));
        let told = |agents: Value| {
            let config = config(&json!({"agents": agents}));
            config.resolved_agents().unwrap_err().to_string()
        };
        assert_eq!(
            told(json!([])),
            "agents is []; allowed is at least one agent that acts"
        );
        assert_eq!(
            told(json!([{}, {"agent": 1}, {}])),
            "agents is agent 0 twice; allowed is each agent once"
        );
        assert_eq!(
            told(json!([{"agent": 3}])),
            "agent is 3; allowed is below the number of agents, 3"
        );
        assert_eq!(
            told(json!([{"stride": {"turn_deg": 0.0}}])),
            "turn_deg is 0; allowed is 0.1 to 180"
        );
    }
}
