//! A running world: state, physics, rays and sound over a shared house.

use crate::config::WorldConfig;
use crate::engines::Engines;
use crate::error::WorldError;
use crate::initial_state::InitialWorld;
use crate::listener::Listener;
use crate::motion_history::{LastStepMotion, PreviousState};
use crate::sound::{StepContext, WorldSound};
use dwell_physics::{
    ActionOutcome, AgentControl, AgentPlacement, BodyState, ContactEvent, HandAction, JointState,
    PhysicsWorld, StartReport, Target,
};
use dwell_render::BackEnd;
use dwell_scene::bvh::{Hit, Ray, RayMask};
use dwell_scene::interrupt;
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use dwell_scene::rays::RayScene;
use dwell_scene::{
    Address, AgentId, AgentState, Entity, EntityId, House, Id, JointCommand, JointId, ObjectId,
    Parameter, State,
};
use glam::Vec3;
use std::sync::Arc;
use xxhash_rust::xxh3::xxh3_64;

/// A world over a shared house.
#[derive(Debug)]
pub struct World {
    pub(crate) engines: Arc<Engines>,
    pub(crate) config: WorldConfig,
    pub(crate) state: State,
    pub(crate) physics: PhysicsWorld,
    pub(crate) rays: RayScene,
    pub(crate) sound: WorldSound,
    pub(crate) events: Vec<ContactEvent>,
    pub(crate) key: RandomKey,
    /// Poses before the last step.
    pub(crate) motion_history: LastStepMotion,
    /// Memory for it.
    pub(crate) before: PreviousState,
    /// The state that [`World::reset`] goes back to; worlds of one config share it.
    pub(crate) initial: Arc<InitialWorld>,
}

impl World {
    /// Makes a world; its agents stand at the first room's floor until they are placed.
    ///
    /// # Errors
    /// [`WorldError`] names the setting, parameter or law that is wrong, or a sound file of the house that is none.
    pub fn new(engines: Arc<Engines>, config: &WorldConfig) -> Result<Self, WorldError> {
        config.check()?;
        config.check_sound_root()?;
        if config.renderer != BackEnd::Cpu {
            engines.image_renderer(&config.renderer)?;
        }
        if let Some(head) = config.sound_head {
            engines.head(head)?;
        }
        engines.check_sounds()?;
        let start = engines.initial_world(config)?;
        for (text, [low, high]) in &config.randomize {
            let known = crate::laws::parameter(&start.state, engines.house(), &text.parse()?)?;
            if *low > known.high || *high < known.low {
                return Err(WorldError::Config {
                    field: "randomize",
                    found: format!("{low} to {high} for {text}"),
                    allowed: format!(
                        "an interval that has something of {} to {}",
                        known.low, known.high
                    ),
                });
            }
        }
        let (state, physics) = (start.state.clone(), start.physics.clone());
        let mut rays = RayScene::new(engines.house().clone());
        rays.update(&state);
        let mut motion_history = LastStepMotion::default();
        motion_history.begin_persons(engines.house(), &state);
        Ok(Self {
            engines,
            config: config.clone(),
            state,
            physics,
            rays,
            sound: WorldSound::new(config),
            events: Vec::new(),
            key: RandomKey::root(0),
            motion_history,
            before: PreviousState::default(),
            initial: start,
        })
    }

    /// Sets on how many threads its receivers hear; one at first. What they hear does not depend on it.
    pub fn set_threads(&mut self, threads: Threads) {
        self.sound.set_threads(threads);
    }

    /// Goes back to the start; random streams begin anew under `key`.
    ///
    /// # Errors
    /// [`WorldError`] for a parameter of `randomize` that cannot be what was drawn.
    pub fn reset(&mut self, key: RandomKey) -> Result<(), WorldError> {
        self.state.clone_from(&self.initial.state);
        self.draw_persons(key);
        self.physics.clone_from(&self.initial.physics);
        self.rays.update(&self.state);
        self.sound.reset();
        self.events.clear();
        self.motion_history.clear();
        let house = self.engines.house();
        self.motion_history.begin_persons(house, &self.state);
        self.key = key;
        self.draw_parameters()
    }

    /// As [`Self::reset`], in a world in which nothing has happened since it was made.
    ///
    /// # Errors
    /// As [`Self::reset`].
    pub(crate) fn reset_fresh(&mut self, key: RandomKey) -> Result<(), WorldError> {
        if !self.state.persons.is_empty() {
            self.draw_persons(key);
            self.rays.update(&self.state);
        }
        self.key = key;
        self.draw_parameters()
    }

    /// Draws the parameters of [`WorldConfig::randomize`] under the episode's key, each from a stream of its own.
    fn draw_parameters(&mut self) -> Result<(), WorldError> {
        if self.config.randomize.is_empty() {
            return Ok(());
        }
        let key = self.key.child("parameters");
        let drawn = self.config.randomize.iter().map(|(text, ends)| {
            let address: Address = text.parse()?;
            let known = self.parameter(&address)?;
            let [low, high] = ends.map(|end| end.clamp(known.low, known.high));
            let share = key.child(text.as_str()).stream().uniform();
            Ok((address, low + (high - low) * share))
        });
        let drawn = drawn.collect::<Result<Vec<_>, WorldError>>()?;
        self.set_parameters(&drawn)
    }

    /// Makes one control step. `controls`: one for each agent; agents without one stand still.
    ///
    /// # Errors
    /// [`WorldError::Physics`] for numbers that are not finite or too many controls.
    pub fn step(&mut self, controls: &[AgentControl]) -> Result<(), WorldError> {
        let began_s = self.physics.time_s();
        self.step_physics(controls)?;
        self.conclude_step(began_s)
    }

    /// As [`World::step`], but a cancellation meanwhile ([`interrupt`]) leaves the world as it was before. Short steps end first.
    ///
    /// # Errors
    /// As [`World::step`].
    pub fn step_or_stay(&mut self, controls: &[AgentControl]) -> Result<(), WorldError> {
        if !self.physics.is_next_step_long() {
            return interrupt::uninterruptible(|| self.step(controls));
        }
        let began_s = self.physics.time_s();
        let before = (
            self.state.clone(),
            self.physics.clone(),
            self.events.clone(),
        );
        match interrupt::catch_interrupt(|| self.step_physics(controls)) {
            Ok(outcome) => outcome?,
            Err(interrupted) => {
                (self.state, self.physics, self.events) = before;
                interrupted.resume_unwind();
            }
        }
        interrupt::uninterruptible(|| self.conclude_step(began_s))
    }

    /// The part of a step in which things move.
    fn step_physics(&mut self, controls: &[AgentControl]) -> Result<(), WorldError> {
        self.events.clear();
        self.before.capture(&self.state);
        Ok(self
            .physics
            .step(&mut self.state, controls, &mut self.events)?)
    }

    /// The part of a step that follows from what has moved.
    fn conclude_step(&mut self, began_s: f64) -> Result<(), WorldError> {
        self.state.step += 1;
        self.state.time_s = self.state.step as f64 * self.config.step_s();
        self.advance_persons();
        self.motion_history.record(&self.before, &self.state);
        let house = self.engines.house();
        self.motion_history.record_persons(house, &self.state);
        self.rays.update(&self.state);
        self.sound.add_contact_sounds(&StepContext {
            house: self.engines.house(),
            rays: &self.rays,
            state: &self.state,
            events: &self.events,
            agents_before: &self.before.agents,
            joints_before: &self.before.joints,
            start_s: began_s,
            length_s: self.config.step_s(),
            key: self.key.child("sound"),
        });
        let key = self.key.child("sound");
        self.sound
            .advance(&self.engines, &self.rays, &self.state, key)
    }

    /// Performs an action of an agent's hand.
    pub fn act(&mut self, agent: AgentId, action: &dyn HandAction) -> ActionOutcome {
        let outcome = self.physics.act(&mut self.state, &self.rays, agent, action);
        self.show_reach(agent, &outcome);
        self.rays.update(&self.state);
        outcome
    }

    /// Returns whether anything known beforehand rules an action of an agent's hand out; nothing changes.
    ///
    /// # Errors
    /// The outcome with the reason why [`World::act`] would refuse it.
    pub fn check_action(
        &mut self,
        agent: AgentId,
        action: &dyn HandAction,
    ) -> Result<(), Box<ActionOutcome>> {
        self.physics
            .check_action(&mut self.state, &self.rays, agent, action)
    }

    /// Returns the object that an agent would act on through a target, and how far its surface is from the agent's eye, m; `None`
    /// for what is no object.
    pub(crate) fn distance_to_target(
        &mut self,
        agent: AgentId,
        target: &Target,
    ) -> Option<(ObjectId, f32)> {
        let (state, rays) = (&mut self.state, &self.rays);
        self.physics.distance_to_target(state, rays, agent, target)
    }

    /// Places an agent, at rest.
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] for an agent that does not exist.
    pub fn place_agent(
        &mut self,
        agent: AgentId,
        position: Vec3,
        yaw_rad: f32,
    ) -> Result<(), WorldError> {
        if agent.index() >= self.state.agents.len() {
            let count = self.state.agents.len();
            return Err(WorldError::InvalidCall(format!(
                "no agent {}; there are {count}",
                agent.0
            )));
        }
        self.physics
            .place_agent(&mut self.state, agent, position, yaw_rad)?;
        self.motion_history
            .begin_persons(self.engines.house(), &self.state);
        self.rays.update(&self.state);
        Ok(())
    }

    /// Sets poses and velocities of agents, at once, together with what they hold.
    ///
    /// # Errors
    /// [`WorldError::Physics`] for an agent that does not exist and for numbers that are not finite or that its body cannot
    /// have; nothing has changed then.
    pub fn set_agents(&mut self, placements: &[AgentPlacement]) -> Result<(), WorldError> {
        self.physics.set_agents(&mut self.state, placements)?;
        self.motion_history
            .begin_persons(self.engines.house(), &self.state);
        self.rays.update(&self.state);
        Ok(())
    }

    /// Opens the ears of these agents until the next reset, each with a window of at least so many samples: every step
    /// computes what they hear. A new listener hears the last step's sound at once; an earlier one hears nothing
    /// twice.
    ///
    /// # Errors
    /// [`WorldError::Acoustics`] for a source or receiver that cannot be simulated.
    pub fn enable_listeners(&mut self, ears: &[(AgentId, usize)]) -> Result<(), WorldError> {
        let ears = ears.iter();
        let ears = ears.map(|(agent, samples)| (Listener::ears(*agent), *samples));
        self.enable_receivers(&ears.collect::<Vec<_>>())
    }

    /// As [`World::enable_listeners`], for any receivers of agents.
    ///
    /// # Errors
    /// [`WorldError::Acoustics`] for a source or receiver that cannot be simulated.
    pub fn enable_receivers(&mut self, listeners: &[(Listener, usize)]) -> Result<(), WorldError> {
        self.sound.enable_listeners(
            &self.engines,
            &self.rays,
            &self.state,
            listeners,
            self.key.child("sound"),
        )
    }

    /// The signals of what is switched on, each once, and their sample rate, Hz.
    pub(crate) fn active_signals_and_rate(&self) -> (Vec<String>, u32) {
        self.sound
            .active_signals_and_rate(self.engines.house(), &self.state)
    }

    /// What a ray meets first, looked past what is in an agent's hand, as its hand does.
    pub(crate) fn closest_past_hand(&self, agent: &AgentState, ray: &Ray) -> Option<Hit> {
        let held = agent
            .holding
            .map_or(EntityId::VOID, |held| self.house().entity_of_object(held));
        self.rays.closest_excluding(ray, RayMask::EYE, held)
    }

    /// The object in the middle of an agent's view, within 10 m: what is in its hand is looked past.
    pub fn object_in_view_centre(&self, agent: AgentId) -> Option<ObjectId> {
        let agent = self.state.agents.get(agent)?;
        let eye = agent.world_from_eye();
        let ray = Ray::new(eye.position, eye.transform_vector(Vec3::NEG_Z)).with_range(0.0, 10.0);
        let hit = self.closest_past_hand(agent, &ray)?;
        match self.house().entity(self.rays.surface(&hit).entity)? {
            Entity::Object(object) => Some(object),
            _ => None,
        }
    }

    /// Returns the shared engines of all worlds over the house.
    pub fn engines(&self) -> &Arc<Engines> {
        &self.engines
    }

    /// The house.
    pub fn house(&self) -> &Arc<House> {
        self.engines.house()
    }

    /// The settings.
    pub fn config(&self) -> &WorldConfig {
        &self.config
    }

    /// The state.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The random key of the episode, the same for all agents.
    pub(crate) fn episode_key(&self) -> RandomKey {
        self.key
    }

    /// Surfaces as they stand now.
    pub fn rays(&self) -> &RayScene {
        &self.rays
    }

    /// Returns the poses before the last step.
    pub fn motion_history(&self) -> &LastStepMotion {
        &self.motion_history
    }

    /// Returns whether laws of an agent's depth sensors look at normals.
    pub(crate) fn needs_normals(&self, agent: AgentId) -> bool {
        dwell_render::CameraLaws::of(&self.state.laws, agent).needs_normals()
    }

    /// Returns the number of bodies that are awake: those for which a step takes time.
    pub fn awake_bodies(&self) -> usize {
        self.physics.awake_count()
    }

    pub(crate) fn physics(&self) -> &PhysicsWorld {
        &self.physics
    }

    /// Impacts, scrapes and rolling of the last step.
    pub fn events(&self) -> &[ContactEvent] {
        &self.events
    }

    /// The contact events of the last step beyond its limit: their number, and their impulse together.
    pub fn events_beyond_limit(&self) -> dwell_physics::ExcessEventTotals {
        self.physics.events_beyond_limit()
    }

    /// Returns the number of pairs of collision pieces in physics.
    pub fn pair_counts(&self) -> dwell_physics::PairCounts {
        self.physics.pair_counts()
    }

    /// Returns what had to be moved or frozen so that the world could start.
    pub fn start_report(&self) -> &StartReport {
        &self.initial.start_report
    }

    /// Returns the parameter at an address.
    ///
    /// # Errors
    /// [`WorldError::Scene`] for an unknown address.
    pub fn parameter(&self, address: &Address) -> Result<Parameter, WorldError> {
        Ok(crate::laws::parameter(&self.state, self.house(), address)?)
    }

    /// Every parameter with its address and value now: those of the scene, then those of laws, installed or not.
    pub fn parameters(&self) -> Vec<(Address, Parameter)> {
        let mut addresses = self.state.addresses(self.house());
        addresses.extend(self.state.law_addresses(crate::laws::all_slice()));
        let read = |address: Address| Some((address.clone(), self.parameter(&address).ok()?));
        addresses.into_iter().filter_map(read).collect()
    }

    /// Sets a parameter from now on: of the scene, or of a law (`law/ID/PARAM`, `law/ID@TARGET/PARAM`), which is installed by
    /// the first number that differs from its default. What a law remembers (commands on their way, play) stays as long as
    /// one of its numbers differs from its default.
    ///
    /// # Errors
    /// [`WorldError::Scene`] for an unknown address or a value out of range, [`WorldError::Physics`] for a law that cannot
    /// act on its target, or an agent's body that has no room where it stands. Nothing has changed then.
    pub fn set_parameter(&mut self, address: &Address, value: f64) -> Result<(), WorldError> {
        self.set_parameters(&[(address.clone(), value)])
    }

    /// Sets parameters together from now on: all of them, or none. Mutual bounds (a joint's limits, a part's three
    /// moments of inertia, an agent's height and radius) is checked when all are set.
    ///
    /// # Errors
    /// As [`World::set_parameter`], and for a parameter that is there twice in two spellings. Nothing has changed then.
    pub fn set_parameters(&mut self, values: &[(Address, f64)]) -> Result<(), WorldError> {
        let house = self.house().clone();
        let state = &self.state;
        let before = (
            state.overrides.clone(),
            state.laws.clone(),
            state.agents.clone(),
        );
        crate::laws::set_parameters(&mut self.state, &house, values)?;
        let optics = dwell_render::laws::check(&self.state.laws, self.state.agents.len());
        let set = optics.map_err(WorldError::from).and_then(|()| {
            let applied = self.physics.apply_parameters(&mut self.state);
            applied.map_err(WorldError::from)
        });
        if let Err(error) = set {
            (self.state.overrides, self.state.laws, self.state.agents) = before;
            return Err(error);
        }
        self.rays.update(&self.state);
        Ok(())
    }

    /// Commands a joint's motor, from the next step until the next command. A joint without a motor is moved by
    /// hand and takes positions only.
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] for a joint that does not exist, a number that is not finite, or a command the joint cannot
    /// obey.
    pub fn command_joint(
        &mut self,
        joint: JointId,
        command: JointCommand,
    ) -> Result<(), WorldError> {
        let house = self.house().clone();
        let count = house.joints.len();
        let Some(articulation) = house.joints.get(joint) else {
            let what = format!("no joint {}; there are {count}, counted from 0", joint.0);
            return Err(WorldError::InvalidCall(what));
        };
        let name = &articulation.name;
        let refuse = |why: &str| Err(WorldError::InvalidCall(format!("joint {name:?}: {why}")));
        if !command.is_finite() {
            return refuse("the command is no finite number");
        }
        // The servo in force: an address may have changed the house's own.
        let servo = self.state.joint_parameters(&house, joint).servo;
        let gain = servo.map(|servo| servo.velocity_gain);
        match command {
            _ if articulation.mimic.is_some() && command != JointCommand::Off => {
                return refuse("it follows another joint; command that one");
            }
            JointCommand::Velocity(_) if gain.is_none_or(|gain| gain == 0.0) => {
                return refuse("it has no motor that keeps a velocity");
            }
            JointCommand::Effort(_) if articulation.servo.is_none() => {
                return refuse("it has no motor; a hand takes positions only");
            }
            _ => {}
        }
        self.state.joint_command[joint] = command;
        Ok(())
    }

    /// Sets positions and velocities of joints, rad or m and per second, at once; what hangs on them moves along.
    ///
    /// # Errors
    /// [`WorldError::InvalidCall`] for a joint that does not exist; [`WorldError::Physics`] for numbers that are not finite, a position
    /// beyond the joint's limits or a speed beyond 1000 rad/s or m/s; nothing has changed then.
    pub fn set_joints(&mut self, joints: &[(JointId, f32, f32)]) -> Result<(), WorldError> {
        let count = self.state.joint_position.len();
        if let Some((joint, ..)) = joints.iter().find(|(joint, ..)| joint.index() >= count) {
            let what = format!("no joint {}; there are {count}, counted from 0", joint.0);
            return Err(WorldError::InvalidCall(what));
        }
        let joints: Vec<JointState> = joints
            .iter()
            .map(|(joint, position, velocity)| JointState {
                joint: *joint,
                position: *position,
                velocity: *velocity,
            })
            .collect();
        self.physics.set_joints(&mut self.state, &joints)?;
        self.rays.update(&self.state);
        Ok(())
    }

    /// Sets poses and velocities of bodies that move freely, and of the bases of free robots, at once. What hangs on
    /// them by joints moves along; agents are put by [`World::place_agent`].
    ///
    /// # Errors
    /// [`WorldError::Physics`] for a part that is fixed, frozen, held or moved by a joint, for numbers that are not finite, and
    /// for places and speeds that physics cannot keep; nothing has changed then.
    pub fn set_bodies(&mut self, bodies: &[BodyState]) -> Result<(), WorldError> {
        self.physics.set_bodies(&mut self.state, bodies)?;
        self.rays.update(&self.state);
        Ok(())
    }

    /// A number that changes with any bit of state, physics, sound queues or random streams.
    pub fn hash(&self) -> u64 {
        let mut bytes = self.state.hash().to_le_bytes().to_vec();
        bytes.extend_from_slice(&self.physics.hash().to_le_bytes());
        bytes.extend_from_slice(&xxh3_64(&self.sound.to_bytes()).to_le_bytes());
        bytes.extend_from_slice(&postcard::to_stdvec(&self.key).unwrap_or_default());
        xxh3_64(&bytes)
    }
}
