//! rapier's parts in one place.

use crate::config::Settings;
use crate::laws::Compliance;
use crate::softness;
use glam::Vec3;
use rapier3d::dynamics::{
    CCDSolver, FrictionModel, ImpulseJointSet, IntegrationParameters, IslandManager,
    MultibodyJointSet, RigidBody, RigidBodyHandle, RigidBodySet, RigidBodyType, SoftBodySet,
};
use rapier3d::geometry::{BroadPhaseBvh, ColliderSet, ContactPair, NarrowPhase};
use rapier3d::math::Pose;
use rapier3d::pipeline::{EventHandler, PhysicsHooks, PhysicsPipeline, QueryFilter, QueryPipeline};

/// Steps of no length until the tree is back.
const MOST_FLUSHES: usize = 4;
/// The simulation itself. Workspaces that hold nothing between steps are made anew when it is cloned.
pub(crate) struct Engine {
    pub(crate) gravity: Vec3,
    parameters: IntegrationParameters,
    /// Runs of rapier in a physics step: 1, or as many as soft contacts need.
    runs: u32,
    pipeline: PhysicsPipeline,
    ccd: CCDSolver,
    multibodies: MultibodyJointSet,
    soft_bodies: SoftBodySet,
    pub(crate) islands: IslandManager,
    pub(crate) broad_phase: BroadPhaseBvh,
    pub(crate) narrow_phase: NarrowPhase,
    pub(crate) bodies: RigidBodySet,
    pub(crate) colliders: ColliderSet,
    pub(crate) joints: ImpulseJointSet,
}

impl Clone for Engine {
    fn clone(&self) -> Self {
        Self {
            gravity: self.gravity,
            parameters: self.parameters,
            runs: self.runs,
            pipeline: PhysicsPipeline::new(),
            ccd: CCDSolver::new(),
            multibodies: MultibodyJointSet::new(),
            soft_bodies: SoftBodySet::new(),
            islands: self.islands.clone(),
            broad_phase: self.broad_phase.clone(),
            narrow_phase: self.narrow_phase.clone(),
            bodies: self.bodies.clone(),
            colliders: self.colliders.clone(),
            joints: self.joints.clone(),
        }
    }
}

impl Engine {
    pub(crate) fn new(settings: &Settings, gravity_m_s2: f32) -> Self {
        Self {
            gravity: Vec3::new(0.0, -gravity_m_s2, 0.0),
            parameters: softness::rigid(settings),
            runs: 1,
            pipeline: PhysicsPipeline::new(),
            ccd: CCDSolver::new(),
            multibodies: MultibodyJointSet::new(),
            soft_bodies: SoftBodySet::new(),
            islands: IslandManager::new(),
            broad_phase: BroadPhaseBvh::new(),
            narrow_phase: NarrowPhase::new(),
            bodies: RigidBodySet::new(),
            colliders: ColliderSet::new(),
            joints: ImpulseJointSet::new(),
        }
    }

    /// Makes contacts give as a law says, or as hard as the rate allows.
    pub(crate) fn soften(&mut self, settings: &Settings, compliance: Option<Compliance>) {
        (self.parameters, self.runs) = match compliance {
            Some(compliance) => softness::soft(settings, compliance),
            None => (softness::rigid(settings), 1),
        };
    }

    pub(crate) fn parameters(&self) -> &IntegrationParameters {
        &self.parameters
    }

    /// Length of one run of rapier, s: the time over which it keeps impulses.
    pub(crate) fn run_s(&self) -> f32 {
        self.parameters.dt
    }

    /// Whether points of one plane share their friction.
    pub(crate) fn friction_by_patch(&self) -> bool {
        self.parameters.friction_model == FrictionModel::Simplified
    }

    /// Solver substeps in a physics step.
    pub(crate) fn substeps(&self) -> u32 {
        self.runs * self.parameters.num_solver_iterations as u32
    }

    /// Length of a solver substep, s.
    pub(crate) fn substep_s(&self) -> f32 {
        self.parameters.dt / self.parameters.num_solver_iterations as f32
    }

    /// Those of the bodies awake that move, touch nothing and hang on no joint, from before a step.
    fn in_free_flight(&self, awake: &[RigidBodyHandle]) -> Vec<RigidBodyHandle> {
        let flies = |handle: &&RigidBodyHandle| {
            self.bodies.get(**handle).is_some_and(|body| {
                body.is_dynamic()
                    && body.gravity_scale() != 0.0
                    && self.joints.attached_joints(**handle).next().is_none()
                    && !self.touches(body)
            })
        };
        awake.iter().filter(flies).copied().collect()
    }

    fn touches(&self, body: &RigidBody) -> bool {
        let mut pairs = body
            .colliders()
            .iter()
            .flat_map(|collider| self.narrow_phase.contact_pairs_with(*collider));
        pairs.any(ContactPair::has_any_active_contact)
    }

    /// Adds a share of what gravity adds in a substep to the velocities of bodies.
    fn fall(&mut self, flying: &[RigidBodyHandle], share: f32) {
        let change = self.gravity * (self.substep_s() * share);
        for handle in flying {
            if let Some(body) = self.bodies.get_mut(*handle) {
                let velocity = body.linvel() + change * body.gravity_scale();
                body.set_linvel(velocity, false);
            }
        }
    }

    /// One physics step.
    ///
    /// Gravity acts at the beginning of rapier's substeps, so that a body would fall half a substep ahead of its time. What
    /// flies freely has half of one substep's gravity taken off before and added after: then it follows its parabola
    /// exactly (the leapfrog method). What touched something in the step keeps what the contact made of its velocity.
    pub(crate) fn step(&mut self, hooks: &dyn PhysicsHooks, events: &dyn EventHandler) {
        let awake: Vec<RigidBodyHandle> = self.islands.active_bodies().collect();
        let mut flying = self.in_free_flight(&awake);
        self.fall(&flying, -0.5);
        self.advance(hooks, events);
        flying.retain(|handle| {
            let body = self.bodies.get(*handle);
            body.is_some_and(|body| !self.touches(body))
        });
        self.fall(&flying, 0.5);
        self.tighten(&awake);
    }

    fn advance(&mut self, hooks: &dyn PhysicsHooks, events: &dyn EventHandler) {
        let parameters = self.parameters;
        if self.runs == 1 {
            self.run(&parameters, hooks, events);
            return;
        }
        // What is led from place to place goes an equal part of the way in each run.
        let led: Vec<(RigidBodyHandle, Pose, Pose)> = self
            .bodies
            .iter()
            .filter(|(_, body)| body.body_type() == RigidBodyType::KinematicPositionBased)
            .map(|(handle, body)| (handle, *body.position(), *body.next_position()))
            .filter(|(_, from, to)| from != to)
            .collect();
        for run in 1..=self.runs {
            for (handle, from, to) in &led {
                let share = run as f32 / self.runs as f32;
                let place = if run == self.runs {
                    *to
                } else {
                    from.lerp(to, share)
                };
                if let Some(body) = self.bodies.get_mut(*handle) {
                    body.set_next_kinematic_position(place);
                }
            }
            self.run(&parameters, hooks, events);
        }
    }

    /// Takes over what was changed from outside, without letting time pass: positions, contacts and the tree for queries
    /// are up to date afterwards, and nothing is marked as changed.
    pub(crate) fn flush(&mut self, hooks: &dyn PhysicsHooks) {
        let parameters = IntegrationParameters {
            dt: 0.0,
            ..self.parameters
        };
        // rapier 0.36.1 puts its tree aside when it plans to improve it, and a step of no length ends before the tree is
        // put back; the next one begins with that.
        for _ in 0..MOST_FLUSHES {
            self.run(&parameters, hooks, &());
            if !self.queries(QueryFilter::default()).bvh.is_empty() {
                break;
            }
        }
    }

    fn run(
        &mut self,
        parameters: &IntegrationParameters,
        hooks: &dyn PhysicsHooks,
        events: &dyn EventHandler,
    ) {
        self.pipeline.step(
            self.gravity,
            parameters,
            &mut self.islands,
            &mut self.broad_phase,
            &mut self.narrow_phase,
            &mut self.bodies,
            &mut self.colliders,
            &mut self.joints,
            &mut self.multibodies,
            &mut self.soft_bodies,
            &mut self.ccd,
            hooks,
            events,
        );
    }

    /// Questions about where things are.
    pub(crate) fn queries<'a>(&'a self, filter: QueryFilter<'a>) -> QueryPipeline<'a> {
        self.broad_phase.as_query_pipeline(
            self.narrow_phase.query_dispatcher(),
            &self.bodies,
            &self.colliders,
            filter,
        )
    }
}
