//! rapier's parts in one struct.

mod contact_compliance;
mod contact_points;
mod lost_bodies;
mod pair_reduction;
mod sleeping_cache;
mod workspace;

pub(crate) use contact_compliance::ContactCompliance;
pub(crate) use contact_points::{FrictionImpulseLayout, points};
pub use pair_reduction::PairCounts;
pub(crate) use sleeping_cache::SleepingIslandCache;

use crate::config::ResolvedConfig;
use dwell_scene::interrupt;
use glam::Vec3;
use rapier3d::dynamics::{
    FrictionModel, ImpulseJointSet, IntegrationParameters, IslandManager, RigidBody,
    RigidBodyHandle, RigidBodySet, RigidBodyType,
};
use rapier3d::geometry::{
    BroadPhaseBvh, Collider, ColliderHandle, ColliderSet, ContactPair, NarrowPhase,
};
use rapier3d::math::Pose;
use rapier3d::pipeline::{EventHandler, PhysicsHooks, QueryFilter, QueryPipeline};
use workspace::Workspace;

/// Most steps of zero length until rapier's tree is restored.
const MOST_FLUSHES: usize = 4;

/// The rapier simulation.
#[derive(Clone)]
pub(crate) struct RapierWorld {
    pub(crate) gravity: Vec3,
    parameters: IntegrationParameters,
    /// Runs of rapier in a physics step: 1, or as many as soft contacts need.
    runs: u32,
    /// Set if contacts are compliant.
    soft: bool,
    workspace: Workspace,
    /// Bodies that rapier removed since the last call, because their position or velocity is not finite.
    lost: Vec<RigidBodyHandle>,
    pub(crate) sleeping_cache: SleepingIslandCache,
    pub(crate) islands: IslandManager,
    pub(crate) broad_phase: BroadPhaseBvh,
    pub(crate) narrow_phase: NarrowPhase,
    pub(crate) bodies: RigidBodySet,
    pub(crate) colliders: ColliderSet,
    pub(crate) joints: ImpulseJointSet,
}

impl RapierWorld {
    pub(crate) fn new(settings: &ResolvedConfig, gravity_m_s2: f32) -> Self {
        Self {
            gravity: Vec3::new(0.0, -gravity_m_s2, 0.0),
            parameters: contact_compliance::rigid_contact_parameters(settings),
            runs: 1,
            soft: false,
            workspace: Workspace::new(),
            lost: Vec::new(),
            sleeping_cache: SleepingIslandCache::default(),
            islands: IslandManager::new(),
            broad_phase: BroadPhaseBvh::new(),
            narrow_phase: NarrowPhase::new(),
            bodies: RigidBodySet::new(),
            colliders: ColliderSet::new(),
            joints: ImpulseJointSet::new(),
        }
    }

    /// Sets the contact compliance of a law, or the stiffest contacts that the rate allows.
    pub(crate) fn set_compliance(
        &mut self,
        settings: &ResolvedConfig,
        compliance: Option<ContactCompliance>,
    ) {
        self.soft = compliance.is_some();
        (self.parameters, self.runs) = match compliance {
            Some(compliance) => {
                contact_compliance::compliant_contact_parameters(settings, compliance)
            }
            None => (contact_compliance::rigid_contact_parameters(settings), 1),
        };
    }

    pub(crate) fn parameters(&self) -> &IntegrationParameters {
        &self.parameters
    }

    /// Returns the length of one run of rapier, s: the time over which it keeps impulses.
    pub(crate) fn solver_call_s(&self) -> f32 {
        self.parameters.dt
    }

    /// Returns the length of a physics step, s.
    pub(crate) fn step_s(&self) -> f32 {
        self.parameters.dt * self.runs as f32
    }

    /// Returns the layout of friction impulses in contact points.
    pub(crate) fn friction_storage(&self) -> FrictionImpulseLayout {
        FrictionImpulseLayout {
            patch_friction: self.parameters.friction_model == FrictionModel::Simplified,
            single_solver_call: self.runs == 1,
        }
    }

    /// Returns whether rapier runs several times in a physics step; contact data is then of the last run.
    pub(crate) fn has_multiple_solver_calls(&self) -> bool {
        self.runs > 1
    }

    /// Returns the number of solver substeps in a physics step.
    pub(crate) fn substeps(&self) -> u32 {
        self.runs * self.parameters.num_solver_iterations as u32
    }

    /// Returns the length of a solver substep, s.
    pub(crate) fn substep_s(&self) -> f32 {
        self.parameters.dt / self.parameters.num_solver_iterations as f32
    }

    /// Returns the awake bodies that move, have no joint and no support, in the order of the islands.
    pub(crate) fn bodies_in_free_flight(&self) -> Vec<RigidBodyHandle> {
        let flies = |handle: &RigidBodyHandle| {
            self.bodies.get(*handle).is_some_and(|body| {
                body.is_dynamic()
                    && body.gravity_scale() != 0.0
                    && self.joints.attached_joints(*handle).next().is_none()
                    && !self.is_supported(body)
            })
        };
        self.islands.active_bodies().filter(flies).collect()
    }

    /// Returns the part of a step for which gravity acts on a body that hits something in it, s.
    pub(crate) fn gravity_time_s(&self, flies: bool) -> f32 {
        self.parameters.dt - if flies { 0.5 * self.substep_s() } else { 0.0 }
    }

    /// Returns the pairs of a body's colliders with others.
    pub(crate) fn contact_pairs_of<'a>(
        &'a self,
        body: &'a RigidBody,
    ) -> impl Iterator<Item = &'a ContactPair> {
        let pairs = |collider: &ColliderHandle| self.narrow_phase.contact_pairs_with(*collider);
        body.colliders().iter().flat_map(pairs)
    }

    /// Returns whether something pressed on a body in the last step.
    fn is_pressed(&self, body: &RigidBody) -> bool {
        if self.soft {
            return self
                .contact_pairs_of(body)
                .any(ContactPair::has_any_active_contact);
        }
        self.contact_pairs_of(body)
            .flat_map(ContactPair::solver_manifolds)
            .flat_map(points)
            .any(|(_, point)| point.impulse > 0.0)
    }

    /// Returns whether a body is supported: by something that presses, and is not left at a speed that a step of gravity
    /// does not take back; or that is so close below, at so low a speed, that its bounces would last two steps. Compliant
    /// contacts support as long as they touch.
    fn is_supported(&self, body: &RigidBody) -> bool {
        if self.soft {
            return self.is_pressed(body);
        }
        let pull = self.gravity.length();
        let slow = pull * self.parameters.dt;
        self.contact_pairs_of(body).any(|pair| {
            let motion = |collider: ColliderHandle| {
                let parent = self.colliders.get(collider).and_then(Collider::parent);
                let parent = parent.and_then(|parent| self.bodies.get(parent));
                parent.map_or((Vec3::ZERO, Vec3::ZERO), |parent| {
                    (parent.linvel(), parent.angvel())
                })
            };
            let (one, two) = (motion(pair.collider1), motion(pair.collider2));
            pair.solver_manifolds().iter().any(|plane| {
                points(plane).any(|(contact, point)| {
                    // The arms do not turn with a wheel.
                    let away = two.0 + two.1.cross(point.solver_dp2);
                    let parting = away - one.0 - one.1.cross(point.solver_dp1);
                    let parting = parting.dot(plane.data.normal);
                    let gap = || {
                        let data = &plane.data;
                        let (p, q) = data.solver_contact_world_points(contact, &self.bodies);
                        (q - p).dot(data.normal)
                    };
                    (point.impulse > 0.0 && parting < slow)
                        || parting * parting + 2.0 * pull * gap() < slow * slow
                })
            })
        })
    }

    /// Adds a share of a substep's gravity to the velocities of bodies.
    fn apply_gravity(&mut self, flying: &[RigidBodyHandle], share: f32) {
        let change = self.gravity * (self.substep_s() * share);
        for handle in flying {
            if let Some(body) = self.bodies.get_mut(*handle) {
                let velocity = body.linvel() + change * body.gravity_scale();
                body.set_linvel(velocity, false);
            }
        }
    }

    /// Makes one physics step.
    ///
    /// Gravity acts at the beginning of rapier's substeps, so that a body would fall half a substep ahead of its time.
    /// Bodies in free flight (`flying`: [`RapierWorld::bodies_in_free_flight`]) have half of one substep's gravity subtracted
    /// before and added after: they then follow their parabola exactly (the leapfrog method). A body that hit something in
    /// the step keeps the velocity that the contact gave it. Returns the bodies in free flight that hit something.
    pub(crate) fn step(
        &mut self,
        flying: Vec<RigidBodyHandle>,
        hooks: &dyn PhysicsHooks,
        events: &dyn EventHandler,
    ) -> Vec<RigidBodyHandle> {
        let awake: Vec<RigidBodyHandle> = self.islands.active_bodies().collect();
        self.apply_gravity(&flying, -0.5);
        self.advance(hooks, events);
        let hit = |handle: &RigidBodyHandle| {
            let body = self.bodies.get(*handle);
            body.is_some_and(|body| self.is_pressed(body))
        };
        let (landed, flew): (Vec<RigidBodyHandle>, Vec<RigidBodyHandle>) =
            flying.into_iter().partition(hit);
        self.apply_gravity(&flew, 0.5);
        self.shrink_sleeping_bounds(&awake);
        self.workspace.shrink_to_fit(awake.len());
        landed
    }

    fn advance(&mut self, hooks: &dyn PhysicsHooks, events: &dyn EventHandler) {
        let parameters = self.parameters;
        if self.runs == 1 {
            self.run(&parameters, hooks, events);
            return;
        }
        // Kinematic bodies move an equal part of the way in each run.
        let led: Vec<(RigidBodyHandle, Pose, Pose)> = self
            .bodies
            .iter()
            .filter(|(_, body)| body.body_type() == RigidBodyType::KinematicPositionBased)
            .map(|(handle, body)| (handle, *body.position(), *body.next_position()))
            .filter(|(_, from, to)| from != to)
            .collect();
        for run in 1..=self.runs {
            interrupt::unwind_if_cancelled();
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

    /// Applies changes from outside, without letting time pass: positions, contacts and the query tree are up to date
    /// afterwards, and nothing is marked as changed.
    pub(crate) fn flush(&mut self, hooks: &dyn PhysicsHooks) {
        let parameters = IntegrationParameters {
            dt: 0.0,
            ..self.parameters
        };
        // rapier 0.36.1 puts its tree aside when it plans to improve it, and a step of zero length ends before the tree is
        // restored; the next one begins with that.
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
        let workspace = &mut self.workspace;
        workspace.pipeline.step(
            self.gravity,
            parameters,
            &mut self.islands,
            &mut self.broad_phase,
            &mut self.narrow_phase,
            &mut self.bodies,
            &mut self.colliders,
            &mut self.joints,
            &mut workspace.multibodies,
            &mut workspace.soft_bodies,
            &mut workspace.ccd,
            hooks,
            events,
        );
        let found = workspace.pipeline.quarantine().bodies();
        self.lost.extend_from_slice(found);
    }

    /// Returns the bodies that rapier removed since the last call.
    pub(crate) fn take_removed_bodies(&mut self) -> Vec<RigidBodyHandle> {
        std::mem::take(&mut self.lost)
    }

    /// Returns spatial queries.
    pub(crate) fn queries<'a>(&'a self, filter: QueryFilter<'a>) -> QueryPipeline<'a> {
        self.broad_phase.as_query_pipeline(
            self.narrow_phase.query_dispatcher(),
            &self.bodies,
            &self.colliders,
            filter,
        )
    }
}
