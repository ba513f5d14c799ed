//! The rigid bodies of a world with their colliders, and the values with which they touch.

mod assembly;

pub(crate) use assembly::{
    AssembledWorld, BodyMasses, assemble, density, invalidate_contacts, set_contact_properties,
    update_collider_properties,
};
