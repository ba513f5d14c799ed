//! Single rays against one tree. Leaf and hit visitors are traits, since closures cannot be made to compile inline.

use glam::Vec4;

use super::super::node::{Node, NodeLink, STACK, TriangleBlock};
use super::super::triangles::TriangleBvh;
use super::super::wide::WideBvh;
use super::closest_hit::HitTriangle;
use super::slab::{
    PaddedOrigin, box_margin, max_f32, min_f32, safe_inverse, slab_range, slab_range4,
};
use super::triangle::{EdgePlanes, bounds, clamped_hit_distance, dot, plane_distance};
use super::{HitFilter, array3};
use crate::bounds::Aabb;

/// A ray in the space of a tree, prepared. Its direction need not have unit length: distances are multiples of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct PreparedRay {
    pub(super) origin: [f32; 3],
    pub(super) direction: [f32; 3],
    inverse: [f32; 3],
    wide: PaddedOrigin,
    margin: f32,
    /// See [`EdgePlanes::new`].
    longest: f32,
    pub(super) near: f32,
    /// Hits beyond do not count.
    pub(super) far: f32,
}

impl PreparedRay {
    #[inline(always)]
    pub(super) fn new(
        all: &Aabb,
        origin: [f32; 3],
        direction: [f32; 3],
        (near, far): (f32, f32),
        longest: f32,
    ) -> Self {
        let margin = box_margin(origin, all);
        let wide = PaddedOrigin::new(origin, margin);
        let inverse = array3(|axis| safe_inverse(direction[axis]));
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

    /// Returns whether origin and direction survived a transform.
    #[inline(always)]
    pub(super) fn is_usable(&self) -> bool {
        let finite = |v: &[f32; 3]| v[0].is_finite() && v[1].is_finite() && v[2].is_finite();
        finite(&self.origin) && finite(&self.direction)
    }

    /// Returns the interval of the ray inside a box, within its own range.
    #[inline(always)]
    pub(super) fn range_in_box(&self, bounds: &Aabb) -> (f32, f32) {
        let (min, max) = self.wide.corners(bounds.min.as_ref(), bounds.max.as_ref());
        let (enter, leave) = slab_range(&min, &max, self.inverse);
        (max_f32(enter, self.near), min_f32(leave, self.far))
    }

    /// Returns the children whose boxes the ray enters up to `limit`, as bits, and the entry distances.
    #[inline(always)]
    fn intersect_children(&self, node: &Node, limit: f32) -> (u32, Vec4) {
        let (enter, leave) = slab_range4(
            node,
            &self.wide,
            &array3(|axis| Vec4::splat(self.inverse[axis])),
        );
        let enter = enter.max(Vec4::splat(self.near));
        (
            enter.cmple(leave.min(Vec4::splat(limit))).bitmask() & node.present,
            enter,
        )
    }

    /// Returns the distance at which the ray hits a triangle of a block that it may pass inside, or NaN.
    #[inline(always)]
    fn distance(&self, triangles: &TriangleBlock, lane: usize) -> f32 {
        let [x, y, z] = self.direction;
        let slope = dot(triangles.normal_of(lane), x, y, z);
        let distance = plane_distance(triangles, lane, self.origin) / slope;
        let (min, max) = bounds(triangles, lane);
        let (min, max) = self.wide.corners(&min, &max);
        let crossing = slab_range(&min, &max, self.inverse);
        clamped_hit_distance(distance, slope, crossing, self.margin)
    }
}

/// A visitor of a tree's leaves.
pub(super) trait RayLeafVisitor {
    /// Visits a leaf; may lower the limit beyond which nothing matters. Returns whether to stop.
    fn visit_leaf(&mut self, index: usize, limit: &mut f32) -> bool;
}

/// Visits the leaves that a ray enters before `limit`, nearer ones first, until the visitor stops it.
#[inline(always)]
pub(super) fn traverse(
    tree: &WideBvh,
    probe: &PreparedRay,
    mut limit: f32,
    visit: &mut impl RayLeafVisitor,
) -> bool {
    let mut stack = [(0.0_f32, NodeLink::NONE); STACK];
    let mut top = 0;
    let mut link = tree.root;
    if link == NodeLink::NONE {
        return false;
    }
    loop {
        let (is_leaf, index) = link.unpack();
        if is_leaf {
            if visit.visit_leaf(index, &mut limit) {
                return true;
            }
        } else {
            let node = &tree.nodes[index];
            let (hits, enter) = probe.intersect_children(node, limit);
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

/// A visitor of hits.
pub(in super::super) trait HitVisitor {
    /// Takes a hit. Returns whether to stop.
    fn visit_hit(&mut self, place: HitTriangle, distance: f32) -> bool;

    /// Returns the distance beyond which no hit matters.
    fn limit(&self) -> f32;
}

/// Passes the hits with the triangles of a tree to `hits`, until it stops; `source` as in [`HitTriangle`].
#[inline(always)]
pub(super) fn intersect_tree<H: HitVisitor>(
    bvh: &TriangleBvh,
    probe: &PreparedRay,
    filter: &HitFilter,
    source: u32,
    hits: &mut H,
) -> bool {
    let limit = min_f32(hits.limit(), probe.far);
    let mut triangles = LeafTriangleIntersector {
        bvh,
        probe,
        filter,
        source,
        hits,
    };
    traverse(&bvh.tree, probe, limit, &mut triangles)
}

/// The triangles of a tree.
struct LeafTriangleIntersector<'a, H> {
    bvh: &'a TriangleBvh,
    probe: &'a PreparedRay,
    filter: &'a HitFilter,
    source: u32,
    hits: &'a mut H,
}

impl<H: HitVisitor> RayLeafVisitor for LeafTriangleIntersector<'_, H> {
    #[inline(always)]
    fn visit_leaf(&mut self, block: usize, limit: &mut f32) -> bool {
        let (probe, source) = (self.probe, self.source);
        let triangles = &self.bvh.blocks[block];
        let planes = EdgePlanes::new(triangles, probe.origin, probe.longest);
        let mut candidates = planes.triangles_hit(probe.direction);
        while candidates != 0 {
            let lane = candidates.trailing_zeros() as usize;
            candidates &= candidates - 1;
            let slot = block * 4 + lane;
            let distance = probe.distance(triangles, lane);
            let in_range = distance >= probe.near && distance <= probe.far;
            if !in_range || !self.filter.admits_surface(&self.bvh.surfaces[slot]) {
                continue;
            }
            let slot = slot as u32;
            if self.hits.visit_hit(HitTriangle { source, slot }, distance) {
                return true;
            }
        }
        *limit = min_f32(self.hits.limit(), *limit);
        false
    }
}
