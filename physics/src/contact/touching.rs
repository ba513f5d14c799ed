//! Who touches whom.

use super::entry::{Entry, Toucher, entry_index};
use dwell_scene::Contact;
use rapier3d::geometry::{ColliderSet, NarrowPhase};

/// All pairs of parts, and of parts with the structure, that stand at most `distance_m` apart; each once, sorted.
pub(crate) fn touching(
    narrow_phase: &NarrowPhase,
    colliders: &ColliderSet,
    entries: &[Entry],
    distance_m: f32,
    out: &mut Vec<Contact>,
) {
    out.clear();
    for pair in narrow_phase.contact_pairs() {
        let near = pair.solver_manifolds().iter().any(|manifold| {
            manifold
                .points
                .iter()
                .any(|point| point.data.impulse > 0.0 || point.dist <= distance_m)
        });
        if !near || !pair.has_any_active_contact() {
            continue;
        }
        let entry = |handle| {
            let entry = entries.get(entry_index(&colliders[handle]))?;
            entry.toucher
        };
        let (Some(a), Some(b)) = (entry(pair.collider1), entry(pair.collider2)) else {
            continue;
        };
        let contact = match (a, b) {
            (Toucher::Part(a), Toucher::Part(b)) => Contact {
                a: a.min(b),
                b: Some(a.max(b)),
            },
            (Toucher::Part(part), Toucher::Structure(_))
            | (Toucher::Structure(_), Toucher::Part(part)) => Contact { a: part, b: None },
            _ => continue,
        };
        out.push(contact);
    }
    out.sort_unstable_by_key(|contact| (contact.a, contact.b));
    out.dedup();
}
