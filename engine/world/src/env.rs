//! One agent's environment: a world, a task and sensors, stepped by discrete actions.

use crate::actions::{DiscreteAction, StepSizes};
use crate::camera_capture::PictureRequest;
use crate::config::WorldConfig;
use crate::engines::Engines;
use crate::episode::{Episode, StepInfo};
use crate::error::WorldError;
use crate::sensor_requests::{Requests, Results};
use crate::sensors::{self, ObservationBuffer, Sensor, SensorContext, SensorSetup, SensorSpec};
use crate::tasks::{self, Task, TaskKind, TaskSetup};
use crate::world::World;
use dwell_render::{Camera, Preset};
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentId, Id};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Time for which things come to rest before an environment's world begins, s. Else each episode's first second would cost ten
/// times what the others do.
const SETTLE_S: f64 = 2.0;

/// The settings of an environment. Every field has a default; unknown fields are refused.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct EnvConfig {
    /// The task's name.
    pub task: String,
    /// The task's settings.
    pub task_settings: serde_json::Value,
    /// Rates, laws, parameters.
    pub world: WorldConfig,
    /// The agent whom the task is about, and who acts; default 0.
    pub agent: u32,
    /// Step sizes of movement actions.
    pub stride: StepSizes,
    /// Sensors by name with their settings; `None`: the task's own choice.
    pub sensors: Option<Vec<SensorConfig>>,
}

/// A requested sensor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SensorConfig {
    /// The kind's name.
    pub kind: String,
    /// Its settings.
    #[serde(default)]
    pub settings: serde_json::Value,
}

impl Default for EnvConfig {
    fn default() -> Self {
        Self {
            task: "InstructionFollowing".to_owned(),
            task_settings: serde_json::Value::Null,
            world: WorldConfig::default(),
            agent: 0,
            stride: StepSizes::default(),
            sensors: None,
        }
    }
}

/// An environment about one of the agents of a world; the others stand still.
#[derive(Debug)]
pub struct Env {
    pub(crate) world: World,
    task: Box<dyn Task>,
    pub(crate) kind: &'static TaskKind,
    /// The agent that the task is about.
    pub(crate) agent: AgentId,
    stride: StepSizes,
    pub(crate) sensors: Vec<Box<dyn Sensor>>,
    requests: Requests,
    pub(crate) results: Results,
    pub(crate) episode: Option<Episode>,
    pub(crate) seed: u64,
    episode_key: RandomKey,
    /// True while the world is as it was made.
    is_new: bool,
    /// Steps of the episode.
    pub(crate) steps: u64,
    pub(crate) done: bool,
}

impl Env {
    /// Builds world, task and sensors over a house.
    ///
    /// # Errors
    /// [`WorldError`] names the setting or the fault of the house.
    pub fn new(engines: Arc<Engines>, config: &EnvConfig) -> Result<Self, WorldError> {
        let kind = tasks::find(&config.task)?;
        config.stride.check()?;
        let agent = AgentId(config.agent);
        if agent.index() >= config.world.agents.len().max(1) {
            let count = config.world.agents.len();
            return Err(WorldError::Config {
                field: "agent",
                found: agent.0.to_string(),
                allowed: format!("below the number of agents, {count}"),
            });
        }
        let setup = TaskSetup {
            agent,
            stride: config.stride,
        };
        let task = (kind.build)(&config.task_settings, setup)?;
        let site = SensorSetup {
            config: &config.world,
            agent,
        };
        let defaults: Vec<SensorConfig> = kind
            .sensors
            .iter()
            .map(|name| SensorConfig {
                kind: (*name).to_owned(),
                settings: serde_json::Value::Null,
            })
            .collect();
        let wanted = config.sensors.as_ref().unwrap_or(&defaults);
        let sensors: Vec<_> = wanted
            .iter()
            .map(|sensor| sensors::build(&sensor.kind, &sensor.settings, site))
            .collect::<Result<_, _>>()?;
        for (k, sensor) in sensors.iter().enumerate() {
            let name = sensor.spec().name;
            if sensors[..k].iter().any(|other| other.spec().name == name) {
                let allowed = "each sensor once".to_owned();
                return Err(WorldError::Config {
                    field: "sensors",
                    found: format!("{name:?} twice"),
                    allowed,
                });
            }
        }
        let mut world_config = config.world.clone();
        world_config.settle_s.get_or_insert(SETTLE_S);
        // `agent/N/camera/fov_deg` reads the value of the agent's first camera with a field of view.
        for (k, body) in world_config.agents.iter_mut().enumerate() {
            let eyes = sensors.iter().filter_map(|sensor| sensor.eye());
            let mut own = eyes.filter(|eye| eye.agent.index() == k);
            if let Some(fov_deg) = own.find_map(|eye| eye.fov_deg) {
                body.camera_fov_deg = fov_deg;
            }
        }
        let world = World::new(engines, &world_config)?;
        let mut requests = Requests::default();
        for sensor in &sensors {
            sensor.plan(&world, &mut requests);
        }
        Ok(Self {
            world,
            task,
            kind,
            agent,
            stride: config.stride,
            sensors,
            requests,
            results: Results::default(),
            episode: None,
            seed: 0,
            episode_key: RandomKey::root(0),
            is_new: true,
            steps: 0,
            done: false,
        })
    }

    /// The task's kind.
    pub fn kind(&self) -> &'static TaskKind {
        self.kind
    }

    /// Returns the step sizes of movement actions.
    pub fn stride(&self) -> &StepSizes {
        &self.stride
    }

    /// Returns the specifications of the sensors, in order.
    pub fn specs(&self) -> Vec<SensorSpec> {
        self.sensors.iter().map(|sensor| sensor.spec()).collect()
    }

    /// The world.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The world, for changes between episodes.
    pub fn world_mut(&mut self) -> &mut World {
        self.is_new = false;
        &mut self.world
    }

    /// The episode that runs, if one does.
    pub fn episode(&self) -> Option<&Episode> {
        self.episode.as_ref()
    }

    /// Returns the number of steps of the episode; 0 where none runs.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Starts a new episode; everything random in it comes from `seed`.
    ///
    /// # Errors
    /// [`WorldError::Unplayable`] when the house does not hold what the task needs.
    pub fn reset(&mut self, seed: u64) -> Result<&Episode, WorldError> {
        let key = RandomKey::root(seed).child("episode");
        // A failure from here on leaves no episode behind that could go on.
        self.abandon_episode();
        // A copy of the start beside the first one would only take its time and memory.
        if std::mem::take(&mut self.is_new) {
            self.world.begin(key);
        } else {
            self.world.reset(key)?;
        }
        let episode = self.task.reset(&mut self.world, key.child("task"))?;
        (self.seed, self.episode_key) = (seed, key);
        Ok(self.episode.insert(episode))
    }

    /// [`Self::reset`], with the ears open that the sensors need, as a [`Batch`](crate::Batch) begins an episode.
    ///
    /// # Errors
    /// Those of [`Self::reset`], [`WorldError::Acoustics`] for a source that cannot be simulated.
    pub fn begin(&mut self, seed: u64) -> Result<(), WorldError> {
        self.reset(seed)?;
        self.listen()
    }

    /// Makes what the first pictures in a house wait for, such as textures and the light of the house, by small pictures of
    /// all views.
    ///
    /// # Errors
    /// [`WorldError::Render`] for a graphics adapter that fails.
    pub fn warm_up(&self, threads: Threads) -> Result<(), WorldError> {
        for view in &self.requests.views {
            let own = view.eye.request(self.world.state());
            let small = PictureRequest {
                camera: Camera::from_fov(8, 8, 90.0)?,
                preset: match own.preset {
                    Preset::Flat => Preset::Flat,
                    Preset::Lit | Preset::Full => Preset::Lit,
                },
                ..own
            };
            self.world.picture(&small, view.channels, threads)?;
        }
        Ok(())
    }

    /// Ends the episode: later changes of the world belong to none.
    pub(crate) fn abandon_episode(&mut self) {
        self.episode = None;
        self.steps = 0;
        self.done = false;
    }

    /// Returns whether a step can be made.
    ///
    /// # Errors
    /// [`WorldError::Usage`] before the first reset and after the end of an episode.
    pub fn check_can_step(&self) -> Result<(), WorldError> {
        let what = match &self.episode {
            Some(_) if self.done => "the episode has ended",
            Some(_) => return Ok(()),
            None => "no episode has begun",
        };
        Err(WorldError::Usage(format!("step: {what}; call reset first")))
    }

    /// Number of samples of sound in the latest observation that were clipped.
    pub fn clipped(&self) -> u64 {
        self.sensors.iter().map(|sensor| sensor.clipped()).sum()
    }

    /// Makes one control step with `action`, without observing: a [`Batch`](crate::Batch) observes afterwards.
    ///
    /// # Errors
    /// [`WorldError::Usage`] before the first reset and after the end of an episode.
    pub fn step(&mut self, action: DiscreteAction) -> Result<StepInfo, WorldError> {
        self.check_can_step()?;
        let Some(episode) = self.episode.as_mut() else {
            return Err(WorldError::Usage("step: no episode has begun".to_owned()));
        };
        let agent = self.agent;
        let outcome = self.world.act_discrete(agent, action, &self.stride)?;
        self.steps += 1;
        let verdict = self.task.judge(&self.world, episode, action);
        self.done = verdict.terminated;
        let collision = self
            .world
            .state()
            .agents
            .get(agent)
            .is_some_and(|agent| agent.collided);
        Ok(StepInfo {
            agent,
            verdict,
            action_success: outcome.success,
            action_error: if outcome.success {
                String::new()
            } else {
                outcome.sentence
            },
            progress: episode.progress,
            collision,
        })
    }

    /// Returns the scripted expert's action now.
    ///
    /// # Errors
    /// [`WorldError::Usage`] before the first reset.
    pub fn expert_action(&mut self) -> Result<DiscreteAction, WorldError> {
        let Some(episode) = &self.episode else {
            return Err(WorldError::Usage(
                "expert: no episode has begun; call reset first".to_owned(),
            ));
        };
        Ok(self.task.expert(&mut self.world, episode))
    }

    /// Opens the ears that the sensors need, where they are not open yet.
    pub(crate) fn listen(&mut self) -> Result<(), WorldError> {
        self.world.listen(&self.requests.ears)
    }

    /// Returns the sensors' requests to the engines.
    pub(crate) fn requests(&self) -> &Requests {
        &self.requests
    }

    /// The signals that will be heard once an agent listens, and their rate; none where no sensor listens.
    pub(crate) fn signals(&self) -> (Vec<String>, u32) {
        if self.requests.ears.is_empty() {
            return (Vec::new(), 0);
        }
        self.world.signals()
    }

    /// The world, and the buffers for its pictures, at the same time.
    pub(crate) fn picture_work(&mut self) -> (&World, &Requests, &mut Results) {
        self.results.prepare(&self.requests, &self.world);
        (&self.world, &self.requests, &mut self.results)
    }

    /// Writes sensor `index`'s observation.
    ///
    /// # Errors
    /// [`WorldError::Usage`] for a wrong index or length, or before the first reset.
    pub(crate) fn observe(
        &self,
        index: usize,
        out: ObservationBuffer<'_>,
    ) -> Result<(), WorldError> {
        let (Some(sensor), Some(episode)) = (self.sensors.get(index), &self.episode) else {
            return Err(WorldError::Usage(format!(
                "observe: no sensor {index}, or no episode has begun"
            )));
        };
        let spec = sensor.spec();
        let length = match &out {
            ObservationBuffer::Uint8(out) => out.len(),
            ObservationBuffer::Float32(out) => out.len(),
            ObservationBuffer::Int32(out) => out.len(),
            ObservationBuffer::Text(_) => spec.len(),
        };
        if length != spec.len() {
            return Err(WorldError::Usage(format!(
                "observe: {} needs a buffer of {} elements, shape {:?}; found {length}",
                spec.name,
                spec.len(),
                spec.shape
            )));
        }
        let key = self
            .episode_key
            .child("sensor")
            .child(spec.name.as_str())
            .child(self.world.state().step);
        sensor.finish(
            SensorContext {
                world: &self.world,
                episode,
                results: &self.results,
                key,
            },
            out,
        );
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Batch;
    use crate::episode::Verdict;

    fn env() -> Env {
        let (house, _) = dwell_houses::open("builtin:apartment").unwrap();
        let sensors = Some(vec![SensorConfig {
            kind: "compass".to_owned(),
            settings: serde_json::Value::Null,
        }]);
        let config = EnvConfig {
            sensors,
            ..EnvConfig::default()
        };
        Env::new(Engines::new(Arc::new(house)), &config).unwrap()
    }

    /// Nothing has yet to fall in an episode's first moment, in any episode, unless the config says so.
    #[test]
    fn episodes_begin_when_things_have_come_to_rest() {
        let mut env = env();
        assert_eq!(env.world.config().settle_s, Some(SETTLE_S));
        let awake = env.world.physics.awake_count();
        assert!(awake < 20, "{awake}");
        assert_eq!(env.world.state().time_s, 0.0);
        let start = env.world.state().part_pose.clone();
        env.reset(5).unwrap();
        env.step(DiscreteAction::TurnLeft).unwrap();
        env.reset(6).unwrap();
        assert_eq!(env.world.state().part_pose, start);
        let (house, _) = dwell_houses::open("builtin:apartment").unwrap();
        let config = EnvConfig {
            sensors: Some(Vec::new()),
            world: WorldConfig {
                settle_s: Some(0.0),
                ..WorldConfig::default()
            },
            ..EnvConfig::default()
        };
        let falling = Env::new(Engines::new(Arc::new(house)), &config).unwrap();
        assert!(falling.world.physics.awake_count() > 100);
    }

    /// The first episode of a world starts without a reset.
    #[test]
    fn the_first_episode_is_that_of_any_later_reset() {
        let play = |env: &mut Env| {
            env.begin(5).unwrap();
            let walk = [DiscreteAction::MoveForward, DiscreteAction::TurnLeft];
            walk.map(|action| {
                env.step(action).unwrap();
                env.world.hash()
            })
        };
        let mut env = env();
        let first = play(&mut env);
        assert_eq!(env.steps(), 2);
        assert_eq!(play(&mut env), first);
        let mut changed = self::env();
        changed
            .world_mut()
            .place_agent(AgentId(0), glam::Vec3::ONE, 1.0)
            .unwrap();
        assert_eq!(play(&mut changed), first);
    }

    /// The second agent acts, senses and is judged as the first does where the first alone plays; the other stands still.
    #[test]
    fn an_environment_is_about_the_agent_that_it_names() {
        let sensors = ["gps", "compass", "gyro", "wheel_odometry"];
        let env = |agent: u32| {
            let (house, _) = dwell_houses::open("builtin:apartment").unwrap();
            let named = |kind: &str, other: u32| SensorConfig {
                kind: kind.to_owned(),
                settings: match other {
                    0 => serde_json::Value::Null,
                    _ => serde_json::json!({"name": format!("other_{kind}"), "agent": 1 - agent}),
                },
            };
            let all = sensors.map(|kind| [named(kind, 0), named(kind, 1)]);
            let config = EnvConfig {
                task: "Free".to_owned(),
                task_settings: serde_json::json!({"start": "anywhere"}),
                world: WorldConfig {
                    agents: vec![dwell_scene::AgentBody::default(); 2],
                    ..WorldConfig::default()
                },
                agent,
                sensors: Some(all.into_iter().flatten().collect()),
                ..EnvConfig::default()
            };
            Env::new(Engines::new(Arc::new(house)), &config).unwrap()
        };
        for agent in [AgentId(0), AgentId(1)] {
            let mut env = env(agent.0);
            env.reset(3).unwrap();
            let other = AgentId(1 - agent.0);
            let before = env.world().state().agents[other].position;
            for action in [DiscreteAction::TurnLeft, DiscreteAction::MoveForward] {
                assert_eq!(env.step(action).unwrap().agent, agent);
            }
            let state = env.world().state();
            assert!((state.agents[other].position - before).length() < 1e-3);
            let observed = |name: &str| {
                let specs = env.specs();
                let index = specs.iter().position(|spec| spec.name == name).unwrap();
                let mut out = vec![0.0; specs[index].len()];
                env.observe(index, ObservationBuffer::Float32(&mut out))
                    .unwrap();
                out
            };
            assert!((observed("compass")[0] - 9_f32.to_radians()).abs() < 1e-3);
            assert!(observed("other_compass")[0].abs() < 1e-6);
            assert!(observed("other_gps").iter().all(|way| way.abs() < 1e-3));
        }
        let none = EnvConfig {
            agent: 1,
            ..EnvConfig::default()
        };
        let engines = env(0).world.engines().clone();
        let told = Env::new(engines, &none).unwrap_err().to_string();
        assert_eq!(told, "agent is 1; allowed is below the number of agents, 1");
    }

    /// A task that starts nothing.
    #[derive(Debug)]
    struct RefusingTask;

    impl Task for RefusingTask {
        fn reset(&mut self, world: &mut World, _: RandomKey) -> Result<Episode, WorldError> {
            Err(WorldError::Unplayable {
                task: "Refusing",
                house: world.house().name.clone(),
                why: "it always does".to_owned(),
            })
        }

        fn judge(&mut self, _: &World, _: &mut Episode, _: DiscreteAction) -> Verdict {
            Verdict::default()
        }

        fn expert(&mut self, _: &mut World, _: &Episode) -> DiscreteAction {
            DiscreteAction::Stop
        }
    }

    #[test]
    fn a_reset_that_fails_leaves_no_episode_that_could_go_on() {
        let mut env = env();
        env.reset(1).unwrap();
        env.task = Box::new(RefusingTask);
        assert!(matches!(env.reset(2), Err(WorldError::Unplayable { .. })));
        assert!(env.episode().is_none());
        let error = env.step(DiscreteAction::Wait).unwrap_err().to_string();
        assert_eq!(error, "step: no episode has begun; call reset first");
    }

    #[test]
    fn an_environment_of_a_batch_is_replaced_with_its_episode() {
        let mut batch = Batch::new(vec![env(), env()], Threads::ONE).unwrap();
        batch.reset(&[Some(1), Some(2)]).unwrap();
        let mut other = env();
        other.begin(7).unwrap();
        let hash = other.world.hash();
        let before = batch.put(1, other).unwrap();
        assert_eq!(before.seed, 2);
        assert_eq!(batch.envs()[1].world.hash(), hash);
        let forward = Some(DiscreteAction::MoveForward);
        batch.step(&[forward, forward]).unwrap();
        let blind = EnvConfig {
            sensors: Some(Vec::new()),
            ..EnvConfig::default()
        };
        let blind = Env::new(batch.envs()[0].world.engines().clone(), &blind).unwrap();
        assert!(matches!(batch.put(0, blind), Err(WorldError::Usage(_))));
        assert!(matches!(batch.put(2, before), Err(WorldError::Usage(_))));
    }

    #[test]
    fn a_batch_steps_all_or_none() {
        let mut batch = Batch::new(vec![env(), env()], Threads::ONE).unwrap();
        batch.reset(&[Some(1), Some(2)]).unwrap();
        batch.step(&[None, Some(DiscreteAction::Stop)]).unwrap();
        let before = batch.envs()[0].world().hash();
        let forward = Some(DiscreteAction::MoveForward);
        assert!(matches!(
            batch.step(&[forward, forward]),
            Err(WorldError::Usage(_))
        ));
        assert_eq!(batch.envs()[0].world().hash(), before);
        batch.step(&[forward, None]).unwrap();
        assert_ne!(batch.envs()[0].world().hash(), before);
    }
}
