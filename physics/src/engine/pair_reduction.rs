//! Reduction of broad-phase pairs at rest: only pairs that touch or nearly touch, and no memory for those that are gone.
//!
//! rapier pairs colliders whose boxes in its tree overlap, and keeps the contact data of each pair. A box is wider than its
//! collider, so that small motions leave the tree alone, and never shrinks while the collider stays inside: a body that
//! came to rest keeps the width of its last motion, and with it pairs with bodies a hand's breadth away. Such pairs are
//! most frequent where many bodies have been thrown about, and they stay in memory and in snapshots for good. So a box is
//! shrunk when its body falls asleep; the next step forgets the pairs that are gone. A body that wakes and moves gets its
//! wide box back from rapier at once.

use super::RapierWorld;
use rapier3d::dynamics::{IntegrationParameters, RigidBodyHandle};
use rapier3d::geometry::Aabb;
use rapier3d::math::Vector;
use rapier3d::pipeline::QueryFilter;

/// Margin of the box of a sleeping body's collider beyond its contact range, m, on each side. Not 0: rapier would then not
/// notice that the box changed.
const SKIN_M: f32 = 1e-3;
/// Rapier's margin around a box in units of its length unit.
const RAPIER_SKIN: f32 = 0.04;
/// Margin up to which a box is left as it is, m.
const WIDE_ENOUGH_M: f32 = 2.0 * SKIN_M;
/// Physics steps after which memory is released: a quarter of a minute, so that a copy of a millisecond costs nothing.
const TICKS_BETWEEN_COPIES: u64 = 2048;

/// Numbers of collider pairs that a world keeps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PairCounts {
    /// Pairs whose boxes overlap.
    pub near: usize,
    /// Those of them that touch.
    pub touching: usize,
}

impl RapierWorld {
    /// Returns the number of collider pairs that rapier keeps.
    pub(crate) fn pair_counts(&self) -> PairCounts {
        let mut counts = PairCounts::default();
        for pair in self.narrow_phase.contact_pairs() {
            counts.near += 1;
            counts.touching += usize::from(pair.has_any_active_contact());
        }
        counts
    }

    /// Periodically releases the memory of pairs that are gone. rapier keeps each for the next pair, with all its buffers,
    /// so that in a long run every one of them comes to need the most. A copy has no unused memory. `tick`: physics steps
    /// made.
    pub(crate) fn release_pair_memory(&mut self, tick: u64) {
        if tick.is_multiple_of(TICKS_BETWEEN_COPIES) {
            self.narrow_phase = self.narrow_phase.clone();
        }
    }

    /// Shrinks the boxes of the bodies that were awake and have fallen asleep.
    pub(super) fn shrink_sleeping_bounds(&mut self, awake_before: &[RigidBodyHandle]) {
        let parameters = IntegrationParameters {
            length_unit: SKIN_M / RAPIER_SKIN,
            ..*self.parameters()
        };
        for handle in awake_before {
            let Some(body) = self.bodies.get(*handle).filter(|body| body.is_sleeping()) else {
                continue;
            };
            for collider in body.colliders() {
                let Some(shape) = self.colliders.get(*collider) else {
                    continue;
                };
                let needed = shape.compute_broad_phase_aabb(self.parameters(), &self.bodies);
                let queries = self.broad_phase.as_query_pipeline(
                    self.narrow_phase.query_dispatcher(),
                    &self.bodies,
                    &self.colliders,
                    QueryFilter::default(),
                );
                let leaf = queries.bvh.leaf_node(collider.into_raw_parts().0);
                let Some(found) = leaf.map(|node| Aabb::new(node.mins(), node.maxs())) else {
                    continue;
                };
                let wider = (needed.mins - found.mins).max(found.maxs - needed.maxs);
                if wider.max_element() <= WIDE_ENOUGH_M || !needed.mins.is_finite() {
                    continue;
                }
                // rapier only moves a box that a collider has left: so it is moved into a corner, and back.
                let outside = found.mins - Vector::splat(SKIN_M);
                let corner = Aabb::new(outside, outside);
                self.broad_phase.set_aabb(&parameters, *collider, corner);
                self.broad_phase.set_aabb(&parameters, *collider, needed);
            }
        }
    }
}
