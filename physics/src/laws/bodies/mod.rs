//! Laws that act on bodies: air, mass, inertia.

mod air;
pub(super) mod buoyancy;
pub(super) mod center_of_mass;
pub(super) mod drag;
pub(super) mod inertia_error;
pub(super) mod magnus;
pub(super) mod size;
pub(super) mod viscous_damping;
pub(super) mod wind;
