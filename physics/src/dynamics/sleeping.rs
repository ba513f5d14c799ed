//! Transfer of sleeping bodies to the sleeping-island cache.

use super::Dynamics;
use crate::body::{BodyHandle, BodyStatus};
use crate::contact::contacts_within;
use dwell_scene::{Contact, State, SupportDirection, interrupt};
use rapier3d::dynamics::RigidBodyHandle;

/// Physics steps between transfers to the cache: a quarter of a second at the default rate.
const CACHING_PERIOD_TICKS: u64 = 32;
/// Work of rapier's list of pairs in one flush while pairs are dropped, steps: a tenth of a second, in which it asks nobody.
const STEPS_PER_FLUSH: u64 = 50_000_000;

impl Dynamics {
    /// Periodically caches bodies that have fallen asleep. `tick_before`: the tick at which the control step began;
    /// `is_handled`: whether a hand holds or has just released a body.
    pub(crate) fn cache_sleeping(&mut self, tick_before: u64, is_handled: impl Fn(usize) -> bool) {
        if tick_before / CACHING_PERIOD_TICKS == self.tick / CACHING_PERIOD_TICKS {
            return;
        }
        let mut asleep: Vec<RigidBodyHandle> = (0..self.bodies.len())
            .filter(|index| self.is_cacheable(*index) && !is_handled(*index))
            .map(|index| self.bodies[index].handle)
            .collect();
        self.engine.exclude_bodies_touching_free(&mut asleep);
        if asleep.is_empty() {
            return;
        }
        asleep.sort_unstable_by_key(|body| body.into_raw_parts());
        let kept = self.current_contacts().into_iter();
        let sleeps = |body: &RigidBodyHandle| {
            let key = |body: &RigidBodyHandle| body.into_raw_parts();
            asleep.binary_search_by_key(&key(body), key).is_ok()
        };
        let kept = kept.filter(|(bodies, _)| bodies.iter().any(sleeps));
        self.engine.sleeping_cache.store_contacts(kept);
        self.engine.cache_bodies(&asleep);
        self.forget_pairs(&asleep);
    }

    /// Drops the pairs of bodies that no longer move with other fixed ones.
    fn forget_pairs(&mut self, bodies: &[RigidBodyHandle]) {
        // They must first be known as fixed, or what they touch would wake when the pairs go.
        self.flush();
        for portion in portions(bodies, |body| self.engine.pair_count(body)) {
            interrupt::unwind_if_cancelled();
            self.engine.move_broad_phase_proxies(portion, true);
            self.flush();
        }
        self.engine.move_broad_phase_proxies(bodies, false);
        self.flush();
        self.engine.shrink_pair_storage();
    }

    /// Drops the pairs that bodies made before they were latched or frozen, with other fixed ones.
    pub(crate) fn forget_fixed_pairs(&mut self) {
        let stands = |(_, hold): &(&BodyHandle, &BodyStatus)| **hold != BodyStatus::Free;
        let bodies = self.bodies.iter().zip(&self.statuses).filter(stands);
        let bodies: Vec<RigidBodyHandle> = bodies.map(|(body, _)| body.handle).collect();
        if !bodies.is_empty() {
            self.forget_pairs(&bodies);
        }
    }

    /// Returns the contacts among the pairs that rapier has.
    fn current_contacts(&self) -> Vec<([RigidBodyHandle; 2], Contact)> {
        contacts_within(
            &self.engine.narrow_phase,
            &self.engine.colliders,
            &self.entries,
            self.settings.config.touch_distance_m,
        )
    }

    /// Writes the contacts into the state: all pairs of parts, and of parts with the structure, each once, sorted.
    pub(crate) fn write_contacts(&self, state: &mut State) {
        let contacts = &mut state.contacts;
        contacts.clear();
        contacts.extend(
            self.current_contacts()
                .into_iter()
                .map(|(_, contact)| contact),
        );
        contacts.extend(self.engine.sleeping_cache.contacts());
        // A pair of parts may touch with several pieces: it is listed once, as supporting if any of them supports.
        contacts.sort_unstable_by_key(|contact| {
            (
                contact.a,
                contact.b,
                contact.support_relation == SupportDirection::NoSupport,
            )
        });
        contacts.dedup_by_key(|contact| (contact.a, contact.b));
    }

    /// Returns whether a body is free and asleep.
    fn is_cacheable(&self, index: usize) -> bool {
        let rigid = self.engine.bodies.get(self.bodies[index].handle);
        self.statuses[index] == BodyStatus::Free
            && rigid.is_some_and(|rigid| rigid.is_dynamic() && rigid.is_sleeping())
    }
}

/// Returns the bodies in portions whose pairs are dropped in one flush each: rapier looks through the pairs of a body for each that
/// it drops.
fn portions(
    bodies: &[RigidBodyHandle],
    pair_count: impl Fn(RigidBodyHandle) -> usize,
) -> Vec<&[RigidBodyHandle]> {
    let mut portions = Vec::new();
    let (mut start, mut since) = (0, 0);
    for (k, body) in bodies.iter().enumerate() {
        let steps = (pair_count(*body) as u64).pow(2);
        if since + steps > STEPS_PER_FLUSH && k > start {
            portions.push(&bodies[start..k]);
            (start, since) = (k, 0);
        }
        since += steps;
    }
    portions.push(&bodies[start..]);
    portions
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_are_dropped_in_portions_of_bounded_work() {
        let bodies: Vec<RigidBodyHandle> = (0..770)
            .map(|k| RigidBodyHandle::from_raw_parts(k, 0))
            .collect();
        // Some pairs each, as in a house that people live in: all at once.
        assert_eq!(portions(&bodies, |_| 60), [&bodies[..]]);
        let of_heap = portions(&bodies, |_| 770);
        assert_eq!(of_heap.concat(), bodies);
        assert!(
            of_heap.iter().all(|portion| portion.len() <= 84),
            "{of_heap:?}"
        );
        assert!(of_heap.len() < 12);
        assert_eq!(portions(&bodies[..2], |_| 100_000).len(), 2);
    }
}
