//! Contact loads of the last step, and torques between the two bodies.

use crate::contact::{ColliderMetadata, ContactScope, ContactSide, entry_index};
use crate::laws::LawContext;
use glam::{Quat, Vec3};
use rapier3d::dynamics::{RigidBody, RigidBodyHandle};
use rapier3d::geometry::Collider;

/// One contact plane within a law's scope, with at least one side that moves and is awake.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContactLoad {
    /// Colliders, for the order.
    entries: (usize, usize),
    bodies: (Option<RigidBodyHandle>, Option<RigidBodyHandle>),
    /// Unit length.
    pub(super) normal: Vec3,
    /// The middle of its points, weighted by force, m.
    pub(super) point: Vec3,
    pub(super) normal_force_n: f32,
    /// The pair's friction.
    pub(super) friction: f32,
}

/// All loaded contact planes within a scope, in a fixed order.
pub(super) fn contact_loads(stage: &LawContext<'_>, scope: &ContactScope) -> Vec<ContactLoad> {
    let engine = &stage.engine;
    let run_s = engine.solver_call_s();
    let mut loads = Vec::new();
    for pair in engine.narrow_phase.contact_pairs() {
        let colliders = (
            &engine.colliders[pair.collider1],
            &engine.colliders[pair.collider2],
        );
        let handles = (colliders.0.parent(), colliders.1.parent());
        let awake = |handle: Option<RigidBodyHandle>| {
            let rigid = handle.and_then(|handle| engine.bodies.get(handle));
            rigid.is_some_and(|rigid| rigid.is_dynamic() && !rigid.is_sleeping())
        };
        if !awake(handles.0) && !awake(handles.1) {
            continue;
        }
        let entry = |collider: &Collider| {
            let index = entry_index(collider);
            Some((index, stage.entries.get(index)?))
        };
        let (Some((index_a, a)), Some((index_b, b))) = (entry(colliders.0), entry(colliders.1))
        else {
            continue;
        };
        for plane in pair.solver_manifolds() {
            let (mut impulse, mut moment) = (0.0, Vec3::ZERO);
            for contact in &plane.data.solver_contacts {
                let index = contact.contact_indices()[0] as usize;
                let Some(point) = plane.points.get(index) else {
                    continue;
                };
                let (p, q) = plane
                    .data
                    .solver_contact_world_points(contact, &engine.bodies);
                impulse += point.data.impulse;
                moment += (p + q) * (0.5 * point.data.impulse);
            }
            if impulse <= 0.0 {
                continue;
            }
            let classes = (
                a.surface.class(plane.subshape1),
                b.surface.class(plane.subshape2),
            );
            let side = |entry: &ColliderMetadata, class: u16| ContactSide {
                contact_entity: entry.contact_entity,
                substance: stage.table.substance(class),
                rotation: Quat::IDENTITY,
            };
            let sides = (side(a, classes.0), side(b, classes.1));
            if scope.match_sides(stage.house, &sides.0, &sides.1).is_none() {
                continue;
            }
            loads.push(ContactLoad {
                entries: (index_a, index_b),
                bodies: handles,
                normal: plane.data.normal,
                point: moment / impulse,
                normal_force_n: impulse / run_s,
                friction: stage.table.pair_contact(classes.0, classes.1).friction,
            });
        }
    }
    // rapier's order of pairs is unspecified.
    loads.sort_by(|a, b| {
        let key = |load: &ContactLoad| (load.entries, load.normal_force_n.to_bits());
        key(a).cmp(&key(b))
    });
    loads
}

impl ContactLoad {
    fn signed_bodies<'a>(
        &self,
        stage: &'a LawContext<'_>,
    ) -> impl Iterator<Item = (f32, &'a RigidBody)> {
        [(1.0, self.bodies.0), (-1.0, self.bodies.1)]
            .into_iter()
            .filter_map(|(sign, handle)| {
                let rigid = stage.engine.bodies.get(handle?)?;
                Some((sign, rigid))
            })
    }

    /// Returns the relative angular velocity of the first body against the second, rad/s.
    pub(super) fn relative_spin(&self, stage: &LawContext<'_>) -> Vec3 {
        self.signed_bodies(stage)
            .map(|(sign, rigid)| rigid.angvel() * sign)
            .sum()
    }

    /// Returns the angular acceleration by gravity of the first about the contact against the second, without slip, rad/s².
    pub(super) fn gravity_angular_acceleration(&self, stage: &LawContext<'_>) -> Vec3 {
        let gravity = stage.engine.gravity;
        self.signed_bodies(stage)
            .filter(|(_, rigid)| rigid.is_dynamic())
            .map(|(sign, rigid)| {
                let arm = rigid.center_of_mass() - self.point;
                // alpha = r x m g / I.
                let torque = arm.cross(gravity * rigid.gravity_scale() * rigid.mass());
                let axis = torque.normalize_or_zero();
                torque * (sign * inverse_inertia(rigid, axis, Some(arm)))
            })
            .sum()
    }

    /// Returns the inertia about an axis, kg·m²: about the centres of mass, or rolling about the contact.
    pub(super) fn inertia(&self, stage: &LawContext<'_>, axis: Vec3, rolling: bool) -> f32 {
        // An angular impulse L and -L changes the spin of one against the other by L (1/I_1 + 1/I_2).
        let inverse: f32 = self
            .signed_bodies(stage)
            .filter(|(_, rigid)| rigid.is_dynamic())
            .map(|(_, rigid)| {
                let arm = rigid.center_of_mass() - self.point;
                inverse_inertia(rigid, axis, rolling.then_some(arm))
            })
            .sum();
        if inverse > 0.0 { 1.0 / inverse } else { 0.0 }
    }

    /// Returns the distance of the nearer moving centre of mass from the contact plane, m.
    pub(super) fn rolling_radius_m(&self, stage: &LawContext<'_>) -> f32 {
        self.signed_bodies(stage)
            .filter(|(_, rigid)| rigid.is_dynamic())
            .map(|(_, rigid)| (rigid.center_of_mass() - self.point).dot(self.normal).abs())
            .fold(f32::MAX, f32::min)
    }

    /// Applies an angular impulse to the first body and its opposite to the second, kg·m²/s.
    pub(super) fn apply_angular_impulse(&self, stage: &mut LawContext<'_>, impulse: Vec3) {
        for (sign, handle) in [(1.0, self.bodies.0), (-1.0, self.bodies.1)] {
            let Some(handle) = handle else { continue };
            if let Some(rigid) = stage.engine.bodies.get_mut(handle)
                && rigid.is_dynamic()
                && !rigid.is_sleeping()
            {
                rigid.apply_torque_impulse(impulse * sign, false);
            }
        }
    }
}

/// Returns the inverse of a body's inertia about an axis through its centre of mass or, with an arm from there, through the contact.
fn inverse_inertia(rigid: &RigidBody, axis: Vec3, arm: Option<Vec3>) -> f32 {
    let properties = &rigid.mass_properties().local_mprops;
    let local = rigid.rotation().inverse() * axis;
    // a^T I a, and Steiner's m |r - a (a . r)|^2.
    let own = local.dot(properties.reconstruct_inertia_matrix() * local);
    let across = arm.map_or(0.0, |arm| (arm - axis * arm.dot(axis)).length_squared());
    let inertia = own + rigid.mass() * across;
    if inertia > 0.0 { 1.0 / inertia } else { 0.0 }
}
