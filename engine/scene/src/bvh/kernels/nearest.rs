//! Which of all hits counts: the nearest, and among coincident surfaces the one with the lowest id.
//!
//! Rule. Let `t` be the smallest distance of any hit. A hit at `s` is coincident with it when its surface passes within
//! [`tolerance`] of the nearest hit: `(s - t) |cos| <= tolerance(s)`, where `cos` is the cosine between ray and normal,
//! floored at 1 / [`GRAZING`]. Of the coincident hits the lowest (id, source, triangle) is the answer. The rule speaks of
//! the set of hits, not of an order, so every tree and kernel must agree. What follows applies it while hits come in any
//! order, and says when the memory of one hit was too small to know ([`Nearest::is_unsure`]).

/// Absolute part of the distance within which surfaces coincide, m.
const TOLERANCE_M: f32 = 1e-5;

/// Relative part: computed distances differ in the last bits.
const TOLERANCE_PER_M: f32 = 1e-6;

/// Along the ray coincidence reaches at most this many times the tolerance.
const GRAZING: f32 = 32.0;

/// Distance between surfaces that count as one, m, for a hit at `distance` (m).
#[inline(always)]
fn tolerance(distance: f32) -> f32 {
    TOLERANCE_M + TOLERANCE_PER_M * distance
}

/// The smallest distance of a nearest hit with which a hit is coincident. `cosine` is that between ray and normal, >= 0.
#[inline(always)]
pub(in super::super) fn reach(distance: f32, cosine: f32) -> f32 {
    let slope = 1.0 / cosine;
    let slope = if slope < GRAZING { slope } else { GRAZING };
    distance - tolerance(distance) * slope
}

/// The largest distance of a hit that may be coincident with a nearest hit at `distance`.
#[inline(always)]
pub(in super::super) fn horizon(distance: f32) -> f32 {
    (distance + GRAZING * TOLERANCE_M) * (1.0 + 2.0 * GRAZING * TOLERANCE_PER_M)
}

/// A hit that passed every test.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Candidate {
    pub(in super::super) distance: f32,
    /// See [`reach`].
    pub(in super::super) reach: f32,
    pub(in super::super) id: i32,
    /// 0 for static geometry, else the instance plus 1.
    pub(in super::super) source: u32,
    /// Position of the triangle in its input.
    pub(in super::super) triangle: u32,
    /// Position of the triangle in its tree.
    pub(in super::super) slot: u32,
}

impl Candidate {
    #[inline]
    fn precedes(&self, other: &Self) -> bool {
        (self.id, self.source, self.triangle) < (other.id, other.source, other.triangle)
    }
}

/// The answer so far for one ray.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Nearest {
    /// Boxes and hits beyond this distance cannot matter.
    pub(in super::super) limit: f32,
    /// The smallest distance so far; infinite before the first hit.
    pub(in super::super) distance: f32,
    /// The winner so far; its distance is infinite before the first hit.
    pub(in super::super) best: Candidate,
    /// The smallest reach of any other hit that may still matter.
    others: f32,
    unsure: bool,
}

impl Nearest {
    pub(in super::super) fn new(far: f32) -> Self {
        let best =
            Candidate { distance: f32::INFINITY, reach: f32::INFINITY, id: 0, source: 0, triangle: 0, slot: u32::MAX };
        Self { limit: far, distance: f32::INFINITY, best, others: f32::INFINITY, unsure: false }
    }

    /// Starts again, knowing the smallest distance from a first run.
    pub(in super::super) fn again(&self, far: f32) -> Self {
        let limit = if horizon(self.distance) < far { horizon(self.distance) } else { far };
        Self { limit, distance: self.distance, ..Self::new(far) }
    }

    /// Whether [`Self::best`] must be found by a second run from [`Self::again`], which is always sure.
    pub(in super::super) fn is_unsure(&self) -> bool {
        self.unsure
    }

    pub(in super::super) fn hit(&self) -> Option<&Candidate> {
        (self.best.slot != u32::MAX).then_some(&self.best)
    }

    /// Takes a hit into account; its distance must not exceed [`Self::limit`].
    #[inline(always)]
    pub(in super::super) fn offer(&mut self, hit: Candidate) {
        let horizon = horizon(hit.distance);
        if horizon < self.distance {
            // Clearly nearer than all before: none of them can be coincident with it.
            self.best = hit;
            self.others = f32::INFINITY;
            self.unsure = false;
            self.distance = hit.distance;
            self.limit = if horizon < self.limit { horizon } else { self.limit };
        } else {
            self.weigh(hit);
        }
    }

    #[cold]
    fn weigh(&mut self, hit: Candidate) {
        if hit.reach > self.distance {
            return;
        }
        let distance = if hit.distance < self.distance { hit.distance } else { self.distance };
        if self.best.slot == u32::MAX || hit.precedes(&self.best) {
            self.others = self.others.min(self.best.reach);
            self.best = hit;
        } else if self.best.reach <= distance {
            self.others = self.others.min(hit.reach);
        } else {
            // The winner so far fell back; a hit that lost to it may now win over this one.
            self.unsure |= self.others <= distance;
            self.best = hit;
        }
        if distance < self.distance {
            self.distance = distance;
            let horizon = horizon(distance);
            self.limit = if horizon < self.limit { horizon } else { self.limit };
        }
    }
}
