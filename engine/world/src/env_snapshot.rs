//! An environment at one moment, as bytes.

use crate::actions::StepSizes;
use crate::env::Env;
use crate::env_agent::EnvAgent;
use crate::episode::{Episode, EpisodeGoal};
use crate::episode_spec::EpisodeSpec;
use crate::error::WorldError;
use crate::metrics::NavigationMetrics;
use dwell_scene::{AgentId, IdVec, Pose};
use serde::{Deserialize, Serialize};

/// The first bytes of an [`Env::snapshot`]: its kind and version.
const MAGIC: &[u8] = b"dwenv9";

/// Episodes at one moment. Their goals come again from the seed, and from what they state.
#[derive(Serialize, Deserialize)]
struct EnvSnapshot {
    seed: u64,
    steps: u64,
    /// Those who act, in order.
    agents: Vec<AgentSnapshot>,
    starts: IdVec<AgentId, Pose>,
    /// What the episodes state. Shape (agent,), or empty.
    specs: Vec<EpisodeSpec>,
    world: Vec<u8>,
}

/// An agent's episode at one moment.
#[derive(Serialize, Deserialize)]
struct AgentSnapshot {
    agent: u32,
    task: String,
    /// The task's settings, as JSON.
    settings: String,
    step_sizes: StepSizes,
    done: bool,
    success: bool,
    instruction: String,
    start: Pose,
    progress: NavigationMetrics,
    /// Whether a task outside of this crate asks for something else than the seed's goal.
    goal_replaced: bool,
    /// What the task keeps beside the world.
    task_state: Vec<u8>,
    /// What sensors remember, by their names; those that remember nothing are left out.
    sensor_states: Vec<(String, Vec<u8>)>,
}

impl AgentSnapshot {
    fn of(agent: &EnvAgent, episode: &Episode) -> Self {
        Self {
            agent: agent.id.0,
            task: agent.kind.name.to_owned(),
            settings: agent.task.settings().to_string(),
            step_sizes: agent.step_sizes,
            done: agent.done,
            success: agent.success,
            instruction: episode.instruction.clone(),
            start: episode.start,
            progress: episode.progress,
            goal_replaced: episode.goal.kind.is_empty(),
            task_state: agent.task.snapshot(),
            sensor_states: sensor_states(agent),
        }
    }

    /// Returns why this moment does not fit an agent, if it does not.
    fn misfit(&self, own: &EnvAgent) -> Option<String> {
        let settings = own.task.settings().to_string();
        let sizes = |sizes: &StepSizes| {
            let (forward, turn, look) = (sizes.forward_m, sizes.turn_deg, sizes.look_deg);
            format!("forward_m {forward}, turn_deg {turn}, look_deg {look}")
        };
        if self.agent != own.id.0 {
            let (found, allowed) = (self.agent, own.id.0);
            return Some(format!(
                "agent {found} acts in it where agent {allowed} does in the environment"
            ));
        }
        if self.task != own.kind.name {
            return Some(format!("it is of the task {}", self.task));
        }
        if self.settings != settings {
            let found = &self.settings;
            return Some(format!(
                "its task_settings are {found}, and those of the environment {settings}"
            ));
        }
        (self.step_sizes != own.step_sizes).then(|| {
            let (found, allowed) = (sizes(&self.step_sizes), sizes(&own.step_sizes));
            format!("its stride is {found}, and that of the environment {allowed}")
        })
    }

    /// Puts an episode of the same seed to this moment.
    fn apply(self, agent: &mut EnvAgent, tokens: Vec<i32>) {
        if let Some(episode) = &mut agent.episode {
            (episode.instruction, episode.tokens) = (self.instruction, tokens);
            (episode.start, episode.progress) = (self.start, self.progress);
            if self.goal_replaced {
                episode.goal = EpisodeGoal::default();
            }
        }
        (agent.done, agent.success) = (self.done, self.success);
    }
}

impl Env {
    /// World and episodes as bytes.
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] before the first reset.
    ///
    /// # Panics
    /// Never: plain data can always be written to memory.
    pub fn snapshot(&self) -> Result<Vec<u8>, WorldError> {
        let agents = self.agents.iter();
        let agents = agents.map(|agent| Some(AgentSnapshot::of(agent, agent.episode.as_ref()?)));
        let Some(agents) = agents.collect() else {
            let message = "snapshot: no episode has begun; call reset first";
            return Err(WorldError::InvalidCall(message.to_owned()));
        };
        let moment = EnvSnapshot {
            seed: self.seed,
            steps: self.steps,
            agents,
            starts: self.start_poses.clone(),
            specs: self.specs.clone(),
            world: self.world.snapshot(),
        };
        let body =
            postcard::to_stdvec(&moment).expect("plain data can always be written to memory");
        Ok([MAGIC, &body].concat())
    }

    /// Goes to where [`Self::snapshot`] was taken in an environment of the same house, world, agents, tasks with their settings, and
    /// step sizes; the next steps give the same bits as
    /// they did then. Only scripted experts forget manoeuvres that they were about. Sensors may be others: those that remember and
    /// were not there begin with what they sense now.
    ///
    /// # Errors
    /// [`WorldError::Snapshot`] with the reason. The environment then stays as it was.
    pub fn restore(&mut self, bytes: &[u8]) -> Result<(), WorldError> {
        // Without an episode there is none to return to.
        let before = self.snapshot();
        let refused = self.restore_snapshot(bytes);
        if refused.is_err()
            && before
                .and_then(|before| self.restore_snapshot(&before))
                .is_err()
        {
            self.clear_episodes();
        }
        refused
    }

    fn restore_snapshot(&mut self, bytes: &[u8]) -> Result<(), WorldError> {
        let refuse = |why: String| WorldError::Snapshot(why);
        let body = bytes
            .strip_prefix(MAGIC)
            .ok_or_else(|| refuse("it does not begin with \"dwenv9\"".to_owned()))?;
        let moment: EnvSnapshot =
            postcard::from_bytes(body).map_err(|error| refuse(error.to_string()))?;
        if moment.agents.len() != self.agents.len() {
            let (found, allowed) = (moment.agents.len(), self.agents.len());
            return Err(refuse(format!(
                "{found} agents act in it, and {allowed} in the environment"
            )));
        }
        for (own, saved) in self.agents.iter().zip(&moment.agents) {
            if let Some(why) = saved.misfit(own) {
                return Err(refuse(why));
            }
        }
        self.reset_stated(moment.seed, &moment.specs)?;
        let tokens = self.restore_world(&moment)?;
        let agents = self.agents.iter_mut().zip(moment.agents);
        for ((agent, saved), tokens) in agents.zip(tokens) {
            saved.apply(agent, tokens);
        }
        (self.steps, self.start_poses) = (moment.steps, moment.starts);
        Ok(())
    }

    /// Restores the world. Gives back the tokens of all instructions.
    fn restore_world(&mut self, moment: &EnvSnapshot) -> Result<Vec<Vec<i32>>, WorldError> {
        let agents = self.agents.iter().zip(&moment.agents);
        let tokens = agents.map(|(agent, saved)| agent.instruction_tokens(&saved.instruction));
        let tokens: Result<Vec<_>, _> = tokens.collect();
        self.world.restore(&moment.world)?;
        for (agent, saved) in self.agents.iter_mut().zip(&moment.agents) {
            agent.task.restore(&self.world, &saved.task_state)?;
            for sensor in &mut agent.sensors {
                let name = sensor.spec().name;
                let mut states = saved.sensor_states.iter();
                match states.find(|(other, _)| *other == name) {
                    Some((_, state)) => sensor.restore(&self.world, state)?,
                    // It was taken without this sensor.
                    None => sensor.forget(&self.world)?,
                }
            }
        }
        tokens
    }
}

/// Returns what the sensors of an agent remember, by their names.
fn sensor_states(agent: &EnvAgent) -> Vec<(String, Vec<u8>)> {
    let sensors = agent.sensors.iter();
    let states = sensors.map(|sensor| (sensor.spec().name, sensor.snapshot()));
    states.filter(|(_, state)| !state.is_empty()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::actions::DiscreteAction;
    use crate::engines::Engines;
    use crate::env_config::EnvConfig;
    use crate::episode::StepInfo;
    use std::sync::Arc;

    fn env() -> Env {
        env_with(r#"{"sensors": [{"kind": "compass"}]}"#)
    }

    fn env_with(config: &str) -> Env {
        let (house, _) = dwell_houses::open("builtin:apartment").unwrap();
        let config: EnvConfig = serde_json::from_str(config).unwrap();
        Env::new(Engines::new(Arc::new(house)), &config).unwrap()
    }

    #[test]
    fn a_restored_episode_goes_on_and_is_judged_as_before() {
        use DiscreteAction::{MoveForward, Stop, TurnLeft};

        let mut env = env();
        assert!(matches!(env.snapshot(), Err(WorldError::InvalidCall(_))));
        env.reset(3).unwrap();
        let go = |env: &mut Env, actions: &[DiscreteAction]| -> Vec<(u64, Vec<StepInfo>)> {
            let step = |action: &DiscreteAction| {
                let info = env.step(&[Some(*action)]).unwrap();
                env.enable_listeners().unwrap();
                (env.world().hash(), info)
            };
            actions.iter().map(step).collect()
        };
        go(&mut env, &[MoveForward, TurnLeft, MoveForward]);
        let text = env.episode(0).unwrap().instruction.clone();
        let saved = env.snapshot().unwrap();
        let rest = [MoveForward, MoveForward, TurnLeft, Stop];
        let first = go(&mut env, &rest);
        assert!(env.check_can_step(&[Some(Stop)]).is_err());
        env.restore(&saved).unwrap();
        assert_eq!(go(&mut env, &rest), first);
        let mut other = self::env();
        other.reset(8).unwrap();
        other.restore(&saved).unwrap();
        assert_eq!(other.steps(), 3);
        assert_eq!(other.episode(0).unwrap().instruction, text);
        assert_eq!(go(&mut other, &rest), first);
        for cut in [0, 5, 30, saved.len() / 2, saved.len() - 1] {
            assert!(other.restore(&saved[..cut]).is_err(), "{cut}");
        }
    }

    #[test]
    fn a_snapshot_of_other_settings_is_refused_and_changes_nothing() {
        let config = |more: &str| {
            format!(r#"{{"task": "Free", "sensors": [], {more} "world": {{"settle_s": 0}}}}"#)
        };
        let mut env = env_with(&config(""));
        env.reset(3).unwrap();
        let saved = env.snapshot().unwrap();
        for (more, told) in [
            (
                r#""stride": {"forward_m": 0.3},"#,
                "stride is forward_m 0.1",
            ),
            (
                r#""task_settings": {"start": "anywhere"},"#,
                r#"task_settings are {"start":"house"}"#,
            ),
        ] {
            let mut other = env_with(&config(more));
            other.reset(8).unwrap();
            let error = other.restore(&saved).unwrap_err().to_string();
            assert!(error.contains(told), "{error}");
            assert!(other.episode(0).is_ok());
        }
        let named = r#""task_settings": {"start": "house"}, "stride": {"forward_m": 0.1},"#;
        env_with(&config(named)).restore(&saved).unwrap();
    }
}
