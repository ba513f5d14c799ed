//! rapier's parts in one place.

use crate::config::Settings;
use glam::Vec3;
use rapier3d::dynamics::{
    CCDSolver, ImpulseJointSet, IntegrationParameters, IslandManager, MultibodyJointSet,
    RigidBodySet, SoftBodySet, SpringCoefficients,
};
use rapier3d::geometry::{BroadPhaseBvh, ColliderSet, NarrowPhase};
use rapier3d::pipeline::{EventHandler, PhysicsHooks, PhysicsPipeline, QueryFilter, QueryPipeline};

/// Natural frequency of contacts, as a share of the substep rate. A body sinks by g over its square: 0.04 mm at 4 substeps
/// and 120 Hz.
const CONTACT_FREQUENCY: f32 = 1.0 / 6.0;
/// The same against what never moves.
const STATIC_CONTACT_FREQUENCY: f32 = 0.25;
/// Steps of no length until the tree is back.
const MOST_FLUSHES: usize = 4;
/// Damping ratio of contacts, as rapier has it.
const CONTACT_DAMPING_RATIO: f32 = 10.0;

/// The simulation itself. Workspaces that hold nothing between steps are made anew when it is cloned.
pub(crate) struct Engine {
    pub(crate) gravity: Vec3,
    parameters: IntegrationParameters,
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
        let substeps = settings.config.solver_substeps as f32;
        let substep_hz = substeps / settings.dt_s;
        let softness = |share: f32| SpringCoefficients {
            natural_frequency: share * substep_hz,
            damping_ratio: CONTACT_DAMPING_RATIO,
        };
        let parameters = IntegrationParameters {
            dt: settings.dt_s,
            min_ccd_dt: settings.dt_s / 100.0,
            num_solver_iterations: settings.config.solver_substeps as usize,
            contact_softness: softness(CONTACT_FREQUENCY),
            static_contact_softness: softness(STATIC_CONTACT_FREQUENCY),
            ..IntegrationParameters::default()
        };
        Self {
            gravity: Vec3::new(0.0, -gravity_m_s2, 0.0),
            parameters,
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

    /// One physics step.
    pub(crate) fn step(&mut self, hooks: &dyn PhysicsHooks, events: &dyn EventHandler) {
        let parameters = self.parameters;
        self.run(&parameters, hooks, events);
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
