//! One ray against one tree.

use glam::Vec4;

use super::super::node::{Link, Node, STACK};
use super::super::triangles::TriangleBvh;
use super::super::wide::WideTree;
use super::nearest::{Claim, Nearest, Place};
use super::slab::{WideOrigin, crossing, crossing4, inverse, least, margin, most};
use super::triangle::{EdgePlanes, bounds, dot, height_of, settled};
use super::{Filter, three};
use crate::bounds::Aabb;

/// A ray in the space of a tree, prepared. Its direction need not have unit length: distances are multiples of it.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Probe {
    pub(in super::super) origin: [f32; 3],
    pub(in super::super) direction: [f32; 3],
    inverse: [f32; 3],
    wide: WideOrigin,
    margin: f32,
    /// See [`EdgePlanes::new`].
    longest: f32,
    pub(in super::super) near: f32,
    /// Hits beyond do not count.
    pub(in super::super) far: f32,
}

impl Probe {
    #[inline(always)]
    pub(in super::super) fn new(
        all: &Aabb,
        origin: [f32; 3],
        direction: [f32; 3],
        (near, far): (f32, f32),
        longest: f32,
    ) -> Self {
        let margin = margin(origin, all);
        let wide = WideOrigin::new(origin, margin);
        let inverse = three(|axis| inverse(direction[axis]));
        Self {
            origin,
            direction,
            inverse,
            wide,
            margin,
            longest,
            near,
            far,
        }
    }

    /// Whether origin and direction survived a transform.
    #[inline(always)]
    pub(in super::super) fn is_usable(&self) -> bool {
        let finite = |v: &[f32; 3]| v[0].is_finite() && v[1].is_finite() && v[2].is_finite();
        finite(&self.origin) && finite(&self.direction)
    }

    /// Where the ray is inside a box, within its own range.
    #[inline(always)]
    pub(in super::super) fn range_in(&self, bounds: &Aabb) -> (f32, f32) {
        let (min, max) = self.wide.corners(bounds.min.as_ref(), bounds.max.as_ref());
        let (enter, leave) = crossing(&min, &max, self.inverse);
        (most(enter, self.near), least(leave, self.far))
    }

    /// Children whose boxes the ray enters up to `limit`, as bits, and where.
    #[inline(always)]
    fn enters(&self, node: &Node, limit: f32) -> (u32, Vec4) {
        let (enter, leave) = crossing4(
            node,
            &self.wide,
            &three(|axis| Vec4::splat(self.inverse[axis])),
        );
        let enter = enter.max(Vec4::splat(self.near));
        (
            enter.cmple(leave.min(Vec4::splat(limit))).bitmask() & node.present,
            enter,
        )
    }

    /// Calls `found` for the hits with a block of triangles, with their slot and distance, until it returns `true`.
    #[inline(always)]
    fn meet(
        &self,
        bvh: &TriangleBvh,
        block: usize,
        filter: &Filter,
        mut found: impl FnMut(u32, f32) -> bool,
    ) -> bool {
        let triangles = &bvh.blocks[block];
        let planes = EdgePlanes::new(triangles, self.origin, self.longest);
        let mut candidates = planes.inside(self.direction);
        while candidates != 0 {
            let lane = candidates.trailing_zeros() as usize;
            candidates &= candidates - 1;
            let slot = block * 4 + lane;
            let [x, y, z] = self.direction;
            let slope = dot(triangles.normal_of(lane), x, y, z);
            let distance = height_of(triangles, lane, self.origin) / slope;
            let (min, max) = bounds(triangles, lane);
            let (min, max) = self.wide.corners(&min, &max);
            let distance = settled(
                distance,
                slope,
                crossing(&min, &max, self.inverse),
                self.margin,
            );
            let in_range = distance >= self.near && distance <= self.far;
            if in_range
                && filter.admits_surface(&bvh.surfaces[slot])
                && found(slot as u32, distance)
            {
                return true;
            }
        }
        false
    }
}

/// Visits the leaves that a ray enters before `limit`, nearer ones first, until `leaf` returns `true`. `leaf` may lower the
/// limit.
#[inline(always)]
pub(in super::super) fn traverse(
    tree: &WideTree,
    probe: &Probe,
    mut limit: f32,
    mut leaf: impl FnMut(usize, &mut f32) -> bool,
) -> bool {
    let mut stack = [(0.0_f32, Link::NONE); STACK];
    let mut top = 0;
    let mut link = tree.top;
    if link == Link::NONE {
        return false;
    }
    loop {
        let (is_leaf, index) = link.parts();
        if is_leaf {
            if leaf(index, &mut limit) {
                return true;
            }
        } else {
            let node = &tree.nodes[index];
            let (hits, enter) = probe.enters(node, limit);
            if hits != 0 {
                link = super::push_further(node, hits, enter, &mut stack, &mut top);
                continue;
            }
        }
        loop {
            if top == 0 {
                return false;
            }
            top -= 1;
            if stack[top].0 <= limit {
                link = stack[top].1;
                break;
            }
        }
    }
}

/// Offers every hit that may matter to `nearest`.
#[inline(always)]
pub(in super::super) fn closest(
    bvh: &TriangleBvh,
    probe: &Probe,
    filter: &Filter,
    source: u32,
    nearest: &mut Nearest,
    claim: impl Fn(Place) -> Claim,
) {
    traverse(
        &bvh.tree,
        probe,
        least(nearest.limit, probe.far),
        |block, limit| {
            probe.meet(bvh, block, filter, |slot, distance| {
                if distance <= *limit {
                    nearest.offer(distance, Place { source, slot }, &claim);
                    *limit = least(nearest.limit, probe.far);
                }
                false
            })
        },
    );
}

/// Whether anything lies in the ray's range.
#[inline(always)]
pub(in super::super) fn occluded(bvh: &TriangleBvh, probe: &Probe, filter: &Filter) -> bool {
    traverse(&bvh.tree, probe, probe.far, |block, _| {
        probe.meet(bvh, block, filter, |_, _| true)
    })
}

/// Calls `found` for every hit in the ray's range, in no particular order.
pub(in super::super) fn every(
    bvh: &TriangleBvh,
    probe: &Probe,
    filter: &Filter,
    mut found: impl FnMut(u32, f32),
) {
    traverse(&bvh.tree, probe, probe.far, |block, _| {
        probe.meet(bvh, block, filter, |slot, distance| {
            found(slot, distance);
            false
        })
    });
}
