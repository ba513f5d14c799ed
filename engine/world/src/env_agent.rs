//! One of the agents that act in an environment.

use crate::actions::{ActionMode, ActionTarget, AgentAction, HandTarget, StepAction, StepSizes};
use crate::config::WorldConfig;
use crate::env_config::{ResolvedAgentConfig, SensorConfig};
use crate::episode::{Episode, StepInfo, StepResult};
use crate::error::WorldError;
use crate::sensors::{self, Sensor, SensorSetup};
use crate::tasks::{self, ExecutedAction, Task, TaskKind, TaskSetup};
use crate::world::World;
use dwell_physics::{ActionOutcome, Target};
use dwell_render::Camera;
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentId, Id, Pose};
use glam::Vec2;
use serde_json::Value;

/// The task, sensors and episode of an agent.
#[derive(Debug)]
pub(crate) struct EnvAgent {
    pub(crate) id: AgentId,
    pub(crate) kind: &'static TaskKind,
    pub(crate) task: Box<dyn Task>,
    pub(crate) step_sizes: StepSizes,
    pub(crate) action_mode: ActionMode,
    pub(crate) sensors: Vec<Box<dyn Sensor>>,
    pub(crate) episode: Option<Episode>,
    /// Whether it acts as its task's expert says.
    pub(crate) scripted: bool,
    /// True once its episode has ended.
    pub(crate) done: bool,
    /// True if the task was fulfilled in the latest step.
    pub(crate) success: bool,
}

/// Refuses a sensor of goals that a task does not have.
fn refuse_goal_sensor(name: &str, task: &TaskKind) -> Result<(), WorldError> {
    let part = sensors::find(name).and_then(|sensor| sensor.goal_part);
    if part.is_none_or(|part| task.goal_parts.contains(&part)) {
        return Ok(());
    }
    let of_tasks = tasks::all().iter();
    let having = of_tasks.filter(|task| part.is_some_and(|part| task.goal_parts.contains(&part)));
    let names: Vec<&str> = having.map(|task| task.name).collect();
    Err(WorldError::Config {
        field: "sensors",
        found: format!("{name:?}"),
        allowed: format!(
            "that with the task {} alone, not with {}",
            names.join(" or "),
            task.name
        ),
    })
}

impl EnvAgent {
    /// Builds task and sensors.
    ///
    /// # Errors
    /// [`WorldError`] names the setting.
    pub(crate) fn new(
        role: &ResolvedAgentConfig<'_>,
        config: &WorldConfig,
    ) -> Result<Self, WorldError> {
        let kind = tasks::find(role.task)?;
        let setup = TaskSetup {
            agent: role.agent,
            stride: role.stride,
            actions: role.actions,
        };
        let task = (kind.build)(role.task_settings, setup)?;
        let site = SensorSetup {
            config,
            agent: role.agent,
        };
        let own_choice = |name: &&str| SensorConfig {
            kind: (*name).to_owned(),
            settings: Value::Null,
        };
        let wanted = match role.sensors {
            Some(wanted) => wanted.to_vec(),
            None => kind.sensors.iter().map(own_choice).collect(),
        };
        for sensor in &wanted {
            refuse_goal_sensor(&sensor.kind, kind)?;
        }
        let sensors: Vec<_> = wanted
            .iter()
            .map(|sensor| sensors::build(&sensor.kind, &sensor.settings, site))
            .collect::<Result<_, _>>()?;
        for (k, sensor) in sensors.iter().enumerate() {
            let name = sensor.spec().name;
            if sensors[..k].iter().any(|other| other.spec().name == name) {
                return Err(WorldError::Config {
                    field: "sensors",
                    found: format!("{name:?} twice"),
                    allowed: "each name once: give one of them another \"name\"".to_owned(),
                });
            }
        }
        Ok(Self {
            id: role.agent,
            kind,
            task,
            step_sizes: role.stride,
            action_mode: role.action_mode,
            sensors,
            episode: None,
            scripted: role.scripted,
            done: false,
            success: false,
        })
    }

    /// The agent's own streams below a key of its environment.
    pub(crate) fn agent_key(&self, key: RandomKey) -> RandomKey {
        match self.id.index() {
            // Agent 0 has those of environments in which it is alone.
            0 => key,
            number => key.child("agent").child(number as u64),
        }
    }

    /// Forgets the episode.
    pub(crate) fn clear_episode(&mut self) {
        self.episode = None;
        (self.done, self.success) = (false, false);
    }

    /// Returns its action in a step as the world takes it.
    pub(crate) fn world_action(&self, world: &World, step: &StepAction) -> AgentAction {
        let target = match step.target {
            ActionTarget::Gaze => {
                let own = self.task.hand_target(world, step.action);
                own.unwrap_or(HandTarget::Gaze)
            }
            ActionTarget::Entity(id) => HandTarget::At(Target::Entity(id)),
            ActionTarget::Picture(place) => self.picture_target(world, place),
        };
        AgentAction {
            agent: self.id,
            action: step.action,
            velocity: step.velocity,
            target,
            step_sizes: self.step_sizes,
        }
    }

    /// Returns the ray through a place of its first camera's picture.
    fn picture_target(&self, world: &World, [across, down]: [f32; 2]) -> HandTarget {
        let state = world.state();
        let eye = self.sensors.iter().find_map(|sensor| sensor.camera());
        let camera = match eye {
            Some(eye) => Some(eye.camera_in(state)),
            None => Camera::from_fov(1, 1, state.camera_fov_deg(self.id)).ok(),
        };
        let mount = eye.map_or(Pose::IDENTITY, |eye| eye.eye_from_camera);
        let (Some(camera), Some(body)) = (camera, state.agents.get(self.id)) else {
            return HandTarget::Nothing;
        };
        let (width, height) = (camera.width() as f32, camera.height() as f32);
        let place = Vec2::new(across * width, down * height);
        World::ray_target(&camera, body.world_from_eye() * mount, place)
            .map_or(HandTarget::Nothing, HandTarget::At)
    }

    /// Judges the step that has just been made with `action`; `outcome`: what became of it.
    pub(crate) fn evaluate_step(
        &mut self,
        world: &World,
        action: &StepAction,
        outcome: ActionOutcome,
    ) -> Option<StepInfo> {
        let episode = self.episode.as_mut()?;
        let played = ExecutedAction {
            action,
            outcome: &outcome,
        };
        let verdict = self.task.judge(world, episode, &played);
        let agent = world.state().agents.get(self.id);
        let collision = agent.is_some_and(|agent| agent.collided);
        let progress = episode.progress;
        self.apply_step_result(verdict);
        Some(StepInfo {
            agent: self.id,
            result: verdict,
            action_success: outcome.success,
            action_error: if outcome.success {
                String::new()
            } else {
                outcome.sentence
            },
            progress,
            collision,
            reply: self
                .task
                .reply()
                .map_or_else(String::new, |reply| reply.text.clone()),
            speaks: world.is_speaking(self.id),
            measures: self.task.measures(),
        })
    }

    /// Returns whether it waits for actions of a caller: it is not scripted, and its episode goes on.
    pub(crate) fn takes_actions(&self) -> bool {
        !self.scripted && !self.done
    }

    /// Takes over how a step is judged.
    pub(crate) fn apply_step_result(&mut self, verdict: StepResult) {
        (self.done, self.success) = (verdict.terminated, verdict.success);
    }

    /// Returns the report of a step for an agent whose episode had ended before.
    pub(crate) fn step_info_after_end(&self, world: &World) -> Option<StepInfo> {
        Some(StepInfo {
            agent: self.id,
            result: StepResult {
                reward: 0.0,
                terminated: true,
                success: self.success,
            },
            action_success: false,
            action_error: "Its episode has ended.".to_owned(),
            progress: self.episode.as_ref()?.progress,
            collision: false,
            reply: String::new(),
            speaks: world.is_speaking(self.id),
            measures: self.task.measures(),
        })
    }
}
