//! Laws of contacts.

pub(super) mod anisotropic_friction;
pub(super) mod compliance;
pub(super) mod load;
pub(super) mod rolling;
pub(super) mod stribeck;
pub(super) mod torsional;
pub(super) mod velocity_restitution;
