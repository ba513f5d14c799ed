//! A task without a goal: to explore, to collect data, and to build tasks upon.
//!
//! The agent starts where the house says; without that, or where the settings ask for it, anywhere on the largest piece of
//! floor that it can walk, looking anywhere. Every reward is 0, and an episode ends with `stop`, without success.

use super::standing_room::sample_start;
use super::{ExecutedAction, Task, TaskKind, TaskSetup, random_yaw_rad};
use crate::actions::DiscreteAction;
use crate::episode::{Episode, EpisodeGoal, StepResult};
use crate::error::WorldError;
use crate::metrics::NavigationMetrics;
use crate::schema;
use crate::world::World;
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentBody, AgentId, Id, Pose};
use dwell_semantics::vocabulary;
use glam::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

const NAME: &str = "Free";
/// The text that the sensors of instructions give.
const INSTRUCTION: &str = "Explore.";

pub(super) const KIND: TaskKind = TaskKind {
    name: NAME,
    version: 0,
    about: "Nothing is asked; explore, or build a task of your own upon it.",
    has_goal: false,
    min_agents: 1,
    goal_parts: &[],
    max_steps: 1000,
    actions: DiscreteAction::DEFAULT,
    sensors: &["rgb", "depth", "semantic", "audio"],
    measures: &[],
    settings: schema::fields_of::<FreeSettings>,
    build,
};

/// The task's settings.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
struct FreeSettings {
    /// Start of an episode: `"house"` (default), where the house has the agent's start, if it says so; `"anywhere"`,
    /// another place each time.
    start: StartChoice,
}

/// The start of an episode.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum StartChoice {
    /// At the house's start of the agent, where it has one; else anywhere.
    #[default]
    House,
    /// Anywhere, another place each time.
    Anywhere,
}

/// Largest distance of the walkable place from the house's start, m.
const NEAR_M: f32 = 0.3;

fn build(value: &serde_json::Value, setup: TaskSetup) -> Result<Box<dyn Task>, WorldError> {
    let settings: FreeSettings = crate::parse_settings::parse_task_settings(value)?;
    Ok(Box::new(FreeTask { settings, setup }))
}

#[derive(Debug)]
struct FreeTask {
    settings: FreeSettings,
    setup: TaskSetup,
}

impl FreeTask {
    /// Returns the start of an episode: the position, and the heading, rad.
    fn choose_start(
        &self,
        world: &World,
        body: &AgentBody,
        (placed, key): (&[AgentId], RandomKey),
    ) -> Result<(Vec3, f32), WorldError> {
        let unplayable = |why: String| WorldError::TaskNotPlayable {
            task: NAME,
            house: world.house().name.clone(),
            why,
        };
        let grid = world.engines().nav_grid(body)?;
        let of_house = world.house().agent_starts.get(self.setup.agent.index());
        if let Some(start) = of_house.filter(|_| self.settings.start == StartChoice::House) {
            if grid.nearest(start.position, NEAR_M).is_none() {
                let at = start.position.to_array();
                return Err(unplayable(format!(
                    "nobody of the agent's size can stand at the house's start, {at:?} m"
                )));
            }
            return Ok((start.position, start.yaw_rad));
        }
        let start = sample_start(world, placed, (&grid, body, None), key.child("start"));
        let Some(cell) = start else {
            let why = "nobody of the agent's size can stand anywhere";
            return Err(unplayable(why.to_owned()));
        };
        Ok((grid.position(cell), random_yaw_rad(key)))
    }
}

impl Task for FreeTask {
    fn settings(&self) -> serde_json::Value {
        serde_json::json!(self.settings)
    }

    fn reset(
        &mut self,
        world: &mut World,
        placed: &[AgentId],
        key: RandomKey,
    ) -> Result<Episode, WorldError> {
        let agent = self.setup.agent;
        let body = self.setup.body(world, NAME)?;
        let (position, yaw_rad) = self.choose_start(world, &body, (placed, key))?;
        world.place_agent(agent, position, yaw_rad)?;
        Ok(Episode {
            agent,
            instruction: INSTRUCTION.to_owned(),
            tokens: vocabulary::tokenize(INSTRUCTION)?,
            start: Pose::from_position_yaw(position, yaw_rad),
            progress: NavigationMetrics::new(position, None),
            goal: EpisodeGoal::default(),
        })
    }

    fn judge(
        &mut self,
        world: &World,
        episode: &mut Episode,
        played: &ExecutedAction<'_>,
    ) -> StepResult {
        if let Some(agent) = world.state().agents.get(self.setup.agent) {
            let progress = &mut episode.progress;
            progress.advance(agent.position, None, agent.collided);
        }
        StepResult {
            terminated: played.is_stop(),
            ..StepResult::default()
        }
    }

    fn expert(&mut self, _: &mut World, _: &Episode) -> DiscreteAction {
        DiscreteAction::Stop
    }
}
