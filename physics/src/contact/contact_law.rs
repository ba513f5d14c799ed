//! Laws of contacts: their inputs at a contact, and the values that they change.

use super::collider_entry::ContactEntity;
use super::scope::ContactScope;
use glam::{Quat, Vec3};
use std::fmt::Debug;

/// A law that changes the values of contacts before they are solved.
pub(crate) trait ContactLaw: Debug + Send + Sync {
    /// Returns the contacts that it changes.
    fn scope(&self) -> &ContactScope;

    /// Changes the values of one contact plane (one manifold) within the scope, before it is solved. rapier has one
    /// friction, one restitution and one surface velocity for all points of a plane, and no stiffness of its own.
    fn modify_contact(&self, touch: &LawContact<'_>, values: &mut ContactValues);
}

/// One of the two things that touch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ContactSide<'a> {
    pub(crate) contact_entity: Option<ContactEntity>,
    /// Its substance at the contact, by its name in the materials library.
    pub(crate) substance: &'a str,
    /// Orientation of its own frame in the world; the identity for structure and fixed things.
    pub(crate) rotation: Quat,
}

/// Two surfaces that touch or are about to, at the beginning of a physics step. The surface is the side that the law's
/// target names first; without a name, structure comes before objects, and objects are in order.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LawContact<'a> {
    pub(crate) surface: ContactSide<'a>,
    /// The side that slides or rolls over the surface, or hits it.
    pub(crate) other: ContactSide<'a>,
    /// From the surface to the other, unit length.
    pub(crate) normal: Vec3,
    /// Velocity of the other relative to the surface at the middle of the plane's points, m/s.
    pub(crate) relative_velocity: Vec3,
    /// The friction impulse on the other in the last substep, N·s.
    pub(crate) friction_impulse_n_s: Vec3,
}

impl LawContact<'_> {
    /// Returns the approach speed of the two, m/s; negative when they part.
    pub(crate) fn approach_speed_m_s(&self) -> f32 {
        -self.relative_velocity.dot(self.normal)
    }

    /// Returns the slip velocity of the other over the surface, m/s.
    pub(crate) fn slip_velocity(&self) -> Vec3 {
        self.relative_velocity + self.normal * self.approach_speed_m_s()
    }

    /// Returns the same seen from the other side.
    pub(crate) fn swapped(self) -> Self {
        Self {
            surface: self.other,
            other: self.surface,
            normal: -self.normal,
            relative_velocity: -self.relative_velocity,
            friction_impulse_n_s: -self.friction_impulse_n_s,
        }
    }
}

/// The values of one contact plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ContactValues {
    pub(crate) friction: f32,
    pub(crate) restitution: f32,
    /// Target slip velocity of friction, m/s: as of a conveyor belt. 0 unless a law sets it.
    pub(crate) surface_velocity: Vec3,
}
