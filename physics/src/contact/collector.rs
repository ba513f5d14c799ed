//! What rapier tells of contacts while it steps.

use super::entry::{Entry, Toucher, entry_index};
use super::ongoing::Ongoing;
use crate::engine::Engine;
use glam::{Quat, Vec3};
use rapier3d::dynamics::{
    RigidBody, RigidBodyHandle, RigidBodySet, SoftBodySet, SoftBodyTearEvent,
};
use rapier3d::geometry::{
    ColliderSet, CollisionEvent, ContactManifold, ContactPair, SolverContact,
};
use rapier3d::pipeline::EventHandler;
use std::sync::{Mutex, PoisonError};

/// What rapier reports of one pair of colliders in one step.
pub(super) struct Report {
    pub(super) pair: (Toucher, Toucher),
    pub(super) classes: (u16, u16),
    /// N·s.
    pub(super) impulse: f32,
    /// Friction, N·s.
    pub(super) tangential: f32,
    /// Sum of position times impulse.
    pub(super) moment: Vec3,
    /// Fastest approach along the normal before the step, m/s.
    pub(super) speed: f32,
    /// When the surfaces meet at that speed, from the beginning of the step, s.
    pub(super) meets_s: f32,
    /// How fast they approach then, m/s.
    pub(super) meeting: f32,
    /// Sum of slip speed times impulse.
    pub(super) slip: f32,
    /// How fast the centres of mass pass each other along the surface, m/s.
    pub(super) passing: f32,
}

/// Where a body is and how it moves before the step, at its centre of mass.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Motion {
    awake: bool,
    linear: Vec3,
    angular: Vec3,
    center: Vec3,
    rotation: Quat,
    /// What gravity adds to its velocity, m/s².
    gravity: Vec3,
    /// How far it would stand ahead if the last step had not stopped it at a surface, m.
    ahead: Vec3,
    /// A bound on the speed of all its points, m/s.
    fastest: f32,
}

impl Motion {
    /// How far the body would have gone on in the step since then, when it was stopped on its way and kept its speed.
    pub(super) fn held_back(&self, body: &RigidBody, dt_s: f32) -> Option<Vec3> {
        let fell = self.linear + self.gravity * dt_s;
        let free = (self.linear + fell) * (0.5 * dt_s);
        let rest = free - (body.center_of_mass() - self.center);
        let kept_speed = (body.linvel() - fell).length_squared() < 1e-4 * fell.length_squared();
        let stopped = rest.length_squared() > 1e-3 * free.length_squared();
        (self.awake && kept_speed && stopped).then_some(rest)
    }

    fn of(body: &RigidBody, gravity: Vec3, ahead: Vec3) -> Self {
        let (linear, angular) = (body.linvel(), body.angvel());
        let reach = body.mass_properties().max_extent();
        let falls = if body.is_dynamic() {
            body.gravity_scale()
        } else {
            0.0
        };
        Self {
            awake: true,
            linear,
            angular,
            center: body.center_of_mass(),
            rotation: *body.rotation(),
            gravity: gravity * falls,
            ahead,
            fastest: linear.length() + angular.length() * reach,
        }
    }

    fn at(&self, point: Vec3) -> Vec3 {
        self.linear + self.angular.cross(point - self.center)
    }
}

/// Notes the motion of all bodies that are awake before a step.
pub(crate) fn note_motion(engine: &Engine, ongoing: &Ongoing, out: &mut Vec<Motion>) {
    out.clear();
    for handle in engine.islands.active_bodies() {
        let Some(body) = engine.bodies.get(handle) else {
            continue;
        };
        let index = handle.into_raw_parts().0 as usize;
        if out.len() <= index {
            out.resize(index + 1, Motion::default());
        }
        let ahead = ongoing.held_back.get(&(index as u32)).copied();
        out[index] = Motion::of(body, engine.gravity, ahead.unwrap_or(Vec3::ZERO));
    }
}

/// Gathers contacts while rapier steps.
pub(crate) struct Collector<'a> {
    entries: &'a [Entry],
    /// Below this nothing is told, m/s.
    slowest: f32,
    /// Motion before the step of every body that was awake, by its arena index.
    before: &'a [Motion],
    reports: Mutex<Vec<Report>>,
}

impl<'a> Collector<'a> {
    pub(crate) fn new(entries: &'a [Entry], before: &'a [Motion], slowest: f32) -> Self {
        Self {
            entries,
            slowest,
            before,
            reports: Mutex::new(Vec::new()),
        }
    }

    /// The step's reports in an order that does not depend on rapier's order of pairs.
    pub(super) fn reports(self) -> Vec<Report> {
        let mut reports = self
            .reports
            .into_inner()
            .unwrap_or_else(PoisonError::into_inner);
        reports.sort_by(|a, b| {
            (a.pair, a.classes, a.impulse.to_bits()).cmp(&(b.pair, b.classes, b.impulse.to_bits()))
        });
        reports
    }

    fn motion(&self, body: Option<RigidBodyHandle>) -> Motion {
        body.and_then(|body| self.before.get(body.into_raw_parts().0 as usize))
            .copied()
            .unwrap_or_default()
    }

    fn report(
        &self,
        bodies: &RigidBodySet,
        colliders: &ColliderSet,
        pair: &ContactPair,
    ) -> Option<Report> {
        let (one, two) = (&colliders[pair.collider1], &colliders[pair.collider2]);
        let a = self.entries.get(entry_index(one))?;
        let b = self.entries.get(entry_index(two))?;
        let (touch_a, touch_b) = (a.toucher?, b.toucher?);
        let motions = (self.motion(one.parent()), self.motion(two.parent()));
        if motions.0.fastest + motions.1.fastest < self.slowest {
            return None;
        }
        let mut report = Report {
            pair: (touch_a.min(touch_b), touch_a.max(touch_b)),
            classes: (0, 0),
            impulse: 0.0,
            tangential: 0.0,
            moment: Vec3::ZERO,
            speed: 0.0,
            meets_s: 0.0,
            meeting: 0.0,
            slip: 0.0,
            passing: 0.0,
        };
        let mut strongest = 0.0;
        for manifold in pair.solver_manifolds() {
            let here = report.add(manifold, bodies, &motions);
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
        (report.impulse > 0.0).then_some(report)
    }
}

impl Report {
    /// Adds a plane of contact; returns its normal impulse.
    fn add(
        &mut self,
        manifold: &ContactManifold,
        bodies: &RigidBodySet,
        (a, b): &(Motion, Motion),
    ) -> f32 {
        let normal = manifold.data.normal;
        let mut here = 0.0;
        let mut friction = Vec3::ZERO;
        for contact in &manifold.data.solver_contacts {
            let index = contact.contact_indices()[0] as usize;
            let Some(point) = manifold.points.get(index) else {
                continue;
            };
            friction += point.data.warmstart_tangent_world;
            let push = point.data.impulse;
            if push <= 0.0 {
                continue;
            }
            let (p, q) = ends_before(manifold, contact, bodies, (a, b));
            let place = (p + q) * 0.5;
            let relative = a.at(place) - b.at(place);
            let approach = relative.dot(normal);
            if approach > self.speed {
                self.speed = approach;
                let gap = (q - p + b.ahead - a.ahead).dot(normal);
                let pull = (a.gravity - b.gravity).dot(normal);
                self.meeting = meeting_speed(gap, approach, pull);
                self.meets_s = 2.0 * gap / (approach + self.meeting).max(1e-6);
            }
            here += push;
            self.moment += place * push;
            self.slip += (relative - normal * approach).length() * push;
        }
        let passing = a.linear - b.linear;
        let along = (passing - normal * passing.dot(normal)).length();
        self.passing = self.passing.max(along);
        self.impulse += here;
        self.tangential += friction.length();
        here
    }
}

/// How fast surfaces meet that are a `gap` apart and approach at `speed`, faster by `acceleration`; they meet after twice the
/// gap over the sum of both speeds, which is negative when they met before.
fn meeting_speed(gap: f32, speed: f32, acceleration: f32) -> f32 {
    (speed * speed + 2.0 * acceleration * gap).max(0.0).sqrt()
}

/// Where the two surfaces of a contact point stood before the step.
fn ends_before(
    manifold: &ContactManifold,
    contact: &SolverContact,
    bodies: &RigidBodySet,
    (a, b): (&Motion, &Motion),
) -> (Vec3, Vec3) {
    let (p, q) = manifold.data.solver_contact_world_points(contact, bodies);
    // Anchors ride on their bodies, or stand in the world.
    let before = |now: Vec3, anchor: Vec3, motion: &Motion, in_world: bool| {
        if motion.awake && !in_world {
            motion.center + motion.rotation * anchor
        } else {
            now
        }
    };
    let dominance = manifold.data.relative_dominance;
    (
        before(p, contact.anchor1, a, dominance > 0),
        before(q, contact.anchor2, b, dominance < 0),
    )
}

impl EventHandler for Collector<'_> {
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
