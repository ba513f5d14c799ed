//! Many rays with one origin against one tree: boxes and planes are moved to the origin once for all rays.

use glam::Vec4;

use super::super::node::{Link, Node, STACK};
use super::super::triangles::TriangleBvh;
use super::super::wide::WideTree;
use super::Filter;
use super::nearest::{Claim, Nearest, Place, horizon};
use super::slab::{LARGEST_INVERSE, WideOrigin, crossing, inverse, least, margin, most};
use super::triangle::{EdgePlanes, bounds, corner_height, dot, inside, settled};
use crate::bounds::Aabb;

/// Rays with one origin in the space of a tree, prepared; lanes side by side.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(in super::super) struct Fan<const N: usize> {
    pub(in super::super) direction: [[f32; N]; 3],
    inverse: [[f32; N]; 3],
    pub(in super::super) near: [f32; N],
    /// Hits beyond do not matter; below everything for a lane that is out of use.
    pub(in super::super) limit: [f32; N],
    pub(in super::super) origin: [f32; 3],
    wide: WideOrigin,
    margin: f32,
    /// See [`EdgePlanes::new`].
    longest: f32,
    /// Bounds of the range over all rays in use.
    nearest: f32,
    pub(in super::super) furthest: f32,
    /// Bounds of the direction. Shape (axis,).
    lowest: [f32; 3],
    highest: [f32; 3],
    /// Bounds of the inverse direction; everything where it has both signs.
    slow: [f32; 3],
    fast: [f32; 3],
    /// Infinite where the inverse direction has both signs, else nothing.
    leave_at_least: [f32; 3],
    /// Which plane of a box the rays meet first along an axis, and which last.
    first: [usize; 3],
    last: [usize; 3],
    mixed: bool,
}

impl<const N: usize> Fan<N> {
    /// A lane is out of use where its range is empty.
    #[inline(always)]
    pub(in super::super) fn new(
        all: &Aabb,
        origin: [f32; 3],
        direction: &[[f32; N]; 3],
        (near, far): (&[f32; N], &[f32; N]),
        longest: f32,
    ) -> Self {
        let mut inverses = [[0.0; N]; 3];
        let (mut lowest, mut highest) = ([0.0; 3], [0.0; 3]);
        for axis in 0..3 {
            let (mut low, mut high) = ([0.0; N], [0.0; N]);
            for k in 0..N {
                let value = direction[axis][k];
                let used = near[k] <= far[k];
                inverses[axis][k] = inverse(value);
                low[k] = if used { value } else { f32::INFINITY };
                high[k] = if used { value } else { f32::NEG_INFINITY };
            }
            (lowest[axis], highest[axis]) = (lowest_of(low), highest_of(high));
        }
        let (mut limit, mut start) = ([0.0; N], [0.0; N]);
        for k in 0..N {
            let used = near[k] <= far[k];
            limit[k] = if used { far[k] } else { f32::NEG_INFINITY };
            start[k] = if used { near[k] } else { f32::INFINITY };
        }
        let margin = margin(origin, all);
        let mixed = [0, 1, 2].map(|axis| lowest[axis] <= 0.0 && highest[axis] >= 0.0);
        let up = [0, 1, 2].map(|axis| lowest[axis] > 0.0);
        Self {
            direction: *direction,
            inverse: inverses,
            near: start,
            limit,
            origin,
            wide: WideOrigin::new(origin, margin),
            margin,
            longest,
            nearest: lowest_of(start),
            furthest: highest_of(limit),
            lowest,
            highest,
            slow: [0, 1, 2].map(|axis| {
                if mixed[axis] {
                    -LARGEST_INVERSE
                } else {
                    inverse(highest[axis])
                }
            }),
            fast: [0, 1, 2].map(|axis| {
                if mixed[axis] {
                    LARGEST_INVERSE
                } else {
                    inverse(lowest[axis])
                }
            }),
            leave_at_least: mixed.map(|mixed| {
                if mixed {
                    f32::INFINITY
                } else {
                    f32::NEG_INFINITY
                }
            }),
            first: [0, 1, 2].map(|axis| if up[axis] { axis } else { axis + 3 }),
            last: [0, 1, 2].map(|axis| if up[axis] { axis + 3 } else { axis }),
            mixed: mixed != [false; 3],
        }
    }

    /// Whether no ray is in use.
    #[inline(always)]
    pub(in super::super) fn is_done(&self) -> bool {
        self.furthest == f32::NEG_INFINITY
    }

    /// To be called after a change of `limit`.
    #[inline(always)]
    pub(in super::super) fn limits_changed(&mut self) {
        self.furthest = highest_of(self.limit);
    }

    /// Where each ray is inside a box, within its own range.
    #[inline(always)]
    pub(in super::super) fn range_in(&self, bounds: &Aabb) -> ([f32; N], [f32; N]) {
        let (min, max) = self.wide.corners(bounds.min.as_ref(), bounds.max.as_ref());
        let [ix, iy, iz] = &self.inverse;
        let (mut start, mut end) = ([0.0; N], [0.0; N]);
        for k in 0..N {
            let (enter, leave) = crossing(&min, &max, [ix[k], iy[k], iz[k]]);
            start[k] = most(enter, self.near[k]);
            end[k] = least(leave, self.limit[k]);
        }
        (start, end)
    }

    /// Children whose boxes some ray enters before its limit, as bits, and a lower bound of where.
    #[inline(always)]
    fn enters(&self, node: &Node) -> (u32, Vec4) {
        // All rays at once by the bounds of their directions; this loses nothing, as rounding is monotone.
        let mut enter = Vec4::splat(self.nearest);
        let mut leave = Vec4::splat(self.furthest);
        let mut planes = [[0.0; 4]; 6];
        for axis in 0..3 {
            let (first, last) = (self.first[axis], self.last[axis]);
            let first = node.planes[first] - Vec4::splat(self.wide.0[first]);
            let last = node.planes[last] - Vec4::splat(self.wide.0[last]);
            let (slow, fast) = (Vec4::splat(self.slow[axis]), Vec4::splat(self.fast[axis]));
            enter = enter.max((first * slow).min(first * fast));
            leave = leave.min(
                (last * slow)
                    .max(last * fast)
                    .max(Vec4::splat(self.leave_at_least[axis])),
            );
            planes[axis] = first.to_array();
            planes[axis + 3] = last.to_array();
        }
        let mut bits = enter.cmple(leave).bitmask() & node.present;
        let mut rest = bits;
        while rest != 0 {
            let k = rest.trailing_zeros() as usize;
            rest &= rest - 1;
            if !self.some_enter(
                &[0, 1, 2].map(|p| planes[p][k]),
                &[3, 4, 5].map(|p| planes[p][k]),
            ) {
                bits &= !(1 << k);
            }
        }
        (bits, enter)
    }

    /// Whether some ray enters a box before its limit. `first`, `last`: its planes as seen from the origin, in the order in
    /// which the rays meet them.
    #[inline(always)]
    fn some_enter(&self, first: &[f32; 3], last: &[f32; 3]) -> bool {
        let [ix, iy, iz] = &self.inverse;
        let mut any = 0_u32;
        if self.mixed {
            for k in 0..N {
                let (enter, leave) = crossing(first, last, [ix[k], iy[k], iz[k]]);
                any |= u32::from(most(enter, self.nearest) <= least(leave, self.limit[k]));
            }
        } else {
            for k in 0..N {
                let enter = most(
                    most(most(first[0] * ix[k], first[1] * iy[k]), first[2] * iz[k]),
                    self.nearest,
                );
                let leave = least(
                    least(least(last[0] * ix[k], last[1] * iy[k]), last[2] * iz[k]),
                    self.limit[k],
                );
                any |= u32::from(enter <= leave);
            }
        }
        any != 0
    }

    /// The distances at which the rays hit a triangle, NaN where they do not within their range, or nothing.
    #[inline(always)]
    pub(in super::super) fn meet(
        &self,
        bvh: &TriangleBvh,
        (block, lane): (usize, usize),
        planes: &EdgePlanes,
        filter: &Filter,
    ) -> Option<[f32; N]> {
        let surface = &bvh.surfaces[block * 4 + lane];
        if !filter.admits_surface(surface) {
            return None;
        }
        let ([u, v, w], tolerances) = planes.of(lane);
        let [x, y, z] = &self.direction;
        let height = corner_height(&bvh.blocks[block], lane, self.origin, surface.normal);
        let (min, max) = bounds(&bvh.blocks[block], lane);
        let (min, max) = self.wide.corners(&min, &max);
        let [ix, iy, iz] = &self.inverse;
        let mut distances = [0.0; N];
        let mut any = 0_u32;
        for k in 0..N {
            let (x, y, z) = (x[k], y[k], z[k]);
            let passes = inside(
                [dot(u, x, y, z), dot(v, x, y, z), dot(w, x, y, z)],
                tolerances,
            );
            let slope = dot(surface.normal, x, y, z);
            let range = crossing(&min, &max, [ix[k], iy[k], iz[k]]);
            let distance = settled(height / slope, slope, range, self.margin);
            let counts = passes & (distance >= self.near[k]) & (distance <= self.limit[k]);
            distances[k] = if counts { distance } else { f32::NAN };
            any |= u32::from(counts);
        }
        (any != 0).then_some(distances)
    }
}

#[inline(always)]
fn lowest_of<const N: usize>(mut values: [f32; N]) -> f32 {
    let mut half = N / 2;
    while half > 0 {
        for k in 0..half {
            values[k] = least(values[k], values[k + half]);
        }
        half /= 2;
    }
    values[0]
}

#[inline(always)]
fn highest_of<const N: usize>(mut values: [f32; N]) -> f32 {
    let mut half = N / 2;
    while half > 0 {
        for k in 0..half {
            values[k] = most(values[k], values[k + half]);
        }
        half /= 2;
    }
    values[0]
}

/// What happens at the leaves of a tree. A trait, not a closure: closures cannot be made to compile inline, and what is not
/// inline does not use the instructions of the function around it.
pub(in super::super) trait Visit<const N: usize> {
    /// May lower limits; returns whether to stop.
    fn leaf(&mut self, fan: &mut Fan<N>, index: usize) -> bool;
}

/// Visits the leaves that some ray enters before its limit, nearer ones first, until told to stop.
#[inline(always)]
pub(in super::super) fn traverse<const N: usize>(
    tree: &WideTree,
    fan: &mut Fan<N>,
    visit: &mut impl Visit<N>,
) {
    let mut stack = [(0.0_f32, Link::NONE); STACK];
    let mut top = 0;
    let mut link = tree.top;
    if link == Link::NONE || fan.is_done() {
        return;
    }
    loop {
        let (is_leaf, index) = link.parts();
        if is_leaf {
            if visit.leaf(fan, index) {
                return;
            }
        } else {
            let node = &tree.nodes[index];
            let (hits, enter) = fan.enters(node);
            if hits != 0 {
                link = super::push_further(node, hits, enter, &mut stack, &mut top);
                continue;
            }
        }
        loop {
            if top == 0 {
                return;
            }
            top -= 1;
            if stack[top].0 <= fan.furthest {
                link = stack[top].1;
                break;
            }
        }
    }
}

/// The answers so far of the rays of a packet; see [`Nearest`].
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(in super::super) struct Answers<const N: usize> {
    pub(in super::super) distance: [f32; N],
    pub(in super::super) slot: [u32; N],
    pub(in super::super) source: [u32; N],
    others: [f32; N],
    unsure_at: [f32; N],
}

impl<const N: usize> Answers<N> {
    pub(in super::super) fn new() -> Self {
        let infinite = [f32::INFINITY; N];
        let Place { source, slot } = Place::NONE;
        Self {
            distance: infinite,
            slot: [slot; N],
            source: [source; N],
            others: infinite,
            unsure_at: infinite,
        }
    }

    pub(in super::super) fn lane(&self, k: usize, limit: f32) -> Nearest {
        let best = Place {
            source: self.source[k],
            slot: self.slot[k],
        };
        Nearest {
            distance: self.distance[k],
            limit,
            best,
            others: self.others[k],
            unsure_at: self.unsure_at[k],
        }
    }

    #[cold]
    #[inline(never)]
    fn weigh(
        &mut self,
        k: usize,
        limit: &mut f32,
        distance: f32,
        hit: Place,
        claim: &dyn Fn(Place) -> Claim,
    ) {
        let mut nearest = self.lane(k, *limit);
        nearest.weigh(distance, hit, claim);
        *limit = nearest.limit;
        self.distance[k] = nearest.distance;
        self.others[k] = nearest.others;
        self.unsure_at[k] = nearest.unsure_at;
        self.set(k, nearest.best);
    }

    pub(in super::super) fn is_unsure(&self, k: usize) -> bool {
        self.lane(k, f32::INFINITY).is_unsure()
    }

    pub(in super::super) fn set(&mut self, k: usize, best: Place) {
        (self.source[k], self.slot[k]) = (best.source, best.slot);
    }
}

/// Calls `take` for each triangle of a block that some rays hit.
macro_rules! for_each_hit {
    ($bvh:expr, $fan:expr, $filter:expr, $block:expr, |$slot:ident, $distances:ident| $take:expr) => {
        let planes = EdgePlanes::new(&$bvh.blocks[$block], $fan.origin, $fan.longest);
        let mut candidates = planes.inside_some($fan.lowest, $fan.highest);
        while candidates != 0 {
            let lane = candidates.trailing_zeros() as usize;
            candidates &= candidates - 1;
            if let Some($distances) = $fan.meet($bvh, ($block, lane), &planes, $filter) {
                let $slot = ($block * 4 + lane) as u32;
                $take;
            }
        }
    };
}

/// Offers every hit with a tree's triangles to the answers of the rays.
pub(in super::super) struct Closest<'a, const N: usize, C> {
    pub(in super::super) bvh: &'a TriangleBvh,
    pub(in super::super) source: u32,
    pub(in super::super) filter: Filter,
    pub(in super::super) answers: &'a mut Answers<N>,
    /// What decides among coincident hits, by lane.
    pub(in super::super) claim: C,
}

impl<const N: usize, C: Fn(usize, Place) -> Claim> Visit<N> for Closest<'_, N, C> {
    #[inline(always)]
    fn leaf(&mut self, fan: &mut Fan<N>, block: usize) -> bool {
        for_each_hit!(self.bvh, fan, &self.filter, block, |slot, distances| self
            .take(fan, slot, &distances));
        false
    }
}

/// Takes rays out of use that hit anything.
pub(in super::super) struct Occluded<'a> {
    pub(in super::super) bvh: &'a TriangleBvh,
    pub(in super::super) filter: Filter,
}

impl<const N: usize> Visit<N> for Occluded<'_> {
    #[inline(always)]
    fn leaf(&mut self, fan: &mut Fan<N>, block: usize) -> bool {
        for_each_hit!(self.bvh, fan, &self.filter, block, |_slot, distances| {
            for k in 0..N {
                fan.limit[k] = if distances[k].is_nan() {
                    fan.limit[k]
                } else {
                    f32::NEG_INFINITY
                };
            }
            fan.limits_changed();
        });
        fan.is_done()
    }
}

impl<const N: usize, C: Fn(usize, Place) -> Claim> Closest<'_, N, C> {
    /// Offers the hits with one triangle; no hit where the distance is NaN.
    #[inline(always)]
    fn take(&mut self, fan: &mut Fan<N>, slot: u32, distances: &[f32; N]) {
        // From copies into new arrays and without branches, so that the loop becomes vector instructions.
        let (before, slots, limits) = (self.answers.distance, self.answers.slot, fan.limit);
        let (mut new_distance, mut new_slot, mut new_limit) = ([0.0; N], [0_u32; N], [0.0; N]);
        let (mut any_close, mut close) = (0_u32, [0_u32; N]);
        for k in 0..N {
            let horizon = horizon(distances[k]);
            let clear = u32::from(horizon < before[k]);
            let closes = u32::from(distances[k] <= limits[k]) & !clear;
            close[k] = closes;
            any_close |= closes;
            let chosen = clear.wrapping_neg();
            new_distance[k] =
                f32::from_bits((distances[k].to_bits() & chosen) | (before[k].to_bits() & !chosen));
            new_slot[k] = (slot & chosen) | (slots[k] & !chosen);
            // NaN without a hit keeps the old limit; a doubtful hit is beyond it or lowers it below.
            new_limit[k] = if horizon < before[k] {
                least(horizon, limits[k])
            } else {
                limits[k]
            };
        }
        if self.source != 0 {
            for k in 0..N {
                let chosen = u32::from(new_distance[k] < before[k]).wrapping_neg();
                self.answers.source[k] =
                    (self.source & chosen) | (self.answers.source[k] & !chosen);
            }
        }
        (self.answers.distance, self.answers.slot, fan.limit) = (new_distance, new_slot, new_limit);
        if any_close != 0 {
            for k in 0..N {
                if close[k] != 0 {
                    let hit = Place {
                        source: self.source,
                        slot,
                    };
                    self.answers
                        .weigh(k, &mut fan.limit[k], distances[k], hit, &|place| {
                            (self.claim)(k, place)
                        });
                }
            }
        }
        fan.limits_changed();
    }
}
