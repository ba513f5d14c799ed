//! Data that rapier keeps in contact points.

use rapier3d::geometry::{ContactData, ContactManifold, SolverContact};

/// Returns the points of a contact plane that rapier solves, with their solver data.
pub(crate) fn points(
    plane: &ContactManifold,
) -> impl Iterator<Item = (&SolverContact, &ContactData)> {
    plane.data.solver_contacts.iter().filter_map(|contact| {
        let point = plane.points.get(contact.contact_indices()[0] as usize)?;
        Some((contact, &point.data))
    })
}

/// Layout of friction impulses in rapier's contact points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrictionImpulseLayout {
    /// Each point of a plane holds the friction of the whole plane.
    pub(crate) patch_friction: bool,
    /// rapier runs once in a physics step.
    pub(crate) single_solver_call: bool,
}
