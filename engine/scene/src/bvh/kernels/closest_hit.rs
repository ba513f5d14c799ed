//! Selection of the closest hit: the nearest, and among coincident surfaces the one with the lowest id.
//!
//! Rule. Let `t` be the smallest distance of any hit. A hit at `s` is coincident with it when its plane passes within
//! the tolerance of the nearest hit, `(s - t) cos <= 10 um + 1e-6 s`, where `cos` is that of the angle between ray and
//! normal, taken as at least 1 / [`GRAZING`]. Of the coincident hits the lowest (id, source, triangle) is the answer.
//! The rule is stated for the set of hits, not for an order, so every tree and every kernel must agree. The code below
//! applies it while hits come in any order with the memory of one hit, and detects when that was too little
//! ([`ClosestHit::is_ambiguous`]); then a second pass, which starts from the known `t`, settles it.

/// Absolute part of the distance within which surfaces coincide, m.
const TOLERANCE_M: f32 = 1e-5;

/// Relative part: computed distances differ in the last bits.
const TOLERANCE_PER_M: f32 = 1e-6;

/// Largest ratio of the coincidence tolerance along the ray to that along the normal.
const GRAZING: f32 = 32.0;

/// The smallest distance of a nearest hit with which a hit is coincident. `cosine` is that between ray and normal, >= 0.
#[inline(always)]
pub(in super::super) fn coincidence_min_distance(distance: f32, cosine: f32) -> f32 {
    let slope = 1.0 / cosine;
    let slope = if slope < GRAZING { slope } else { GRAZING };
    distance - (TOLERANCE_M + TOLERANCE_PER_M * distance) * slope
}

/// The largest distance of a hit that may be coincident with a nearest hit at `distance`.
#[inline(always)]
pub(in super::super) fn coincidence_max_distance(distance: f32) -> f32 {
    (distance + GRAZING * TOLERANCE_M) * (1.0 + 2.0 * GRAZING * TOLERANCE_PER_M)
}

/// The triangle of a hit: `source` 0 for static geometry, else the instance plus 1; `slot` the triangle's place in its tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in super::super) struct HitTriangle {
    pub(in super::super) source: u32,
    pub(in super::super) slot: u32,
}

impl HitTriangle {
    pub(in super::super) const NONE: Self = Self {
        source: 0,
        slot: u32::MAX,
    };
}

/// The order among coincident hits.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct TieBreak {
    /// See [`coincidence_min_distance`].
    pub(in super::super) reach: f32,
    pub(in super::super) id: i32,
    /// Position of the triangle in its input.
    pub(in super::super) triangle: u32,
}

/// The closest hit so far of one ray.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct ClosestHit {
    /// The smallest distance so far; infinite before the first hit.
    pub(in super::super) distance: f32,
    /// Boxes and hits beyond this distance cannot matter.
    pub(in super::super) limit: f32,
    /// The winner so far.
    pub(in super::super) closest: HitTriangle,
    /// The smallest reach of any other hit since the last clear win; stale values lie beyond `distance`.
    pub(in super::super) nearest_other_reach: f32,
    /// The distance at which the winner became unknown; forgotten once beyond the horizon.
    pub(in super::super) ambiguous_at: f32,
}

impl ClosestHit {
    #[inline(always)]
    pub(in super::super) fn new(far: f32) -> Self {
        let infinite = f32::INFINITY;
        Self {
            distance: infinite,
            limit: far,
            closest: HitTriangle::NONE,
            nearest_other_reach: infinite,
            ambiguous_at: infinite,
        }
    }

    /// Starts again, with the smallest distance from a first pass.
    pub(in super::super) fn second_pass(&self, far: f32) -> Self {
        let mut again = Self::new(far);
        again.set_nearest_distance(self.distance);
        again
    }

    /// Returns whether [`Self::closest`] must be found by a second pass from [`Self::second_pass`], which is never ambiguous.
    #[inline(always)]
    pub(in super::super) fn is_ambiguous(&self) -> bool {
        self.ambiguous_at < f32::INFINITY
            && self.ambiguous_at <= coincidence_max_distance(self.distance)
    }

    #[inline(always)]
    fn set_nearest_distance(&mut self, distance: f32) {
        let horizon = coincidence_max_distance(distance);
        self.distance = distance;
        self.limit = if horizon < self.limit {
            horizon
        } else {
            self.limit
        };
    }

    /// Takes a hit within [`Self::limit`] into account; `claim` gives the tie-break of this one and earlier ones.
    #[inline(always)]
    pub(in super::super) fn consider(
        &mut self,
        distance: f32,
        hit: HitTriangle,
        claim: impl Fn(HitTriangle) -> TieBreak,
    ) {
        if coincidence_max_distance(distance) < self.distance {
            // Clearly nearer than all before: none of them can be coincident with it.
            self.closest = hit;
            self.set_nearest_distance(distance);
        } else {
            self.consider_coincident(distance, hit, &claim);
        }
    }

    /// As [`Self::consider`], when hits may be coincident.
    #[cold]
    pub(in super::super) fn consider_coincident(
        &mut self,
        distance: f32,
        hit: HitTriangle,
        claim: &dyn Fn(HitTriangle) -> TieBreak,
    ) {
        let new = claim(hit);
        if new.reach > self.distance {
            return;
        }
        let shorter = distance < self.distance;
        let nearest = if shorter { distance } else { self.distance };
        if self.closest == HitTriangle::NONE {
            self.closest = hit;
        } else {
            let old = claim(self.closest);
            if (new.id, hit.source, new.triangle) < (old.id, self.closest.source, old.triangle) {
                self.nearest_other_reach = self.nearest_other_reach.min(old.reach);
                self.closest = hit;
            } else if old.reach <= nearest {
                self.nearest_other_reach = self.nearest_other_reach.min(new.reach);
            } else {
                // The winner fell back; a hit that lost to it may win over this one.
                if self.nearest_other_reach <= nearest {
                    self.ambiguous_at = nearest;
                }
                self.closest = hit;
            }
        }
        if shorter {
            self.set_nearest_distance(distance);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::RandomKey;
    use proptest::prelude::*;

    /// Distance and tie-break.
    type Hit = (f32, TieBreak);

    /// The rule as stated above.
    fn plainly(hits: &[Hit]) -> Option<usize> {
        let nearest = hits.iter().map(|hit| hit.0).fold(f32::INFINITY, f32::min);
        let coincident = (0..hits.len()).filter(|k| hits[*k].1.reach <= nearest);
        coincident.min_by_key(|k| (hits[*k].1.id, hits[*k].1.triangle))
    }

    fn offer_all(nearest: &mut ClosestHit, hits: &[Hit], order: &[usize]) {
        for &k in order {
            // Traversal skips what lies beyond the limit.
            if hits[k].0 <= nearest.limit {
                let place = |slot| HitTriangle { source: 0, slot };
                nearest.consider(hits[k].0, place(k as u32), |p| hits[p.slot as usize].1);
            }
        }
    }

    proptest! {
        #[test]
        fn the_winner_does_not_depend_on_the_order(seed in any::<u64>(), count in 0_usize..9) {
            let mut stream = RandomKey::root(seed).stream();
            let hits: Vec<Hit> = (0..count)
                .map(|k| {
                    // Within a few tolerances of each other, seen straight on and at grazing angles.
                    let distance = 3.0 + stream.below(12) as f32 * 0.7e-5;
                    let cosine = [1.0, 0.5, 0.1, 0.001][stream.below(4)];
                    let id = stream.below(6) as i32;
                    (distance, TieBreak { reach: coincidence_min_distance(distance, cosine), id, triangle: k as u32 })
                })
                .collect();
            let expected = plainly(&hits);
            let mut order: Vec<usize> = (0..count).collect();
            for _ in 0..20 {
                stream.shuffle(&mut order);
                let mut nearest = ClosestHit::new(f32::INFINITY);
                offer_all(&mut nearest, &hits, &order);
                if nearest.is_ambiguous() {
                    nearest = nearest.second_pass(f32::INFINITY);
                    stream.shuffle(&mut order);
                    offer_all(&mut nearest, &hits, &order);
                    prop_assert!(!nearest.is_ambiguous());
                }
                let found = (nearest.closest != HitTriangle::NONE).then_some(nearest.closest.slot as usize);
                prop_assert_eq!(found, expected);
            }
        }
    }

    #[test]
    fn nothing_beyond_the_horizon_is_coincident() {
        for k in 0..2000 {
            let distance = 1.01_f32.powi(k % 1000) * 1e-3;
            let beyond = f32::from_bits(coincidence_max_distance(distance).to_bits() + 1);
            assert!(
                coincidence_min_distance(beyond, 0.0) > distance,
                "{distance}"
            );
            assert!(coincidence_min_distance(distance, 1.0) < distance);
        }
    }
}
