//! The agents of a world, each with a task and sensors, who act at once.

use crate::actions::StepSizes;
use crate::engines::Engines;
use crate::env_agent::EnvAgent;
use crate::env_config::EnvConfig;
use crate::episode::Episode;
use crate::episode_spec::EpisodeSpec;
use crate::error::{WorldError, no_agent};
use crate::sensor_requests::{RenderedImages, SensorRequests};
use crate::world::World;
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentId, Id, IdVec, Pose};
use std::sync::Arc;

/// Time for which things come to rest before an environment's world begins, s. Else each episode's first second would cost ten
/// times what the others do.
const SETTLE_S: f64 = 2.0;

/// A world in which some agents act at once, at one clock; the others stand still. Alone or not, each has a task, sensors and an
/// episode of its own.
///
/// An agent is told by its place among those who act, as [`EnvConfig::agents`] lists them; nothing else depends on that order. An
/// episode that ends before the
/// others leaves its agent where it stands: its actions are not looked at, and it goes on observing.
#[derive(Debug)]
pub struct Env {
    pub(crate) world: World,
    /// Those who act, in the order of actions. Shape (agent,).
    pub(crate) agents: Vec<EnvAgent>,
    pub(crate) requests: SensorRequests,
    pub(crate) results: RenderedImages,
    /// Poses of all agents of the world at the beginning of the episodes. Shape (agent of the world,).
    pub(crate) start_poses: IdVec<AgentId, Pose>,
    pub(crate) seed: u64,
    /// What the episodes state. Shape (agent,), or empty where they state nothing.
    pub(crate) specs: Vec<EpisodeSpec>,
    pub(crate) episode_key: RandomKey,
    /// True while the world is as it was made.
    is_new: bool,
    /// Steps of the episodes.
    pub(crate) steps: u64,
}

impl Env {
    /// Builds world, tasks and sensors over a house.
    ///
    /// # Errors
    /// [`WorldError`] names the setting or the fault of the house.
    pub fn new(engines: Arc<Engines>, config: &EnvConfig) -> Result<Self, WorldError> {
        let agents = config
            .resolved_agents()?
            .iter()
            .map(|role| EnvAgent::new(role, &config.world))
            .collect::<Result<Vec<_>, _>>()?;
        let mut world_config = config.world.clone();
        world_config.settle_s.get_or_insert(SETTLE_S);
        // What `agent/N/camera/fov_deg` reads is what the agent sees with.
        for (number, body) in world_config.agents.iter_mut().enumerate() {
            if let Some(fov_deg) = eye_camera_fov_deg(&agents, AgentId::from_index(number)) {
                body.camera_fov_deg = fov_deg;
            }
        }
        // All tasks look for places on the floor; what fails here fails again there, and is told there.
        let walkers = agents
            .iter()
            .filter_map(|agent| world_config.agents.get(agent.id.index()));
        let shared = engines.clone();
        let grids = || walkers.for_each(|body| drop(shared.nav_grid(body)));
        let (world, ()) = Threads::default().join(|| World::new(engines, &world_config), grids);
        let world = world?;
        let mut requests = SensorRequests::default();
        for sensor in agents.iter().flat_map(|agent| &agent.sensors) {
            sensor.request(&world, &mut requests);
        }
        Ok(Self {
            world,
            agents,
            requests,
            results: RenderedImages::default(),
            start_poses: IdVec::default(),
            seed: 0,
            specs: Vec::new(),
            episode_key: RandomKey::root(0),
            is_new: true,
            steps: 0,
        })
    }

    /// Returns those who act, in the order of actions. Shape (agent,).
    pub fn agents(&self) -> impl ExactSizeIterator<Item = AgentId> + '_ {
        self.agents.iter().map(|agent| agent.id)
    }

    /// Returns how far movement actions go: of each agent that acts its own, of the world's others as of the first that acts.
    pub fn step_sizes(&self) -> IdVec<AgentId, StepSizes> {
        let first = self.agents[0].step_sizes;
        let mut strides = IdVec::filled(first, self.world.state().agents.len());
        for agent in &self.agents {
            if let Some(stride) = strides.get_mut(agent.id) {
                *stride = agent.step_sizes;
            }
        }
        strides
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

    /// Returns the episode of an agent, also one that has ended.
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] for an agent that does not act, and before the first reset.
    pub fn episode(&self, agent: usize) -> Result<&Episode, WorldError> {
        let own = self.agent(agent)?.episode.as_ref();
        let none = || WorldError::InvalidCall("no episode has begun; call reset first".to_owned());
        own.ok_or_else(none)
    }

    pub(crate) fn agent(&self, agent: usize) -> Result<&EnvAgent, WorldError> {
        let found = self.agents.get(agent);
        found.ok_or_else(|| no_agent(agent, self.agents.len()))
    }

    pub(crate) fn agent_mut(&mut self, agent: usize) -> Result<&mut EnvAgent, WorldError> {
        let count = self.agents.len();
        let found = self.agents.get_mut(agent);
        found.ok_or_else(|| no_agent(agent, count))
    }

    /// Returns whether an episode has begun, and was not given up.
    pub fn has_episode(&self) -> bool {
        self.agents.iter().all(|agent| agent.episode.is_some())
    }

    /// Returns how many steps the episodes have had; 0 where none runs.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Starts new episodes; everything random in them comes from `seed`. Of the world's agents the lowest number has first choice of
    /// where to start, and the others keep clear of it.
    ///
    /// # Errors
    /// [`WorldError::TaskNotPlayable`] when the house does not hold what a task needs.
    pub fn reset(&mut self, seed: u64) -> Result<(), WorldError> {
        self.reset_stated(seed, &[])
    }

    /// [`Self::reset`], where the episodes state some of what is drawn else: where they start, what they ask for.
    ///
    /// `specs`: what each agent's episode states, in the order of actions; none at all where nobody's states anything. Shape (agent,).
    ///
    /// # Errors
    /// Those of [`Self::reset`]; [`WorldError::Config`] for a start or goal that the house does not have, and for tasks that draw
    /// everything; [`WorldError::InvalidCall`] for a wrong number of `specs`: then nothing has changed.
    pub fn reset_stated(&mut self, seed: u64, specs: &[EpisodeSpec]) -> Result<(), WorldError> {
        if !specs.is_empty() && specs.len() != self.agents.len() {
            return Err(WorldError::InvalidCall(format!(
                "reset: {} agents act, and the episodes of {} are stated",
                self.agents.len(),
                specs.len()
            )));
        }
        specs.iter().try_for_each(EpisodeSpec::check)?;
        let key = RandomKey::root(seed).child("episode");
        // A failure from here on leaves no episode behind that could go on.
        self.clear_episodes();
        // A copy of the start beside the first one would only take its time and memory.
        if std::mem::take(&mut self.is_new) {
            self.world.reset_fresh(key)?;
        } else {
            self.world.reset(key)?;
        }
        for agent in &mut self.agents {
            agent.task.survey_house(&self.world)?;
        }
        let mut order: Vec<(usize, &mut EnvAgent)> = self.agents.iter_mut().enumerate().collect();
        order.sort_unstable_by_key(|(_, agent)| agent.id);
        let mut begun = Vec::with_capacity(order.len());
        let mut placed = Vec::with_capacity(order.len());
        for (place, agent) in &mut order {
            let own = agent.agent_key(key).child("task");
            let (task, world) = (&mut agent.task, &mut self.world);
            begun.push(match specs.get(*place).filter(|spec| !spec.is_empty()) {
                Some(spec) => task.reset_stated(world, &placed, own, spec)?,
                None => task.reset(world, &placed, own)?,
            });
            placed.push(agent.id);
        }
        for ((_, agent), episode) in order.iter_mut().zip(&begun) {
            for sensor in &mut agent.sensors {
                sensor.begin_episode(&self.world, episode)?;
            }
        }
        for ((_, agent), episode) in order.into_iter().zip(begun) {
            agent.episode = Some(episode);
        }
        (self.seed, self.episode_key) = (seed, key);
        self.specs = specs.to_vec();
        self.record_start_poses();
        Ok(())
    }

    /// Notes where all agents start: those who act where their episodes say, the others where they stand.
    pub(crate) fn record_start_poses(&mut self) {
        let standing = self.world.state().agents.iter();
        self.start_poses = standing
            .map(|agent| Pose::from_position_yaw(agent.position, agent.yaw_rad))
            .collect();
        for agent in &self.agents {
            if let (Some(start), Some(episode)) =
                (self.start_poses.get_mut(agent.id), &agent.episode)
            {
                *start = episode.start;
            }
        }
    }

    /// [`Self::reset`], with the ears open that the sensors need, as a [`Batch`](crate::Batch) begins an episode.
    ///
    /// # Errors
    /// Those of [`Self::reset`], [`WorldError::Acoustics`] for a source that cannot be simulated.
    pub fn reset_with_listeners(&mut self, seed: u64) -> Result<(), WorldError> {
        self.reset_stated_with_listeners(seed, &[])
    }

    /// [`Self::reset_stated`], with the ears open that the sensors need.
    ///
    /// # Errors
    /// Those of [`Self::reset_stated`], [`WorldError::Acoustics`] for a source that cannot be simulated.
    pub fn reset_stated_with_listeners(
        &mut self,
        seed: u64,
        specs: &[EpisodeSpec],
    ) -> Result<(), WorldError> {
        self.reset_stated(seed, specs)?;
        self.enable_listeners()
    }

    /// Ends the episodes: what happens to the world from here on belongs to none.
    pub(crate) fn clear_episodes(&mut self) {
        self.agents.iter_mut().for_each(EnvAgent::clear_episode);
        self.steps = 0;
    }

    /// Opens the ears that the sensors ask for, where they are not open yet.
    pub(crate) fn enable_listeners(&mut self) -> Result<(), WorldError> {
        self.world.enable_receivers(&self.requests.listeners)
    }
}

pub(crate) fn no_episode(call: &str) -> WorldError {
    WorldError::InvalidCall(format!("{call}: no episode has begun; call reset first"))
}

/// The field of view of an agent's eyes, degrees: that of the first camera with one, of its own sensors or else of the others'.
fn eye_camera_fov_deg(agents: &[EnvAgent], whose: AgentId) -> Option<f32> {
    let (own, others): (Vec<_>, Vec<_>) = agents.iter().partition(|agent| agent.id == whose);
    let sensors = own.iter().chain(&others).flat_map(|agent| &agent.sensors);
    let mut eyes = sensors.filter_map(|sensor| sensor.camera());
    eyes.find_map(|eye| eye.fov_deg.filter(|_| eye.agent == whose))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Batch;
    use crate::actions::DiscreteAction;
    use crate::config::WorldConfig;
    use crate::env_config::SensorConfig;
    use crate::episode::StepResult;
    use crate::tasks::{ExecutedAction, Task};
    use dwell_scene::parallel::Threads;

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
        env.step(&[Some(DiscreteAction::TurnLeft)]).unwrap();
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
            env.reset_with_listeners(5).unwrap();
            let walk = [DiscreteAction::MoveForward, DiscreteAction::TurnLeft];
            walk.map(|action| {
                env.step(&[Some(action)]).unwrap();
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

    /// A task that starts nothing.
    #[derive(Debug)]
    struct RefusingTask;

    impl Task for RefusingTask {
        fn settings(&self) -> serde_json::Value {
            serde_json::Value::Null
        }

        fn reset(
            &mut self,
            world: &mut World,
            _: &[AgentId],
            _: RandomKey,
        ) -> Result<Episode, WorldError> {
            Err(WorldError::TaskNotPlayable {
                task: "Refusing",
                house: world.house().name.clone(),
                why: "it always does".to_owned(),
            })
        }

        fn judge(&mut self, _: &World, _: &mut Episode, _: &ExecutedAction<'_>) -> StepResult {
            StepResult::default()
        }

        fn expert(&mut self, _: &mut World, _: &Episode) -> DiscreteAction {
            DiscreteAction::Stop
        }
    }

    #[test]
    fn a_reset_that_fails_leaves_no_episode_that_could_go_on() {
        let mut env = env();
        env.reset(1).unwrap();
        env.agents[0].task = Box::new(RefusingTask);
        assert!(matches!(
            env.reset(2),
            Err(WorldError::TaskNotPlayable { .. })
        ));
        assert!(env.episode(0).is_err());
        let error = env
            .step(&[Some(DiscreteAction::Wait)])
            .unwrap_err()
            .to_string();
        assert_eq!(error, "step: no episode has begun; call reset first");
    }

    #[test]
    fn an_environment_of_a_batch_is_replaced_with_its_episode() {
        let mut batch = Batch::new(vec![env(), env()], Threads::ONE).unwrap();
        batch.reset(&[Some(1), Some(2)]).unwrap();
        let mut other = env();
        other.reset_with_listeners(7).unwrap();
        let hash = other.world.hash();
        let before = batch.replace_env(1, other).unwrap();
        assert_eq!(before.seed, 2);
        assert_eq!(batch.envs()[1].world.hash(), hash);
        let forward = Some(DiscreteAction::MoveForward);
        batch.step(&[forward, forward]).unwrap();
        let blind = EnvConfig {
            sensors: Some(Vec::new()),
            ..EnvConfig::default()
        };
        let blind = Env::new(batch.envs()[0].world.engines().clone(), &blind).unwrap();
        assert!(matches!(
            batch.replace_env(0, blind),
            Err(WorldError::InvalidCall(_))
        ));
        assert!(matches!(
            batch.replace_env(2, before),
            Err(WorldError::InvalidCall(_))
        ));
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
            Err(WorldError::InvalidCall(_))
        ));
        assert_eq!(batch.envs()[0].world().hash(), before);
        batch.step(&[forward, None]).unwrap();
        assert_ne!(batch.envs()[0].world().hash(), before);
    }
}
