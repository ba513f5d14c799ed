//! Tasks outside of this crate, in Python for instance, on an environment: they set the goal and judge the steps.

use crate::env::Env;
use crate::env_agent::EnvAgent;
use crate::episode::{EpisodeGoal, StepResult};
use crate::error::WorldError;
use crate::metrics::NavigationMetrics;
use crate::sensors::Dtype;
use dwell_scene::Pose;
use dwell_semantics::instruct::{CHARSET, MAX_TEXT_LEN};
use dwell_semantics::vocabulary;

impl Env {
    /// Asks something else of an agent, by its place among those who act, whose episode has just begun: what a task outside of
    /// this crate does, once it has arranged the world. The agent starts where it stands now.
    ///
    /// `asked`: the instruction, and the distance to the goal, m, where there is a goal to go to; `None`: as the task sets it.
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] for an agent that does not act, and before the first reset, [`WorldError::Config`] for a text that
    /// the sensors of instructions cannot give, or a distance that is none. Nothing has changed then.
    pub fn set_goal(
        &mut self,
        agent: usize,
        asked: Option<(&str, Option<f64>)>,
    ) -> Result<(), WorldError> {
        let own = self.agent(agent)?;
        let tokens = asked
            .map(|(text, _)| own.instruction_tokens(text))
            .transpose()?;
        check_distance(asked.and_then(|(_, distance_m)| distance_m))?;
        let now = self.world.state().agents.get(own.id);
        let now = now.map(|now| Pose::from_position_yaw(now.position, now.yaw_rad));
        let Some(episode) = self.agent_mut(agent)?.episode.as_mut() else {
            let message = "ask: no episode has begun; call reset first";
            return Err(WorldError::InvalidCall(message.to_owned()));
        };
        episode.start = now.unwrap_or(episode.start);
        let mut distance_m = episode.progress.start_distance_m;
        if let (Some((text, way_m)), Some(tokens)) = (asked, tokens) {
            text.clone_into(&mut episode.instruction);
            (episode.tokens, distance_m) = (tokens, way_m);
            episode.goal = EpisodeGoal::default();
        }
        episode.progress = NavigationMetrics::new(episode.start.position, distance_m);
        self.record_start_poses();
        // What was sensed before the world was arranged does not belong to the episode.
        if let Some(own) = self.agents.get_mut(agent) {
            for sensor in &mut own.sensors {
                sensor.forget(&self.world)?;
            }
        }
        Ok(())
    }

    /// Judges the latest step of an agent, by its place among those who act, anew, in place of the task; `distance_m` is the way
    /// to the goal that is left, m, the last known one where it is `None`. Gives back the measures of the episode.
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] for an agent that does not act, and before the first reset, [`WorldError::Config`] for a reward or a
    /// distance that is no number.
    pub fn set_step_result(
        &mut self,
        agent: usize,
        verdict: StepResult,
        distance_m: Option<f64>,
    ) -> Result<NavigationMetrics, WorldError> {
        check_distance(distance_m)?;
        if !verdict.reward.is_finite() {
            return Err(WorldError::Config {
                field: "reward",
                found: verdict.reward.to_string(),
                allowed: "finite numbers".to_owned(),
            });
        }
        let own = self.agent_mut(agent)?;
        let Some(episode) = own.episode.as_mut() else {
            let message = "rule: no episode has begun; call reset first";
            return Err(WorldError::InvalidCall(message.to_owned()));
        };
        episode.progress.distance_m = distance_m.or(episode.progress.distance_m);
        let progress = episode.progress;
        own.apply_step_result(verdict);
        Ok(progress)
    }
}

impl EnvAgent {
    /// The tokens of an instruction; where no sensor gives tokens, words need none.
    pub(crate) fn instruction_tokens(&self, instruction: &str) -> Result<Vec<i32>, WorldError> {
        let specs = self.sensors.iter().map(|sensor| sensor.spec());
        let (mut gives_text, mut gives_tokens) = (false, false);
        for spec in specs {
            gives_text |= spec.dtype == Dtype::Text;
            gives_tokens |= spec.unit == "token";
        }
        let fits = instruction.len() <= MAX_TEXT_LEN
            && !instruction.is_empty()
            && instruction.chars().all(|c| CHARSET.contains(c));
        if gives_text && !fits {
            return Err(WorldError::Config {
                field: "instruction",
                found: format!("{instruction:?}"),
                allowed: format!("1 to {MAX_TEXT_LEN} characters of {CHARSET:?}"),
            });
        }
        match vocabulary::tokenize(instruction) {
            Ok(tokens) => Ok(tokens),
            Err(error) if gives_tokens => Err(error.into()),
            Err(_) => Ok(vec![vocabulary::PAD; vocabulary::LENGTH]),
        }
    }
}

fn check_distance(distance_m: Option<f64>) -> Result<(), WorldError> {
    match distance_m {
        Some(distance_m) if !(0.0..f64::INFINITY).contains(&distance_m) => {
            Err(WorldError::Config {
                field: "distance_m",
                found: distance_m.to_string(),
                allowed: "finite numbers from 0, m".to_owned(),
            })
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::actions::DiscreteAction;
    use crate::engines::Engines;
    use crate::env_config::{EnvConfig, SensorConfig};
    use std::sync::Arc;

    #[test]
    fn what_others_ask_and_rule_counts_and_comes_back() {
        let (house, _) = dwell_houses::open("builtin:apartment").unwrap();
        let sensors = Some(vec![SensorConfig {
            kind: "compass".to_owned(),
            settings: serde_json::Value::Null,
        }]);
        let config = EnvConfig {
            sensors,
            ..EnvConfig::default()
        };
        let mut env = Env::new(Engines::new(Arc::new(house)), &config).unwrap();
        let ruled = StepResult {
            reward: 1.5,
            terminated: true,
            success: true,
        };
        let wait = [Some(DiscreteAction::Wait)];
        assert!(env.set_goal(0, None).is_err() && env.set_step_result(0, ruled, None).is_err());
        env.reset(3).unwrap();
        // There is no sensor of instructions here, so that any words will do.
        env.set_goal(0, Some(("Über die Treppe!", Some(4.0))))
            .unwrap();
        for distance_m in [-1.0, f64::NAN, f64::INFINITY] {
            assert!(env.set_goal(0, Some(("x", Some(distance_m)))).is_err());
            assert!(env.set_step_result(0, ruled, Some(distance_m)).is_err());
        }
        env.step(&[Some(DiscreteAction::MoveForward)]).unwrap();
        let unread = StepResult {
            reward: f64::NAN,
            ..ruled
        };
        assert!(env.set_step_result(0, unread, None).is_err() && env.check_can_step(&wait).is_ok());
        let progress = env.set_step_result(0, ruled, Some(3.0)).unwrap();
        assert_eq!(progress.start_distance_m, Some(4.0));
        assert_eq!(progress.distance_m, Some(3.0));
        assert!(env.check_can_step(&wait).is_err());
        let snapshot = env.snapshot().unwrap();
        env.reset(4).unwrap();
        env.restore(&snapshot).unwrap();
        let episode = env.episode(0).unwrap();
        assert_eq!(episode.instruction, "Über die Treppe!");
        assert_eq!(episode.progress, progress);
        assert!(env.check_can_step(&wait).is_err());
    }
}
