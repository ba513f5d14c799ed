//! A running physics world.

use crate::actions::{DelayedOutcome, OngoingPush};
use crate::agents::{Agent, HeldObject, PassiveVelocity};
use crate::body::{self, BodyHandle, BodyStatus};
use crate::config::{PhysicsConfig, ResolvedConfig};
use crate::contact::{
    BodyMotion, ColliderEntry, CollisionExclusions, ContactEntity, ContactHooks, ContactProperties,
    ContactTable, ContactTracker, MergedEvents,
};
use crate::convert::{from_rapier, to_rapier};
use crate::dynamics::{BodyMasses, assemble};
use crate::engine::{PairCounts, RapierWorld};
use crate::error::PhysicsError;
use crate::joints::{
    self, HandDrives, JointActuation, JointCoordinate, KinematicTree, PhysicsJoint,
};
use crate::laws::{self, LawSet};
use crate::limits;
use crate::model::PhysicsModel;
use crate::report::StartReport;
use crate::start::StartResolver;
use dwell_scene::material::PairContact;
use dwell_scene::{Address, AgentId, AgentState, House, JointId, State};
use rapier3d::dynamics::RigidBodyHandle;
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
    pub(crate) model: Arc<PhysicsModel>,
    pub(crate) settings: ResolvedConfig,
    pub(crate) engine: RapierWorld,
    /// What each collider stands for, by its user data.
    pub(crate) entries: Vec<ColliderEntry>,
    pub(crate) table: ContactTable,
    pub(crate) bodies: Vec<BodyHandle>,
    pub(crate) holds: Vec<BodyStatus>,
    pub(crate) weights: BodyMasses,
    /// The overrides that are in force.
    pub(crate) applied: BTreeMap<Address, f64>,
    pub(crate) joints: Vec<PhysicsJoint>,
    /// Joints that act on each other.
    pub(crate) trees: Vec<KinematicTree>,
    /// Each joint's numbers within a control step; the turns of hinges are counted here. Between control steps the state has
    /// them. Shape (joint,).
    pub(crate) joint_coordinates: Vec<JointCoordinate>,
    /// What pulls at each joint during this control step.
    pub(crate) pulls: Vec<Option<JointActuation>>,
    pub(crate) agents: Vec<Agent>,
    /// What each agent has of speed that is not its own will.
    pub(crate) passive_velocities: Vec<PassiveVelocity>,
    pub(crate) excluded: CollisionExclusions,
    pub(crate) grips: Vec<HeldObject>,
    /// Bodies that were let go and still overlap the agent that held them.
    pub(crate) released_overlapping: Vec<(u32, AgentId)>,
    pub(crate) drives: HandDrives,
    pub(crate) ongoing_pushes: Vec<OngoingPush>,
    pub(crate) laws: LawSet,
    /// Physics steps since the world was made.
    pub(crate) tick: u64,
    pub(crate) contact_tracker: ContactTracker,
    /// What the last control step did not tell one by one.
    pub(crate) merged_events: MergedEvents,
    pub(crate) notices: Vec<DelayedOutcome>,
    pub(crate) motion: Vec<BodyMotion>,
}

impl PhysicsWorld {
    /// Makes the bodies of a house where `state` has its parts. Things that overlap are moved free by small steps, in
    /// `state` too, or frozen; an agent that would stand in something is put where it has room, at the nearest place on a
    /// room's floor. The report says which.
    ///
    /// # Errors
    /// [`PhysicsError::Range`] for a setting out of range and for an agent's body that has room nowhere in the house, [`PhysicsError::ForeignState`] for another house's state,
    /// [`PhysicsError::LawTarget`] for a law without its target, [`PhysicsError::TooMany`] for more bodies, joints or pairs than a world holds.
    #[expect(
        clippy::needless_pass_by_value,
        reason = "the shape of every engine's entry point"
    )]
    pub fn new(
        house: Arc<House>,
        config: PhysicsConfig,
        state: &mut State,
    ) -> Result<(Self, StartReport), PhysicsError> {
        Self::over(Arc::new(PhysicsModel::new(house)), &config, state)
    }

    /// As [`PhysicsWorld::new`], over shapes that other worlds share.
    ///
    /// # Errors
    /// As [`PhysicsWorld::new`].
    pub fn over(
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
        let values = ContactProperties {
            house: &model.house,
            table: &table,
            laws: &laws.contacts,
            soft: laws.compliance.is_some(),
        };
        let sizes = (gravity, state.agents.len(), crowding);
        let assembly = assemble(
            &model,
            &settings,
            values,
            laws.compliance,
            sizes,
            places,
            &weights,
        );
        let mut world = Self {
            holds: vec![BodyStatus::Free; model.bodies.len()],
            model,
            settings,
            engine: assembly.engine,
            entries: assembly.entries,
            table,
            bodies: assembly.bodies,
            weights,
            applied: state.overrides.clone(),
            joints: Vec::new(),
            trees: Vec::new(),
            joint_coordinates: Vec::new(),
            pulls: Vec::new(),
            agents: Vec::new(),
            passive_velocities: Vec::new(),
            excluded: CollisionExclusions::default(),
            grips: Vec::new(),
            released_overlapping: Vec::new(),
            drives: HandDrives::new(),
            ongoing_pushes: Vec::new(),
            laws,
            tick: 0,
            contact_tracker: ContactTracker::default(),
            merged_events: MergedEvents::default(),
            notices: Vec::new(),
            motion: Vec::new(),
        };
        let mut report = world.begin(state, assembly.anchor)?;
        let agents: Vec<AgentState> = state.agents.iter().copied().collect();
        for agent in agents {
            agent.body.check()?;
            world.insert_agent(&agent);
        }
        world.flush();
        report.agents = world.give_agents_room(state)?;
        if !report.agents.is_empty() {
            world.flush();
        }
        world.write_bodies(state);
        world.write_contacts(state);
        Ok((world, report))
    }

    /// Resolves overlaps, hangs joints and shuts doors.
    fn begin(
        &mut self,
        state: &mut State,
        anchor: RigidBodyHandle,
    ) -> Result<StartReport, PhysicsError> {
        let mut report = StartReport {
            bodies: self.bodies.len(),
            static_pieces: self.model.statics.len(),
            joints: self.model.house.joints.len(),
            stand_ins: self.model.stand_ins.clone(),
            ..StartReport::default()
        };
        let model = self.model.clone();
        self.joints = joints::insert(&mut self.engine, &model, &self.bodies, anchor, state);
        self.trees = joints::trees(&self.joints, &model, anchor);
        limits::check_trees(&model.house, &self.joints, &self.trees)?;
        self.pulls = vec![None; self.joints.len()];
        self.flush();
        let start = StartResolver {
            engine: &self.engine,
            model: &model,
            entries: &self.entries,
            bodies: &self.bodies,
            settings: &self.settings,
        };
        let excluded = start.passing(&mut report)?;
        let resolved = start.resolve(&mut report);
        self.excluded = excluded;
        for (index, resolved) in resolved.iter().enumerate() {
            self.holds[index] = resolved.hold;
            if let Some(rigid) = self.engine.bodies.get_mut(self.bodies[index].handle) {
                if *rigid.position() != resolved.place {
                    rigid.set_position(resolved.place, false);
                }
                rigid.set_body_type(body::body_type(resolved.hold), false);
            }
        }
        self.carry_jointed_bodies(state);
        if self.settings.config.latches {
            for joint in &self.joints {
                let articulation = &model.house.joints[joint.id];
                if joints::stands_shut(joint, articulation, state.joint_position[joint.id]) {
                    let child = joint.child as usize;
                    let body = self.bodies[child];
                    let hold = &mut self.holds[child];
                    joints::shut(&mut self.engine, joint, articulation, &body, hold);
                }
            }
        }
        self.forget_fixed_pairs();
        Ok(report)
    }

    /// Brings what hangs on joints along where what it hangs on was moved.
    fn carry_jointed_bodies(&mut self, state: &State) {
        let stands = self.joints.iter().map(|joint| joints::JointPlacement {
            position: state.joint_position[joint.id],
            velocity: 0.0,
            anew: false,
            shut: false,
        });
        let stands: Vec<joints::JointPlacement> = stands.collect();
        for tree in &self.trees {
            let moved = tree.root_body().is_some_and(|body| {
                let body = body as usize;
                let start = to_rapier(&state.part_pose[self.model.bodies[body].root()]);
                body::pose_of(&self.engine, &self.bodies[body]) != Some(from_rapier(&start))
            });
            if moved {
                joints::place(&mut self.engine, &self.joints, tree, &stands);
            }
        }
    }

    /// The shapes this world shares with others over its house.
    pub fn model(&self) -> &Arc<PhysicsModel> {
        &self.model
    }

    /// The settings.
    pub fn config(&self) -> &PhysicsConfig {
        &self.settings.config
    }

    /// Returns what became, in the last step, of doors and grips that take time.
    pub fn notices(&self) -> &[DelayedOutcome] {
        &self.notices
    }

    /// The events of the last control step beyond its limit: how many, and how strong together.
    pub fn merged_events(&self) -> MergedEvents {
        self.merged_events
    }

    /// Friction and restitution between two things as overrides have them, by their first surfaces (a wall or mesh of
    /// several materials has others too); `None` for what touches nothing. Laws may change what acts; each contact event
    /// carries the values of its own surfaces.
    pub fn pair(&self, a: ContactEntity, b: ContactEntity) -> Option<PairContact> {
        let class = |toucher: ContactEntity| {
            let entry = self.entries.iter();
            let mut found = entry.filter(|entry| entry.toucher == Some(toucher));
            found.next().map(|entry| entry.surface.class(0))
        };
        Some(self.table.pair(class(a)?, class(b)?))
    }

    /// Simulated time since the world was made, s.
    pub fn time_s(&self) -> f64 {
        self.tick as f64 / f64::from(self.settings.config.physics_rate_hz)
    }

    /// Returns how many pairs of colliders the world keeps: most of its memory, and of a snapshot's size.
    pub fn pair_counts(&self) -> PairCounts {
        self.engine.pair_counts()
    }

    /// Returns how many rigid bodies are awake.
    pub fn awake_count(&self) -> usize {
        let awake = |body: &&BodyHandle| {
            let rigid = self.engine.bodies.get(body.handle);
            rigid.is_some_and(|rigid| rigid.is_dynamic() && !rigid.is_sleeping())
        };
        self.bodies.iter().filter(awake).count()
    }

    /// The number of the body that rapier knows by a handle.
    pub(crate) fn body_of(&self, handle: RigidBodyHandle) -> Option<usize> {
        // They were inserted in order.
        let key = |body: &BodyHandle| body.handle.into_raw_parts();
        let place = self
            .bodies
            .binary_search_by_key(&handle.into_raw_parts(), key);
        place.ok()
    }

    pub(crate) fn check_state(&self, state: &State) -> Result<(), PhysicsError> {
        check_counts(&self.model.house, state)?;
        same("agents", state.agents.len(), self.agents.len())
    }

    /// Brings positions, contacts and queries up to date after a change from outside.
    pub(crate) fn flush(&mut self) {
        self.update_rolling_contacts();
        let hooks = ContactHooks {
            entries: &self.entries,
            properties: ContactProperties {
                house: &self.model.house,
                table: &self.table,
                laws: &self.laws.contacts,
                soft: self.laws.compliance.is_some(),
            },
            excluded: &self.excluded,
            kept: self.engine.friction_kept(),
            dt_s: 0.0,
        };
        self.engine.flush(&hooks);
    }

    /// Writes poses, velocities and joints into the state.
    pub(crate) fn write_bodies(&self, state: &mut State) {
        for (plan, body) in self.model.bodies.iter().zip(&self.bodies) {
            body::write_parts(&self.engine, plan, body, state);
        }
        for joint in &self.joints {
            let now = joints::stands(&self.engine, joint, joint_from_state(state, joint.id));
            let (position, velocity) = (now.position as f32, now.velocity as f32);
            // A door that is shut stands at its closed position, whatever rounding says.
            let shut = self.holds[joint.child as usize] == BodyStatus::Latched;
            let closed = self.model.house.joints[joint.id].closed;
            state.joint_position[joint.id] = if shut { closed } else { position };
            state.joint_velocity[joint.id] = if shut { 0.0 } else { velocity };
        }
        state.follow_switches(&self.model.house);
    }
}

/// A joint's numbers as the state has them.
pub(crate) fn joint_from_state(state: &State, joint: JointId) -> JointCoordinate {
    JointCoordinate {
        position: state.joint_position[joint].into(),
        velocity: state.joint_velocity[joint].into(),
    }
}

fn same(what: &'static str, found: usize, expected: usize) -> Result<(), PhysicsError> {
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
    same("parts", state.part_pose.len(), house.parts.len())?;
    same(
        "part velocities",
        state.part_velocity.len(),
        house.parts.len(),
    )?;
    same("joints", state.joint_position.len(), house.joints.len())?;
    same(
        "joint commands",
        state.joint_command.len(),
        house.joints.len(),
    )?;
    same("objects", state.held_by.len(), house.objects.len())
}

/// Puts every joint's part where its joint says, unless it stands there already; a joint beyond its limits, as a parameter may
/// have set them, stands at the nearer one.
fn align_joints(model: &PhysicsModel, state: &mut State) {
    for (id, joint) in model.house.joints.iter_ids() {
        let values = state.joint_values(&model.house, id);
        state.joint_position[id] = values.clamp(state.joint_position[id]);
        let parent = joint.parent.map_or(dwell_scene::Pose::IDENTITY, |parent| {
            state.part_pose[parent]
        });
        let pose = state.world_from_child(&model.house, id, &parent, state.joint_position[id]);
        let now = state.part_pose[joint.child];
        let joint_coordinates = (pose.position - now.position).length() < 1e-4
            && pose.rotation.dot(now.rotation).abs() > 1.0 - 1e-6;
        if !joint_coordinates {
            state.part_pose[joint.child] = pose;
        }
    }
}

impl ResolvedConfig {
    /// Force from which rapier reports a contact, N.
    pub(crate) fn event_force_n(&self) -> f32 {
        // An impact may be spread over a few steps.
        0.25 * self.config.event_min_impulse_n_s / self.dt_s
    }
}

impl fmt::Debug for PhysicsWorld {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PhysicsWorld")
            .field("house", &self.model.house.name)
            .field("bodies", &self.bodies.len())
            .field("agents", &self.agents.len())
            .field("tick", &self.tick)
            .finish_non_exhaustive()
    }
}
