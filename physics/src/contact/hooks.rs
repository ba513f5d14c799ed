//! Callbacks from rapier during a step: contact filter and friction of a pair.

use super::collider_entry::{ColliderMetadata, entry_index};
use super::contact_law::{ContactLaw, ContactSide, ContactValues, LawContact};
use super::rolling;
use super::substances::ContactTable;
use crate::engine::FrictionImpulseLayout;
use dwell_scene::interrupt;
use dwell_scene::material::PairContact;
use dwell_scene::{AgentId, House};
use glam::{Quat, Vec3};
use rapier3d::dynamics::{RigidBody, RigidBodyHandle, RigidBodySet};
use rapier3d::geometry::{SolverContact, SolverContacts, SolverFlags};
use rapier3d::pipeline::{
    ContactModificationContext, ModifiableManifold, PairFilterContext, PhysicsHooks,
};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Distance below which two points of a contact plane are one, m.
const SAME_POINT_M: f32 = 0.002;

/// Pairs excluded from collision.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct CollisionExclusions {
    /// A body and an entry, sorted: the things that a door's leaf overlaps when closed.
    pub(crate) entries: Vec<(u32, u32)>,
    /// A body and the agent that holds it or has just released it, sorted.
    pub(crate) carriers: Vec<(u32, AgentId)>,
}

impl CollisionExclusions {
    fn can_collide(&self, entries: &[ColliderMetadata], a: usize, b: usize) -> bool {
        let one_way = |a: usize, b: usize| {
            let Some(body) = entries.get(a).and_then(|entry| entry.body) else {
                return true;
            };
            let with_agent = entries.get(b).and_then(ColliderMetadata::agent);
            let carried =
                with_agent.is_some_and(|agent| self.carriers.binary_search(&(body, agent)).is_ok());
            !carried && self.entries.binary_search(&(body, b as u32)).is_err()
        };
        one_way(a, b) && one_way(b, a)
    }

    pub(crate) fn exclude_carried(&mut self, body: u32, agent: AgentId) {
        if let Err(place) = self.carriers.binary_search(&(body, agent)) {
            self.carriers.insert(place, (body, agent));
        }
    }

    pub(crate) fn include_released(&mut self, body: u32, agent: AgentId) {
        self.carriers.retain(|pair| *pair != (body, agent));
    }
}

/// The contact values of colliders: the table's, and laws' changes of them.
#[derive(Clone, Copy)]
pub(crate) struct ContactProperties<'a> {
    pub(crate) house: &'a House,
    pub(crate) table: &'a ContactTable,
    pub(crate) laws: &'a [Arc<dyn ContactLaw>],
    /// Set if a law makes contacts compliant.
    pub(crate) is_compliant: bool,
}

impl ContactProperties<'_> {
    /// Returns the values of a collider on itself, for rapier's own rule, and whether rapier asks the hook about its pairs instead.
    pub(crate) fn self_contact_and_hook(&self, entry: &ColliderMetadata) -> (PairContact, bool) {
        let (mut own, mut special) = self.table.self_contact_and_hook(&entry.surface);
        if self.is_compliant {
            own.restitution = 0.0;
            special |= entry.body.is_some();
        }
        special |= self
            .laws
            .iter()
            .any(|law| law.scope().needs_hook(self.house, self.table, entry));
        (own, special)
    }
}

/// The callbacks while bodies are inserted in portions: their pairs are listed, and have contacts only once all bodies and joints
/// are there.
pub(crate) struct PairListingHooks;

impl PhysicsHooks for PairListingHooks {
    fn filter_contact_pair(&self, _: &PairFilterContext) -> Option<SolverFlags> {
        interrupt::unwind_if_cancelled();
        None
    }
}

/// The callbacks of one step.
pub(crate) struct ContactHooks<'a> {
    pub(crate) entries: &'a [ColliderMetadata],
    pub(crate) properties: ContactProperties<'a>,
    pub(crate) excluded: &'a CollisionExclusions,
    pub(crate) friction_storage: FrictionImpulseLayout,
    /// Length of the step, s.
    pub(crate) dt_s: f32,
}

impl PhysicsHooks for ContactHooks<'_> {
    fn filter_contact_pair(&self, context: &PairFilterContext) -> Option<SolverFlags> {
        interrupt::unwind_if_cancelled();
        let a = entry_index(&context.colliders[context.collider1]);
        let b = entry_index(&context.colliders[context.collider2]);
        self.excluded
            .can_collide(self.entries, a, b)
            .then(SolverFlags::default)
    }

    fn modify_solver_contacts(&self, context: &mut ContactModificationContext) {
        interrupt::unwind_if_cancelled();
        let colliders = context.colliders;
        let (one, two) = (&colliders[context.collider1], &colliders[context.collider2]);
        let (a, b) = (entry_index(one), entry_index(two));
        let (Some(a), Some(b)) = (self.entries.get(a), self.entries.get(b)) else {
            return;
        };
        let ContactProperties {
            table,
            laws,
            is_compliant: soft,
            ..
        } = self.properties;
        let (bodies, body_a, body_b) = (context.bodies, context.rigid_body1, context.rigid_body2);
        let Some(manifold) = context.rigid_mut() else {
            return;
        };
        let turns = |body: Option<RigidBodyHandle>| {
            body.and_then(|body| bodies.get(body))
                .map_or(Vec3::ZERO, RigidBody::angvel)
        };
        let turns = (turns(body_a), turns(body_b));
        rolling::correct_line_contact(manifold, (one, two), turns, self.dt_s);
        let class_a = a.surface.class(manifold.manifold.subshape1);
        let class_b = b.surface.class(manifold.manifold.subshape2);
        let pair = table.pair_contact(class_a, class_b);
        *manifold.friction = pair.friction;
        *manifold.restitution = pair.restitution;
        if soft {
            *manifold.restitution = 0.0;
            merge_coincident_points(manifold.solver_contacts);
        }
        if laws.is_empty() {
            return;
        }
        let side =
            |entry: &ColliderMetadata, class: u16, body: Option<RigidBodyHandle>| ContactSide {
                contact_entity: entry.contact_entity,
                substance: table.substance(class),
                rotation: body
                    .and_then(|body| bodies.get(body))
                    .map_or(Quat::IDENTITY, |rigid| *rigid.rotation()),
            };
        let sides = (side(a, class_a, body_a), side(b, class_b, body_b));
        self.apply_contact_laws(manifold, bodies, (body_a, body_b), sides);
    }
}

/// Merges coincident points, keeping the deepest: a ball on the common edge of two triangles touches both, and several
/// springs in one point multiply its stiffness.
fn merge_coincident_points(contacts: &mut SolverContacts) {
    let same = |a: &SolverContact, b: &SolverContact| {
        a.anchor1.distance_squared(b.anchor1) < SAME_POINT_M * SAME_POINT_M
    };
    let mut index = 0;
    while index < contacts.len() {
        let mine = contacts[index];
        let doubled = contacts.iter().enumerate().any(|(k, other)| {
            k != index && same(&mine, other) && (other.dist, k) < (mine.dist, index)
        });
        if doubled {
            contacts.remove(index);
        } else {
            index += 1;
        }
    }
}

impl ContactHooks<'_> {
    /// Lets the laws change a plane's values.
    fn apply_contact_laws(
        &self,
        plane: &mut ModifiableManifold<'_>,
        bodies: &RigidBodySet,
        (body_a, body_b): (Option<RigidBodyHandle>, Option<RigidBodyHandle>),
        (a, b): (ContactSide<'_>, ContactSide<'_>),
    ) {
        let count = plane.solver_contacts.len();
        let turns =
            |law: &Arc<dyn ContactLaw>| law.scope().match_sides(self.properties.house, &a, &b);
        if count == 0 || self.properties.laws.iter().all(|law| turns(law).is_none()) {
            return;
        }
        let sum: Vec3 = plane
            .solver_contacts
            .iter()
            .map(|contact| (contact.anchor1 + contact.anchor2) * 0.5)
            .sum();
        let point = sum / count as f32;
        let velocity = |body: Option<RigidBodyHandle>| {
            body.and_then(|body| bodies.get(body))
                .map_or(Vec3::ZERO, |rigid| rigid.velocity_at_point(point))
        };
        let touch = LawContact {
            surface: a,
            other: b,
            normal: *plane.normal,
            relative_velocity: velocity(body_b) - velocity(body_a),
            // rapier keeps the impulse on the first body.
            friction_impulse_n_s: -self.friction_storage.last_substep_friction(plane.manifold),
        };
        let mut values = ContactValues {
            friction: *plane.friction,
            restitution: *plane.restitution,
            surface_velocity: Vec3::ZERO,
        };
        for law in self.properties.laws {
            match turns(law) {
                Some(false) => law.modify_contact(&touch, &mut values),
                Some(true) => {
                    values.surface_velocity *= -1.0;
                    law.modify_contact(&touch.swapped(), &mut values);
                    values.surface_velocity *= -1.0;
                }
                None => {}
            }
        }
        *plane.friction = values.friction.max(0.0);
        *plane.restitution = values.restitution.clamp(0.0, 1.0);
        if values.surface_velocity != Vec3::ZERO {
            for contact in plane.solver_contacts.iter_mut() {
                contact.tangent_velocity += values.surface_velocity;
            }
        }
    }
}
