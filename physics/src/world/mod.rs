//! A running physics world.

mod agent_placement;
mod begin;
mod carry_space;
mod external_changes;
mod non_finite;
mod parameters;
mod set_state;
mod settle_start;
mod snapshot;
mod step;

pub use agent_placement::AgentPlacement;
pub use set_state::{BodyState, JointState};

use crate::actions::{ActionContext, HandAction, HandContext, OngoingPush, Target};
use crate::agents::{AgentContacts, Agents};
use crate::articulation::WorldJoints;
use crate::body::{BodyHandle, BodyStatus};
use crate::config::PhysicsConfig;
use crate::contact::{CollisionExclusions, ContactEntity, ContactTable, ExcessEventTotals};
use crate::contact_record::ContactPipeline;
use crate::convert::to_rapier;
use crate::dynamics::{BodyMasses, Dynamics, assemble};
use crate::engine::PairCounts;
use crate::error::PhysicsError;
use crate::hands::Hands;
use crate::laws::{self, LawSet};
use crate::limits;
use crate::model::PhysicsModel;
use crate::outcome::{ActionOutcome, DelayedOutcome, OutcomeCode, fail};
use crate::report::StartReport;
use begin::align_joints;
use dwell_scene::material::PairContact;
use dwell_scene::rays::RayScene;
use dwell_scene::{Address, AgentId, AgentState, House, Id, ObjectId, State};
use rapier3d::dynamics::RigidBody;
use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

/// The rigid bodies, joints and agents of one world over a house.
///
/// # Determinism
/// The same house, config, state and calls give the same bits on one machine kind, for any number of threads: a world
/// runs on the caller's thread alone.
#[derive(Clone)]
pub struct PhysicsWorld {
    dynamics: Dynamics,
    articulation: WorldJoints,
    agents: Agents,
    hands: Hands,
    pushes: Vec<OngoingPush>,
    contacts: ContactPipeline,
    /// The overrides in force.
    applied: BTreeMap<Address, f64>,
    /// Outcomes in the last step of operations that take time.
    notices: Vec<DelayedOutcome>,
}

impl PhysicsWorld {
    /// Makes the bodies of a house at the poses of `state`. Overlapping objects are moved apart by small steps, in `state`
    /// too, or frozen; an agent that would overlap something is moved to the nearest free position on a room's floor. The
    /// report lists them.
    ///
    /// # Errors
    /// [`PhysicsError::Range`] for a setting out of range and for an agent's body that fits nowhere in the house,
    /// [`PhysicsError::ForeignState`] for another house's state, [`PhysicsError::LawTarget`] for a law without its target,
    /// [`PhysicsError::TooMany`] for more bodies, joints or pairs than a world holds.
    #[expect(
        clippy::needless_pass_by_value,
        reason = "the shape of every engine's entry point"
    )]
    pub fn new(
        house: Arc<House>,
        config: PhysicsConfig,
        state: &mut State,
    ) -> Result<(Self, StartReport), PhysicsError> {
        Self::with_model(Arc::new(PhysicsModel::new(house)), &config, state)
    }

    /// As [`PhysicsWorld::new`], over shapes that other worlds share.
    ///
    /// # Errors
    /// As [`PhysicsWorld::new`].
    pub fn with_model(
        model: Arc<PhysicsModel>,
        config: &PhysicsConfig,
        state: &mut State,
    ) -> Result<(Self, StartReport), PhysicsError> {
        let settings = config.build()?;
        check_counts(&model.house, state)?;
        let table = ContactTable::new(&model.house, state);
        let laws = laws::install(&model, state, &LawSet::default())?;
        let weights = BodyMasses::new(&model, state, &laws);
        align_joints(&model, state);
        let crowding = limits::check(&model, state)?;
        let places = |index: usize| {
            let root = model.bodies[index].root();
            (to_rapier(&state.part_pose[root]), BodyStatus::Free)
        };
        let gravity = state.gravity_m_s2();
        let values = laws.contact_properties(&model.house, &table);
        let sizes = (gravity, state.agents.len(), &crowding);
        let assembly = assemble(
            &model,
            &settings,
            values,
            laws.compliance,
            sizes,
            places,
            &weights,
        );
        let dynamics = Dynamics {
            statuses: vec![BodyStatus::Free; model.bodies.len()],
            model,
            settings,
            engine: assembly.engine,
            entries: assembly.entries,
            table,
            bodies: assembly.bodies,
            masses: weights,
            collision_exclusions: CollisionExclusions::default(),
            laws: Box::new(laws),
            tick: 0,
        };
        let mut world = Self {
            dynamics,
            articulation: WorldJoints::default(),
            agents: Agents::default(),
            hands: Hands::default(),
            pushes: Vec::new(),
            contacts: ContactPipeline::default(),
            applied: state.overrides.clone(),
            notices: Vec::new(),
        };
        let mut report = world.initialize(state, assembly.anchor)?;
        let agents: Vec<AgentState> = state.agents.iter().copied().collect();
        for agent in agents {
            agent.body.check()?;
            world.agents.insert(&mut world.dynamics, &agent);
        }
        world.dynamics.flush();
        report.agents = world
            .agents
            .resolve_spawn_overlaps(&mut world.dynamics, state)?;
        if !report.agents.is_empty() {
            world.dynamics.flush();
        }
        world
            .articulation
            .write_bodies_and_joints(&world.dynamics, state);
        world.dynamics.write_contacts(state);
        Ok((world, report))
    }

    /// Performs an agent's hand action, at once or, for doors and pushes, over the next steps.
    ///
    /// `rays` must show `state` as it is. Operations that take time report their end through [`PhysicsWorld::delayed_outcomes`]. A
    /// state of another world or an agent that does not exist is refused like any other impossible action.
    pub fn act(
        &mut self,
        state: &mut State,
        rays: &RayScene,
        agent: AgentId,
        action: &dyn HandAction,
    ) -> ActionOutcome {
        match self.hand_of(state, rays, agent) {
            Ok(mut hand) => hand.perform(action),
            Err(refusal) => *refusal,
        }
    }

    /// Returns whether anything known beforehand rules an action of an agent's hand out; see [`HandAction::check`]. Nothing changes.
    ///
    /// `rays` must show `state` as it is.
    ///
    /// # Errors
    /// The outcome with the reason why [`Self::act`] would refuse it.
    pub fn check_action(
        &mut self,
        state: &mut State,
        rays: &RayScene,
        agent: AgentId,
        action: &dyn HandAction,
    ) -> Result<(), Box<ActionOutcome>> {
        action.check(&self.hand_of(state, rays, agent)?)
    }

    /// Returns the object that an agent would act on through a target, and how far its surface is from the agent's eye, m; `None`
    /// for what is no object. Nothing changes.
    ///
    /// `rays` must show `state` as it is.
    pub fn distance_to_target(
        &mut self,
        state: &mut State,
        rays: &RayScene,
        agent: AgentId,
        target: &Target,
    ) -> Option<(ObjectId, f32)> {
        self.hand_of(state, rays, agent)
            .ok()?
            .distance_to_target(target)
    }

    /// Returns the hand of an agent.
    fn hand_of<'a>(
        &'a mut self,
        state: &'a mut State,
        rays: &'a RayScene,
        agent: AgentId,
    ) -> Result<HandContext<'a>, Box<ActionOutcome>> {
        let count = self.agents.list.len();
        if agent.index() >= count || agent.index() >= state.agents.len() {
            let sentence = format!("There is no agent {}; there are {count}.", agent.0);
            return Err(Box::new(fail(OutcomeCode::UnknownAgent, sentence, None)));
        }
        if let Err(error) = self.check_state(state) {
            let sentence = format!("Nothing was done: {error}.");
            return Err(Box::new(fail(OutcomeCode::ForeignState, sentence, None)));
        }
        let context = ActionContext {
            dynamics: &mut self.dynamics,
            articulation: &mut self.articulation,
            agents: &self.agents,
            hands: &mut self.hands,
            pushes: &mut self.pushes,
        };
        Ok(context.hand_of(state, rays, agent))
    }

    /// Returns what an agent's body and the object in its hand touch where `state` has them; nothing for an agent that does not exist.
    pub fn touch(&self, state: &State, agent: AgentId) -> AgentContacts {
        self.agents.touch(&self.dynamics, state, agent)
    }

    /// Returns the mass of what an agent holds, kg, as its hand lifts it; 0 where it holds nothing.
    pub fn held_mass_kg(&self, agent: AgentId) -> f32 {
        let mut grips = self.hands.held_objects.iter();
        let grip = grips.find(|grip| grip.agent == agent);
        let body = grip.and_then(|grip| self.dynamics.bodies.get(grip.body as usize));
        let body = body.and_then(|body| self.dynamics.engine.bodies.get(body.handle));
        body.map_or(0.0, RigidBody::mass)
    }

    /// Returns the model that this world shares with others over its house.
    pub fn model(&self) -> &Arc<PhysicsModel> {
        &self.dynamics.model
    }

    /// The settings.
    pub fn config(&self) -> &PhysicsConfig {
        &self.dynamics.settings.config
    }

    /// Returns the outcomes, in the last step, of doors, pushes and grips that take time.
    pub fn delayed_outcomes(&self) -> &[DelayedOutcome] {
        &self.notices
    }

    /// Returns the events of the last control step beyond its limit: their number and total impulse.
    pub fn events_beyond_limit(&self) -> ExcessEventTotals {
        self.contacts.merged_events
    }

    /// Returns friction and restitution between two things, with overrides, by their first surfaces (a wall or mesh of
    /// several materials has others too); `None` for a thing without contacts. Laws may change the values that act; each
    /// contact event has those of its own surfaces.
    pub fn contact_coefficients(&self, a: ContactEntity, b: ContactEntity) -> Option<PairContact> {
        let class = |contact_entity: ContactEntity| {
            let entry = self.dynamics.entries.iter();
            let mut found = entry.filter(|entry| entry.contact_entity == Some(contact_entity));
            found.next().map(|entry| entry.surface.class(0))
        };
        Some(self.dynamics.table.pair_contact(class(a)?, class(b)?))
    }

    /// Simulated time since the world was made, s.
    pub fn time_s(&self) -> f64 {
        self.dynamics.tick as f64 / f64::from(self.dynamics.settings.config.physics_rate_hz)
    }

    /// Returns the number of collider pairs that the world keeps: most of its memory, and of a snapshot's size.
    pub fn pair_counts(&self) -> PairCounts {
        self.dynamics.engine.pair_counts()
    }

    /// Returns the number of awake rigid bodies.
    pub fn awake_count(&self) -> usize {
        let awake = |body: &&BodyHandle| {
            let rigid = self.dynamics.engine.bodies.get(body.handle);
            rigid.is_some_and(|rigid| rigid.is_dynamic() && !rigid.is_sleeping())
        };
        self.dynamics.bodies.iter().filter(awake).count()
    }

    fn check_state(&self, state: &State) -> Result<(), PhysicsError> {
        check_counts(&self.dynamics.model.house, state)?;
        check_equal_counts("agents", state.agents.len(), self.agents.list.len())
    }
}

fn check_equal_counts(
    what: &'static str,
    found: usize,
    expected: usize,
) -> Result<(), PhysicsError> {
    if found == expected {
        Ok(())
    } else {
        Err(PhysicsError::ForeignState {
            what,
            found,
            expected,
        })
    }
}

fn check_counts(house: &House, state: &State) -> Result<(), PhysicsError> {
    check_equal_counts("parts", state.part_pose.len(), house.parts.len())?;
    check_equal_counts(
        "part velocities",
        state.part_velocity.len(),
        house.parts.len(),
    )?;
    check_equal_counts("joints", state.joint_position.len(), house.joints.len())?;
    check_equal_counts(
        "joint commands",
        state.joint_command.len(),
        house.joints.len(),
    )?;
    check_equal_counts("objects", state.held_by.len(), house.objects.len())
}

impl fmt::Debug for PhysicsWorld {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PhysicsWorld")
            .field("house", &self.dynamics.model.house.name)
            .field("bodies", &self.dynamics.bodies.len())
            .field("agents", &self.agents.list.len())
            .field("tick", &self.dynamics.tick)
            .finish_non_exhaustive()
    }
}
