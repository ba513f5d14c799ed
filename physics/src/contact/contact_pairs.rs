//! Pairs of bodies in contact.

use super::collider_entry::{ColliderMetadata, ContactEntity, entry_index};
use dwell_scene::{Contact, SupportDirection};
use rapier3d::dynamics::RigidBodyHandle;
use rapier3d::geometry::{ColliderSet, NarrowPhase};

/// Least upward component of a normal that supports: the cosine of 60 degrees.
const MIN_SUPPORT_NORMAL_Y: f32 = 0.5;

/// Returns all pairs of parts, and of parts with the structure, that are at most `distance_m` apart, with their bodies; for
/// each pair of pieces that touch.
pub(crate) fn contacts_within(
    narrow_phase: &NarrowPhase,
    colliders: &ColliderSet,
    entries: &[ColliderMetadata],
    distance_m: f32,
) -> Vec<([RigidBodyHandle; 2], Contact)> {
    let mut out = Vec::new();
    for pair in narrow_phase.contact_pairs() {
        let (mut near, mut rest) = (false, SupportDirection::NoSupport);
        for manifold in pair.solver_manifolds() {
            let touches = manifold
                .points
                .iter()
                .any(|point| point.data.impulse > 0.0 || point.dist <= distance_m);
            near |= touches;
            // The normal points from the first collider to the second.
            let up = manifold.data.normal.y;
            if touches && up.abs() >= MIN_SUPPORT_NORMAL_Y {
                rest = if up > 0.0 {
                    SupportDirection::BOnA
                } else {
                    SupportDirection::AOnB
                };
            }
        }
        if !near || !pair.has_any_active_contact() {
            continue;
        }
        let entry = |handle| {
            let entry = entries.get(entry_index(&colliders[handle]))?;
            entry.contact_entity
        };
        let (Some(a), Some(b)) = (entry(pair.collider1), entry(pair.collider2)) else {
            continue;
        };
        let (first, second) = match (a, b) {
            (ContactEntity::Part(a), ContactEntity::Part(b)) => (a, Some(b)),
            (ContactEntity::Part(part), ContactEntity::Structure(_)) => (part, None),
            (ContactEntity::Structure(_), ContactEntity::Part(part)) => {
                rest = turned(rest);
                (part, None)
            }
            _ => continue,
        };
        let contact = match second {
            Some(second) if second < first => Contact {
                a: second,
                b: Some(first),
                support_relation: turned(rest),
            },
            b => Contact {
                a: first,
                b,
                support_relation: rest,
            },
        };
        let bodies = [pair.collider1, pair.collider2].map(|handle| colliders[handle].parent());
        if let [Some(one), Some(two)] = bodies {
            out.push(([one, two], contact));
        }
    }
    out
}

/// Returns the same seen from the other side.
fn turned(rest: SupportDirection) -> SupportDirection {
    match rest {
        SupportDirection::NoSupport => SupportDirection::NoSupport,
        SupportDirection::AOnB => SupportDirection::BOnA,
        SupportDirection::BOnA => SupportDirection::AOnB,
    }
}
