//! Positions and velocities of bodies before a step.

use super::contact_tracker::ContactTracker;
use crate::engine::RapierWorld;
use glam::{Quat, Vec3};
use rapier3d::dynamics::{RigidBody, RigidBodyHandle};

/// Position and velocity of a body before the step, at its centre of mass.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct BodyMotion {
    /// Set for awake bodies, and for sleeping ones while any body is in free flight; otherwise the other fields are unset.
    pub(super) is_recorded: bool,
    pub(super) linear: Vec3,
    pub(super) angular: Vec3,
    pub(super) center: Vec3,
    pub(super) rotation: Quat,
    /// Gravitational acceleration, m/s².
    pub(super) gravity: Vec3,
    /// Displacement that the last step cut off by stopping the body at a surface, m.
    pub(super) undone_displacement_m: Vec3,
    /// A bound on the speed of all its points, m/s.
    pub(super) max_point_speed_m_s: f32,
    /// Velocity change over the step if nothing touches the body, m/s; `None` for bodies moved by joints or by an agent's
    /// hand.
    pub(super) free_velocity_change: Option<Vec3>,
    /// J; 0 for a body that is not in free flight.
    pub(super) kinetic_energy_j: f32,
}

impl BodyMotion {
    /// Returns the rest of the body's displacement in the step since then, when it was stopped on its way and kept its speed.
    pub(super) fn ccd_lost_displacement(&self, body: &RigidBody, dt_s: f32) -> Option<Vec3> {
        let fell = self.linear + self.gravity * dt_s;
        let free = (self.linear + fell) * (0.5 * dt_s);
        let rest = free - (body.center_of_mass() - self.center);
        let kept_speed = (body.linvel() - fell).length_squared() < 1e-4 * fell.length_squared();
        let stopped = rest.length_squared() > 1e-3 * free.length_squared();
        (self.is_recorded && kept_speed && stopped).then_some(rest)
    }

    /// Returns the energy of a body in free flight, J, of a mass in kg: kinetic, and potential over the origin, at the
    /// position that it would have had the last step not stopped it.
    pub(super) fn energy_j(&self, mass_kg: f32) -> f32 {
        self.kinetic_energy_j - mass_kg * self.gravity.dot(self.center + self.undone_displacement_m)
    }

    /// Returns the position of the centre of mass of a body in free flight after a time, or before.
    pub(super) fn center_after(&self, time_s: f32) -> Vec3 {
        // x + v t + g t^2 / 2.
        self.center
            + self.undone_displacement_m
            + (self.linear + self.gravity * (0.5 * time_s)) * time_s
    }

    /// Returns the velocity of a point, m/s.
    pub(super) fn velocity_at(&self, point: Vec3) -> Vec3 {
        self.linear + self.angular.cross(point - self.center)
    }
}

/// Returns the motion of a body before the step; at rest for a body that does not move.
pub(super) fn motion_before(motions: &[BodyMotion], body: Option<RigidBodyHandle>) -> BodyMotion {
    body.and_then(|body| motions.get(body.into_raw_parts().0 as usize))
        .copied()
        .unwrap_or_default()
}

/// Returns the entry of a body.
fn motion_entry_mut(motions: &mut Vec<BodyMotion>, body: RigidBodyHandle) -> &mut BodyMotion {
    let index = body.into_raw_parts().0 as usize;
    if motions.len() <= index {
        motions.resize(index + 1, BodyMotion::default());
    }
    &mut motions[index]
}

/// Records the motion of all awake bodies before a step, and the positions of sleeping ones. `flying`: those in free flight.
pub(crate) fn record_motion(
    engine: &RapierWorld,
    contact_tracker: &ContactTracker,
    flying: &[RigidBodyHandle],
    out: &mut Vec<BodyMotion>,
) {
    out.clear();
    if !flying.is_empty() {
        for (handle, body) in engine.bodies.iter() {
            if body.is_dynamic() && body.is_sleeping() {
                *motion_entry_mut(out, handle) = BodyMotion {
                    is_recorded: true,
                    center: body.center_of_mass(),
                    rotation: *body.rotation(),
                    ..BodyMotion::default()
                };
            }
        }
    }
    let mut flying = flying.iter().peekable();
    for handle in engine.islands.active_bodies() {
        let Some(body) = engine.bodies.get(handle) else {
            continue;
        };
        let flies = flying.next_if_eq(&&handle).is_some();
        let index = handle.into_raw_parts().0 as usize;
        let ahead = contact_tracker
            .undone_displacements
            .get(&(index as u32))
            .copied();
        let (linear, angular) = (body.linvel(), body.angvel());
        let falls = if body.is_dynamic() {
            body.gravity_scale()
        } else {
            0.0
        };
        let gravity = engine.gravity * falls;
        let free = body.is_dynamic() && engine.joints.attached_joints(handle).next().is_none();
        *motion_entry_mut(out, handle) = BodyMotion {
            is_recorded: true,
            linear,
            angular,
            center: body.center_of_mass(),
            rotation: *body.rotation(),
            gravity,
            undone_displacement_m: ahead.unwrap_or(Vec3::ZERO),
            max_point_speed_m_s: linear.length()
                + angular.length() * body.mass_properties().max_extent(),
            kinetic_energy_j: if flies { body.kinetic_energy() } else { 0.0 },
            free_velocity_change: free.then(|| gravity * engine.gravity_time_s(flies)),
        };
    }
}
