//! Laws that act on bodies: air, mass, inertia.

pub(super) mod center_of_mass;
pub(super) mod drag;
pub(super) mod inertia_error;
