//! Contact reports gathered while rapier steps.

use super::approach::ApproachMotion;
use super::body_motion::{BodyMotion, motion_before};
use super::collider_entry::{ColliderMetadata, ContactEntity, entry_index};
use super::friction;
use crate::engine::{FrictionImpulseLayout, points};
use glam::Vec3;
use rapier3d::dynamics::{RigidBodyHandle, RigidBodySet, SoftBodySet, SoftBodyTearEvent};
use rapier3d::geometry::{Collider, ColliderSet, CollisionEvent, ContactManifold, ContactPair};
use rapier3d::pipeline::EventHandler;
use std::sync::{Mutex, PoisonError};

/// The contact of one pair of colliders in one step, as rapier reports it.
pub(crate) struct ContactReport {
    pub(super) pair: (ContactEntity, ContactEntity),
    pub(super) classes: (u16, u16),
    /// N·s.
    pub(super) impulse: f32,
    /// Friction, N·s.
    pub(super) tangential: f32,
    /// Sum of position times impulse.
    pub(super) impulse_weighted_position: Vec3,
    /// Fastest approach along the normal before the step, m/s.
    pub(super) approach_speed_m_s: f32,
    /// Time at which the surfaces meet at that speed, from the beginning of the step, s.
    pub(super) time_of_impact_s: f32,
    /// Approach speed then, m/s.
    pub(super) impact_speed_m_s: f32,
    /// Sum of slip speed times impulse.
    pub(super) impulse_weighted_slip: f32,
    /// Relative speed of the centres of mass along the surface, m/s.
    pub(super) tangential_speed_m_s: f32,
    /// Sum of the normal impulses on the second body, N·s.
    pub(super) normal_impulse_on_second: Vec3,
    /// Total contact impulse on each of the two bodies, N·s, with the body; where it can be determined.
    pub(super) impulse_on_bodies: [Option<(RigidBodyHandle, Vec3)>; 2],
}

/// Gathers contacts while rapier steps.
pub(crate) struct ContactCollector<'a> {
    entries: &'a [ColliderMetadata],
    /// Speed below which nothing is reported, m/s.
    slowest: f32,
    /// Motion before the step of every body that was awake, by its arena index.
    before: &'a [BodyMotion],
    /// Rapier's layout of friction impulses.
    kept: FrictionImpulseLayout,
    reports: Mutex<Vec<ContactReport>>,
}

impl<'a> ContactCollector<'a> {
    pub(crate) fn new(
        entries: &'a [ColliderMetadata],
        before: &'a [BodyMotion],
        slowest: f32,
        kept: FrictionImpulseLayout,
    ) -> Self {
        Self {
            entries,
            slowest,
            before,
            kept,
            reports: Mutex::new(Vec::new()),
        }
    }

    /// Returns the step's reports in an order that does not depend on rapier's order of pairs.
    pub(crate) fn reports(self) -> Vec<ContactReport> {
        let mut reports = self
            .reports
            .into_inner()
            .unwrap_or_else(PoisonError::into_inner);
        reports.sort_by(|a, b| {
            (a.pair, a.classes, a.impulse.to_bits()).cmp(&(b.pair, b.classes, b.impulse.to_bits()))
        });
        friction::friction_from_momentum(&mut reports);
        reports
    }

    fn report(
        &self,
        bodies: &RigidBodySet,
        colliders: &ColliderSet,
        pair: &ContactPair,
    ) -> Option<ContactReport> {
        let (one, two) = (&colliders[pair.collider1], &colliders[pair.collider2]);
        let a = self.entries.get(entry_index(one))?;
        let b = self.entries.get(entry_index(two))?;
        let (touch_a, touch_b) = (a.contact_entity?, b.contact_entity?);
        let motions = (
            motion_before(self.before, one.parent()),
            motion_before(self.before, two.parent()),
        );
        if motions.0.max_point_speed_m_s + motions.1.max_point_speed_m_s < self.slowest {
            return None;
        }
        let mut report = ContactReport {
            pair: (touch_a.min(touch_b), touch_a.max(touch_b)),
            classes: (0, 0),
            impulse: 0.0,
            tangential: 0.0,
            impulse_weighted_position: Vec3::ZERO,
            approach_speed_m_s: 0.0,
            time_of_impact_s: 0.0,
            impact_speed_m_s: 0.0,
            impulse_weighted_slip: 0.0,
            tangential_speed_m_s: 0.0,
            normal_impulse_on_second: Vec3::ZERO,
            impulse_on_bodies: [(one, &motions.0), (two, &motions.1)]
                .map(|(collider, motion)| self.body_contact_impulse(bodies, collider, motion)),
        };
        let mut strongest = 0.0;
        for manifold in pair.solver_manifolds() {
            let here = report.add(manifold, bodies, &motions, self.kept);
            if here > strongest {
                strongest = here;
                let classes = (
                    a.surface.class(manifold.subshape1),
                    b.surface.class(manifold.subshape2),
                );
                report.classes = if touch_a > touch_b {
                    (classes.1, classes.0)
                } else {
                    classes
                };
            }
        }
        // Seen from the entity that sorts first.
        if touch_a > touch_b {
            report.normal_impulse_on_second = -report.normal_impulse_on_second;
            report.impulse_on_bodies.swap(0, 1);
        }
        (report.impulse > 0.0).then_some(report)
    }

    /// Returns the contact impulse on the body of a collider in the step, N·s.
    fn body_contact_impulse(
        &self,
        bodies: &RigidBodySet,
        collider: &Collider,
        motion: &BodyMotion,
    ) -> Option<(RigidBodyHandle, Vec3)> {
        if !self.kept.single_solver_call {
            return None;
        }
        let handle = collider.parent()?;
        let body = bodies.get(handle)?;
        let untouched = motion.linear + motion.free_velocity_change?;
        Some((handle, (body.linvel() - untouched) * body.mass()))
    }
}

impl ContactReport {
    /// Adds a plane of contact; returns its normal impulse.
    fn add(
        &mut self,
        manifold: &ContactManifold,
        bodies: &RigidBodySet,
        (a, b): &(BodyMotion, BodyMotion),
        kept: FrictionImpulseLayout,
    ) -> f32 {
        let normal = manifold.data.normal;
        let mut here = 0.0;
        for (contact, point) in points(manifold) {
            let push = point.impulse;
            if push <= 0.0 {
                continue;
            }
            let approach = ApproachMotion::of(manifold, contact, bodies, (a, b));
            if approach.approach_speed_m_s > self.approach_speed_m_s {
                self.approach_speed_m_s = approach.approach_speed_m_s;
                self.impact_speed_m_s = approach.impact_speed_m_s;
                self.time_of_impact_s = approach.time_of_impact_s;
            }
            let place = approach.midpoint;
            let along = approach.relative_velocity - normal * approach.approach_speed_m_s;
            here += push;
            self.impulse_weighted_position += place * push;
            self.impulse_weighted_slip += along.length() * push;
        }
        let passing = a.linear - b.linear;
        let along = (passing - normal * passing.dot(normal)).length();
        self.tangential_speed_m_s = self.tangential_speed_m_s.max(along);
        self.impulse += here;
        self.normal_impulse_on_second += normal * here;
        self.tangential += kept.estimated_step_friction(manifold);
        here
    }
}

impl EventHandler for ContactCollector<'_> {
    fn handle_collision_event(
        &self,
        _bodies: &RigidBodySet,
        _colliders: &ColliderSet,
        _event: CollisionEvent,
        _pair: Option<&ContactPair>,
    ) {
    }

    fn handle_contact_force_event(
        &self,
        _dt: f32,
        bodies: &RigidBodySet,
        colliders: &ColliderSet,
        pair: &ContactPair,
        _total_force: f32,
    ) {
        if let Some(report) = self.report(bodies, colliders, pair) {
            self.reports
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .push(report);
        }
    }

    fn handle_soft_body_tear_event(&self, _soft: &SoftBodySet, _event: &SoftBodyTearEvent) {}
}
