//! Approach of two surfaces at a contact point.

use super::body_motion::BodyMotion;
use glam::Vec3;
use rapier3d::dynamics::RigidBodySet;
use rapier3d::geometry::{ContactManifold, SolverContact};

/// Two surfaces at a contact point, before a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct ApproachMotion {
    /// The midpoint between the two.
    pub(super) midpoint: Vec3,
    /// From the centre of mass of each to its surface, m.
    pub(super) lever_arms: [Vec3; 2],
    /// Velocity of the first relative to the second, m/s.
    pub(super) relative_velocity: Vec3,
    /// Approach speed along the normal, m/s; negative when they part.
    pub(super) approach_speed_m_s: f32,
    /// Approach speed when they meet, m/s.
    pub(super) impact_speed_m_s: f32,
    /// When they meet, from the beginning of the step, s; negative when they met before.
    pub(super) time_of_impact_s: f32,
}

impl ApproachMotion {
    /// Computes it from the surfaces' positions before the step. `motions`: of the manifold's first and second body.
    pub(super) fn of(
        manifold: &ContactManifold,
        contact: &SolverContact,
        bodies: &RigidBodySet,
        (a, b): (&BodyMotion, &BodyMotion),
    ) -> Self {
        let normal = manifold.data.normal;
        let (p, q) = surface_points_before_step(manifold, contact, bodies, (a, b));
        let place = (p + q) * 0.5;
        let relative = a.velocity_at(place) - b.velocity_at(place);
        let speed = relative.dot(normal);
        let gap = (q - p + b.undone_displacement_m - a.undone_displacement_m).dot(normal);
        let pull = (a.gravity - b.gravity).dot(normal);
        let meeting = speed_after(speed, pull, gap);
        Self {
            midpoint: place,
            lever_arms: [p - a.center, q - b.center],
            relative_velocity: relative,
            approach_speed_m_s: speed,
            impact_speed_m_s: meeting,
            time_of_impact_s: 2.0 * gap / (speed + meeting).max(1e-6),
        }
    }
}

/// Returns the speed of a body after an accelerated displacement along its direction; 0 where it turned before. Its
/// duration is twice the displacement over the sum of both speeds.
pub(super) fn speed_after(speed: f32, acceleration: f32, way_m: f32) -> f32 {
    // v^2 = v0^2 + 2 a s.
    (speed * speed + 2.0 * acceleration * way_m).max(0.0).sqrt()
}

/// Returns the positions of the two surfaces of a contact point before the step.
fn surface_points_before_step(
    manifold: &ContactManifold,
    contact: &SolverContact,
    bodies: &RigidBodySet,
    (a, b): (&BodyMotion, &BodyMotion),
) -> (Vec3, Vec3) {
    let (p, q) = manifold.data.solver_contact_world_points(contact, bodies);
    // Anchors move with their bodies, or are fixed in the world.
    let before = |now: Vec3, anchor: Vec3, motion: &BodyMotion, in_world: bool| {
        if motion.is_recorded && !in_world {
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
