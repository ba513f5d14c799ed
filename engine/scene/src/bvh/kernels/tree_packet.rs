//! Traversal of a tree by a packet of rays, and its leaf visitors.

use super::super::node::{NodeLink, STACK};
use super::super::triangles::TriangleBvh;
use super::super::wide::WideBvh;
use super::HitFilter;
use super::closest_hit::{ClosestHit, HitTriangle, TieBreak, coincidence_max_distance};
use super::prepared_packet::PreparedPacket;
use super::slab::min_f32;
use super::triangle::{EdgePlanes, OriginTriangles};

/// A visitor of a tree's leaves. A trait, not a closure: closures cannot be made to compile inline, and code that is not
/// inline does not use the instructions of the function around it.
pub(in super::super) trait PacketLeafVisitor<const N: usize> {
    /// May lower limits; returns whether to stop.
    fn visit_leaf(&mut self, fan: &mut PreparedPacket<N>, index: usize) -> bool;
}

/// Visits the leaves that some ray enters before its limit, nearer ones first, until the visitor stops it.
#[inline(always)]
pub(in super::super) fn traverse<const N: usize>(
    tree: &WideBvh,
    fan: &mut PreparedPacket<N>,
    visit: &mut impl PacketLeafVisitor<N>,
) {
    let mut stack = [(0.0_f32, NodeLink::NONE); STACK];
    let mut top = 0;
    let mut link = tree.root;
    if link == NodeLink::NONE || fan.is_done() {
        return;
    }
    loop {
        let (is_leaf, index) = link.unpack();
        if is_leaf {
            if visit.visit_leaf(fan, index) {
                return;
            }
        } else {
            let node = &tree.nodes[index];
            let (hits, enter) = fan.intersect_children(node);
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
            if stack[top].0 <= fan.max_limit {
                link = stack[top].1;
                break;
            }
        }
    }
}

/// The closest hits so far of the rays of a packet; see [`ClosestHit`].
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(in super::super) struct PacketClosestHits<const N: usize> {
    pub(in super::super) distance: [f32; N],
    pub(in super::super) slot: [u32; N],
    pub(in super::super) source: [u32; N],
    others: [f32; N],
    ambiguous_at: [f32; N],
}

impl<const N: usize> PacketClosestHits<N> {
    pub(in super::super) fn new() -> Self {
        let infinite = [f32::INFINITY; N];
        let HitTriangle { source, slot } = HitTriangle::NONE;
        Self {
            distance: infinite,
            slot: [slot; N],
            source: [source; N],
            others: infinite,
            ambiguous_at: infinite,
        }
    }

    pub(in super::super) fn lane(&self, k: usize, limit: f32) -> ClosestHit {
        let best = HitTriangle {
            source: self.source[k],
            slot: self.slot[k],
        };
        ClosestHit {
            distance: self.distance[k],
            limit,
            closest: best,
            nearest_other_reach: self.others[k],
            ambiguous_at: self.ambiguous_at[k],
        }
    }

    #[cold]
    #[inline(never)]
    fn consider_coincident(
        &mut self,
        k: usize,
        limit: &mut f32,
        distance: f32,
        hit: HitTriangle,
        claim: &dyn Fn(HitTriangle) -> TieBreak,
    ) {
        let mut nearest = self.lane(k, *limit);
        nearest.consider_coincident(distance, hit, claim);
        *limit = nearest.limit;
        self.distance[k] = nearest.distance;
        self.others[k] = nearest.nearest_other_reach;
        self.ambiguous_at[k] = nearest.ambiguous_at;
        self.set(k, nearest.closest);
    }

    pub(in super::super) fn is_ambiguous(&self, k: usize) -> bool {
        self.lane(k, f32::INFINITY).is_ambiguous()
    }

    pub(in super::super) fn set(&mut self, k: usize, best: HitTriangle) {
        (self.source[k], self.slot[k]) = (best.source, best.slot);
    }
}

/// Calls `take` for each triangle of a block that some rays hit.
macro_rules! for_each_hit {
    ($bvh:expr, $fan:expr, $filter:expr, $block:expr, |$slot:ident, $distances:ident| $take:expr) => {
        let block = &$bvh.blocks[$block];
        let planes = EdgePlanes::new(block, $fan.origin, $fan.max_direction_component);
        let mut candidates = planes.triangles_hit_by_any($fan.min_direction, $fan.max_direction);
        if candidates != 0 {
            let facets = OriginTriangles::new(block, &planes, $fan.origin, &$fan.padded_origin);
            while candidates != 0 {
                let lane = candidates.trailing_zeros() as usize;
                candidates &= candidates - 1;
                let $slot = $block * 4 + lane;
                if $filter.admits_surface(&$bvh.surfaces[$slot])
                    && let Some($distances) = $fan.intersect_triangle(&facets, lane)
                {
                    $take;
                }
            }
        }
    };
}

/// Offers every hit with a tree's triangles to the results of the rays.
pub(in super::super) struct ClosestLeafVisitor<'a, const N: usize, C> {
    pub(in super::super) bvh: &'a TriangleBvh,
    pub(in super::super) source: u32,
    pub(in super::super) filter: HitFilter,
    pub(in super::super) hits: &'a mut PacketClosestHits<N>,
    /// The order among coincident hits, by lane.
    pub(in super::super) tie_break: C,
}

impl<const N: usize, C: Fn(usize, HitTriangle) -> TieBreak> PacketLeafVisitor<N>
    for ClosestLeafVisitor<'_, N, C>
{
    #[inline(always)]
    fn visit_leaf(&mut self, fan: &mut PreparedPacket<N>, block: usize) -> bool {
        for_each_hit!(self.bvh, fan, &self.filter, block, |slot, distances| self
            .take(fan, slot as u32, &distances));
        false
    }
}

/// Deactivates rays that hit anything.
pub(in super::super) struct OccludedLeafVisitor<'a> {
    pub(in super::super) bvh: &'a TriangleBvh,
    pub(in super::super) filter: HitFilter,
}

impl<const N: usize> PacketLeafVisitor<N> for OccludedLeafVisitor<'_> {
    #[inline(always)]
    fn visit_leaf(&mut self, fan: &mut PreparedPacket<N>, block: usize) -> bool {
        for_each_hit!(self.bvh, fan, &self.filter, block, |_slot, distances| {
            for k in 0..N {
                fan.limit[k] = if distances[k].is_nan() {
                    fan.limit[k]
                } else {
                    f32::NEG_INFINITY
                };
            }
            fan.update_limit_bounds();
        });
        fan.is_done()
    }
}

impl<const N: usize, C: Fn(usize, HitTriangle) -> TieBreak> ClosestLeafVisitor<'_, N, C> {
    /// Offers the hits with one triangle; no hit where the distance is NaN.
    #[inline(always)]
    fn take(&mut self, fan: &mut PreparedPacket<N>, slot: u32, distances: &[f32; N]) {
        // From copies into new arrays and without branches, so that the loop becomes vector instructions.
        let (before, slots, limits) = (self.hits.distance, self.hits.slot, fan.limit);
        let (mut new_distance, mut new_slot, mut new_limit) = ([0.0; N], [0_u32; N], [0.0; N]);
        let (mut any_close, mut close) = (0_u32, [0_u32; N]);
        for k in 0..N {
            let horizon = coincidence_max_distance(distances[k]);
            let clear = u32::from(horizon < before[k]);
            let closes = u32::from(distances[k] <= limits[k]) & !clear;
            close[k] = closes;
            any_close |= closes;
            let chosen = clear.wrapping_neg();
            new_distance[k] =
                f32::from_bits((distances[k].to_bits() & chosen) | (before[k].to_bits() & !chosen));
            new_slot[k] = (slot & chosen) | (slots[k] & !chosen);
            // NaN without a hit keeps the old limit; an ambiguous hit is beyond it or lowers it below.
            new_limit[k] = if horizon < before[k] {
                min_f32(horizon, limits[k])
            } else {
                limits[k]
            };
        }
        if self.source != 0 {
            for k in 0..N {
                let chosen = u32::from(new_distance[k] < before[k]).wrapping_neg();
                self.hits.source[k] = (self.source & chosen) | (self.hits.source[k] & !chosen);
            }
        }
        (self.hits.distance, self.hits.slot, fan.limit) = (new_distance, new_slot, new_limit);
        if any_close != 0 {
            for k in 0..N {
                if close[k] != 0 {
                    let hit = HitTriangle {
                        source: self.source,
                        slot,
                    };
                    self.hits.consider_coincident(
                        k,
                        &mut fan.limit[k],
                        distances[k],
                        hit,
                        &|place| (self.tie_break)(k, place),
                    );
                }
            }
        }
        fan.update_limit_bounds();
    }
}
