//! Laws that act where things touch.

pub(super) mod anisotropic_friction;
pub(super) mod compliance;
pub(super) mod stribeck;
pub(super) mod velocity_restitution;
