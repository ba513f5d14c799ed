//! A running physics world.

use crate::actions::Notice;
use crate::agents::{self, Agent, Grip};
use crate::body::{self, Body, BodyPlace, Hold};
use crate::config::{PhysicsConfig, Settings};
use crate::contact::{ContactTable, Entry, Excluded, Hooks, Impacts, Motion, touching};
use crate::convert::{from_rapier, to_rapier};
use crate::engine::Engine;
use crate::error::PhysicsError;
use crate::joints::{self, Drives, Joint, Pull};
use crate::laws::{self, Installed};
use crate::model::PhysicsModel;
use crate::report::StartReport;
use crate::start::Start;
use dwell_scene::{AgentId, AgentState, House, Id, State};
use glam::Vec3;
use rapier3d::dynamics::{RigidBodyBuilder, RigidBodyHandle};
use rapier3d::math::Pose as RapierPose;
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
    pub(crate) settings: Settings,
    pub(crate) engine: Engine,
    /// What each collider stands for, by its user data.
    pub(crate) entries: Vec<Entry>,
    pub(crate) table: ContactTable,
    pub(crate) bodies: Vec<Body>,
    pub(crate) holds: Vec<Hold>,
    pub(crate) mass_factors: Vec<f32>,
    pub(crate) joints: Vec<Joint>,
    /// For each joint, the bodies that hang on it.
    pub(crate) carried: Vec<Vec<RigidBodyHandle>>,
    /// What pulls at each joint during this control step.
    pub(crate) pulls: Vec<Option<Pull>>,
    pub(crate) agents: Vec<Agent>,
    /// Speed downwards of each agent, m/s.
    pub(crate) falls: Vec<f32>,
    pub(crate) excluded: Excluded,
    pub(crate) grips: Vec<Grip>,
    /// Bodies that were let go and still overlap the agent that held them.
    pub(crate) parting: Vec<(u32, AgentId)>,
    pub(crate) drives: Drives,
    pub(crate) laws: Vec<Installed>,
    /// Physics steps since the world was made.
    pub(crate) tick: u64,
    pub(crate) impacts: Impacts,
    pub(crate) notices: Vec<Notice>,
    pub(crate) motion: Vec<Motion>,
}

/// The parts of a world that its shapes make up.
pub(crate) struct Assembly {
    pub(crate) engine: Engine,
    pub(crate) entries: Vec<Entry>,
    pub(crate) bodies: Vec<Body>,
    pub(crate) anchor: RigidBodyHandle,
}

/// Inserts the pieces of a house: statics, then bodies in order, at the given places.
pub(crate) fn assemble(
    model: &PhysicsModel,
    settings: &Settings,
    table: &ContactTable,
    gravity_m_s2: f32,
    places: impl Fn(usize) -> (RapierPose, Hold),
    mass_factors: &[f32],
) -> Assembly {
    let mut engine = Engine::new(settings, gravity_m_s2);
    let mut entries = body::insert_statics(&mut engine, model, table);
    let anchor = engine.bodies.insert(RigidBodyBuilder::fixed());
    let mut bodies = Vec::with_capacity(model.bodies.len());
    for (index, plan) in model.bodies.iter().enumerate() {
        let (world_from_body, hold) = places(index);
        let place = BodyPlace {
            index: index as u32,
            world_from_body,
            hold,
            mass_factor: mass_factors[index],
            sleeping_allowed: settings.config.sleeping,
            event_force_n: settings.event_force_n(),
        };
        bodies.push(body::insert_body(
            &mut engine,
            plan,
            table,
            &mut entries,
            place,
        ));
    }
    Assembly {
        engine,
        entries,
        bodies,
        anchor,
    }
}

impl PhysicsWorld {
    /// Makes the bodies of a house where `state` has its parts. Things that overlap are moved free by small steps, in
    /// `state` too, or frozen; the report says which.
    ///
    /// # Errors
    /// [`PhysicsError::Range`] for a setting out of range, [`PhysicsError::ForeignState`] for another house's state,
    /// [`PhysicsError::LawTarget`] for a law without its target.
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
        let mass_factors = body::mass_factors(&model, state);
        align_joints(&model, state);
        let places = |index: usize| {
            let root = model.bodies[index].root();
            (to_rapier(&state.part_pose[root]), Hold::Free)
        };
        let gravity = state.gravity_m_s2();
        let assembly = assemble(&model, &settings, &table, gravity, places, &mass_factors);
        let laws = laws::install(&model, state, &[])?;
        let mut world = Self {
            holds: vec![Hold::Free; model.bodies.len()],
            model,
            settings,
            engine: assembly.engine,
            entries: assembly.entries,
            table,
            bodies: assembly.bodies,
            mass_factors,
            joints: Vec::new(),
            carried: Vec::new(),
            pulls: Vec::new(),
            agents: Vec::new(),
            falls: Vec::new(),
            excluded: Excluded::default(),
            grips: Vec::new(),
            parting: Vec::new(),
            drives: Drives::new(),
            laws,
            tick: 0,
            impacts: Impacts::new(),
            notices: Vec::new(),
            motion: Vec::new(),
        };
        let report = world.begin(state, assembly.anchor);
        let agents: Vec<AgentState> = state.agents.iter().copied().collect();
        for agent in agents {
            agent.body.check()?;
            world.insert_agent(&agent);
        }
        world.flush();
        world.write_bodies(state);
        world.write_contacts(state);
        Ok((world, report))
    }

    /// Resolves overlaps, hangs joints and shuts doors.
    fn begin(&mut self, state: &mut State, anchor: RigidBodyHandle) -> StartReport {
        let mut report = StartReport {
            bodies: self.bodies.len(),
            static_pieces: self.model.statics.len(),
            joints: self.model.house.joints.len(),
            stand_ins: self.model.stand_ins.clone(),
            ..StartReport::default()
        };
        let model = self.model.clone();
        self.joints = joints::insert(&mut self.engine, &model, &self.bodies, anchor);
        self.carried = joints::carried(&self.joints);
        self.pulls = vec![None; self.joints.len()];
        for joint in &mut self.joints {
            let articulation = &model.house.joints[joint.id];
            joints::set_resistance(joint, articulation, state);
        }
        self.flush();
        let start = Start {
            engine: &self.engine,
            model: &model,
            entries: &self.entries,
            bodies: &self.bodies,
            settings: &self.settings,
        };
        let excluded = start.passing(&mut report);
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
        report
    }

    /// The shapes this world shares with others over its house.
    pub fn model(&self) -> &Arc<PhysicsModel> {
        &self.model
    }

    /// The settings.
    pub fn config(&self) -> &PhysicsConfig {
        &self.settings.config
    }

    /// What became, in the last step, of doors and grips that take time.
    pub fn notices(&self) -> &[Notice] {
        &self.notices
    }

    /// Simulated time since the world was made, s.
    pub fn time_s(&self) -> f64 {
        self.tick as f64 / f64::from(self.settings.config.physics_rate_hz)
    }

    /// How many rigid bodies are awake.
    pub fn awake_count(&self) -> usize {
        let awake = |body: &&Body| {
            let rigid = self.engine.bodies.get(body.handle);
            rigid.is_some_and(|rigid| rigid.is_dynamic() && !rigid.is_sleeping())
        };
        self.bodies.iter().filter(awake).count()
    }

    /// Adds an agent to the state and the world. It may be placed inside things; it then works its way out.
    ///
    /// # Errors
    /// [`PhysicsError::Scene`] for a body out of range, [`PhysicsError::Range`] for a place that is not finite,
    /// [`PhysicsError::ForeignState`] for a state with other agents.
    pub fn add_agent(
        &mut self,
        state: &mut State,
        agent: AgentState,
    ) -> Result<AgentId, PhysicsError> {
        agent.body.check()?;
        finite_place(agent.position, agent.yaw_rad)?;
        self.check_state(state)?;
        let id = state.agents.push(AgentState {
            holding: None,
            ..agent
        });
        self.insert_agent(&agent);
        self.flush();
        Ok(id)
    }

    fn insert_agent(&mut self, agent: &AgentState) {
        let id = AgentId::from_index(self.agents.len());
        let force = self.settings.event_force_n();
        let inserted = agents::insert(
            &mut self.engine,
            &self.table,
            &mut self.entries,
            id,
            agent,
            force,
        );
        self.agents.push(inserted);
        self.falls.push(0.0);
    }

    /// Puts an agent somewhere, at rest, together with what it holds.
    ///
    /// # Errors
    /// [`PhysicsError::UnknownAgent`], or [`PhysicsError::Range`] for a place that is not finite.
    pub fn place_agent(
        &mut self,
        state: &mut State,
        agent: AgentId,
        position: Vec3,
        yaw_rad: f32,
    ) -> Result<(), PhysicsError> {
        self.check_state(state)?;
        let Some(here) = state.agents.get_mut(agent) else {
            return Err(PhysicsError::UnknownAgent {
                index: agent.index(),
                count: self.agents.len(),
            });
        };
        finite_place(position, yaw_rad)?;
        here.position = position;
        here.yaw_rad = dwell_scene::math::wrap_angle(yaw_rad);
        here.pitch_rad = 0.0;
        here.velocity = Vec3::ZERO;
        here.collided = false;
        here.grounded = true;
        let here = *here;
        self.falls[agent.index()] = 0.0;
        if let Some(rigid) = self
            .engine
            .bodies
            .get_mut(self.agents[agent.index()].handle)
        {
            rigid.set_translation(position, true);
        }
        if let Some(grip) = self.grips.iter().find(|grip| grip.agent == agent) {
            let hand = to_rapier(&agents::hand_pose(grip, &here));
            let handle = self.bodies[grip.body as usize].handle;
            if let Some(rigid) = self.engine.bodies.get_mut(handle) {
                rigid.set_position(hand, true);
                rigid.set_linvel(Vec3::ZERO, true);
            }
        }
        self.flush();
        self.write_bodies(state);
        Ok(())
    }

    /// Takes over poses, velocities and joint positions that were set in `state` from outside: what differs from where
    /// physics has it is moved there and woken. Frozen and shut things that are moved become free.
    ///
    /// # Errors
    /// [`PhysicsError::ForeignState`] for another house's state; [`PhysicsError::Range`] for a pose that is not rigid.
    pub fn adopt(&mut self, state: &mut State) -> Result<(), PhysicsError> {
        self.check_state(state)?;
        let model = self.model.clone();
        for plan in &model.bodies {
            let pose = state.part_pose[plan.root()];
            let velocity = state.part_velocity[plan.root()];
            if !pose.is_valid() || !velocity.linear.is_finite() || !velocity.angular.is_finite() {
                return Err(PhysicsError::Range {
                    at: format!("part {}", plan.root().0),
                    field: "pose or velocity",
                    found: format!("{:?}", pose.position),
                    allowed: "finite numbers and a unit quaternion",
                });
            }
        }
        for joint in &self.joints {
            let articulation = &model.house.joints[joint.id];
            let wanted = state.joint_position[joint.id]
                .clamp(articulation.limits[0], articulation.limits[1]);
            let (now, _) = joints::read(&self.engine, joint, wanted);
            let child = joint.child as usize;
            if self.holds[child] == Hold::Latched
                && !joints::stands_shut(joint, articulation, wanted)
            {
                let body = self.bodies[child];
                joints::release(&mut self.engine, &body, &mut self.holds[child]);
            }
            if (now - wanted).abs() > 1e-5 {
                let place = joints::child_at(&self.engine, joint, articulation, wanted);
                if let Some(rigid) = self.engine.bodies.get_mut(self.bodies[child].handle) {
                    rigid.set_position(place, true);
                    rigid.set_linvel(Vec3::ZERO, true);
                    rigid.set_angvel(Vec3::ZERO, true);
                }
            }
        }
        for (index, plan) in model.bodies.iter().enumerate() {
            if plan.joint.is_some() {
                continue;
            }
            let pose = to_rapier(&state.part_pose[plan.root()]);
            let velocity = state.part_velocity[plan.root()];
            let Some(rigid) = self.engine.bodies.get_mut(self.bodies[index].handle) else {
                continue;
            };
            let moved = *rigid.position() != pose;
            if moved {
                self.holds[index] = Hold::Free;
                rigid.set_body_type(body::body_type(Hold::Free), true);
                rigid.set_position(pose, true);
            }
            let origin = rigid.position().translation;
            let now = (rigid.velocity_at_point(origin), rigid.angvel());
            if now != (velocity.linear, velocity.angular) {
                let arm = rigid.center_of_mass() - origin;
                rigid.set_linvel(velocity.linear + velocity.angular.cross(arm), true);
                rigid.set_angvel(velocity.angular, true);
            }
        }
        self.flush();
        self.write_bodies(state);
        self.write_contacts(state);
        Ok(())
    }

    pub(crate) fn check_state(&self, state: &State) -> Result<(), PhysicsError> {
        check_counts(&self.model.house, state)?;
        same("agents", state.agents.len(), self.agents.len())
    }

    /// Brings positions, contacts and queries up to date after a change from outside.
    pub(crate) fn flush(&mut self) {
        let hooks = Hooks {
            entries: &self.entries,
            table: &self.table,
            excluded: &self.excluded,
        };
        self.engine.flush(&hooks);
    }

    /// Writes poses, velocities and joints into the state.
    pub(crate) fn write_bodies(&self, state: &mut State) {
        for (plan, body) in self.model.bodies.iter().zip(&self.bodies) {
            body::write_parts(&self.engine, plan, body, state);
        }
        for joint in &self.joints {
            let near = state.joint_position[joint.id];
            let (position, velocity) = joints::read(&self.engine, joint, near);
            // A door that is shut stands at its closed position, whatever rounding says.
            let shut = self.holds[joint.child as usize] == Hold::Latched;
            let closed = self.model.house.joints[joint.id].closed;
            state.joint_position[joint.id] = if shut { closed } else { position };
            state.joint_velocity[joint.id] = if shut { 0.0 } else { velocity };
        }
    }

    pub(crate) fn write_contacts(&self, state: &mut State) {
        touching(
            &self.engine.narrow_phase,
            &self.engine.colliders,
            &self.entries,
            self.settings.config.touch_distance_m,
            &mut state.contacts,
        );
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
        "joint targets",
        state.joint_target.len(),
        house.joints.len(),
    )?;
    same("objects", state.held_by.len(), house.objects.len())
}

fn finite_place(position: Vec3, yaw_rad: f32) -> Result<(), PhysicsError> {
    if position.is_finite() && position.abs().max_element() <= 32_768.0 && yaw_rad.is_finite() {
        return Ok(());
    }
    Err(PhysicsError::Range {
        at: "agent".to_owned(),
        field: "position or yaw",
        found: format!("{position:?}, {yaw_rad}"),
        allowed: "finite numbers within 32768 m of the origin",
    })
}

/// Puts every joint's part where its joint says, unless it stands there already.
fn align_joints(model: &PhysicsModel, state: &mut State) {
    for (id, joint) in model.house.joints.iter_ids() {
        let parent = joint.parent.map_or(dwell_scene::Pose::IDENTITY, |parent| {
            state.part_pose[parent]
        });
        let pose = joint.world_from_child(&parent, state.joint_position[id]);
        let now = state.part_pose[joint.child];
        let near = (pose.position - now.position).length() < 1e-4
            && pose.rotation.dot(now.rotation).abs() > 1.0 - 1e-6;
        if !near {
            state.part_pose[joint.child] = pose;
        }
    }
}

impl Settings {
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

/// Where a body is, in the scene's words.
pub(crate) fn pose_of(engine: &Engine, body: &Body) -> Option<dwell_scene::Pose> {
    engine
        .bodies
        .get(body.handle)
        .map(|rigid| from_rapier(rigid.position()))
}
