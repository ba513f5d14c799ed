//! One ray against one tree.

use super::super::node::{Node, STACK};
use super::super::triangles::{PackedTriangle, TriangleBvh};
use super::nearest::{Candidate, Nearest, reach};
use super::slab::{WideOrigin, crossing, inverse, least, margin, most};
use super::triangle::{EdgePlanes, dot, inside};
use crate::bvh::ray::RayMask;

/// A ray in the space of a tree, prepared. Its direction need not have unit length: distances are multiples of it.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Probe {
    pub(in super::super) origin: [f32; 3],
    pub(in super::super) direction: [f32; 3],
    inverse: [f32; 3],
    wide: WideOrigin,
    /// 1 / length of the direction.
    per_length: f32,
    near: f32,
    /// Hits beyond do not count.
    far: f32,
    mask: RayMask,
}

impl Probe {
    #[inline]
    pub(in super::super) fn new(
        root: &Node,
        origin: [f32; 3],
        direction: [f32; 3],
        (near, far): (f32, f32),
        mask: RayMask,
    ) -> Self {
        let length = dot(direction, direction[0], direction[1], direction[2]).sqrt();
        Self {
            origin,
            direction,
            inverse: direction.map(inverse),
            wide: WideOrigin::new(origin, margin(origin, root)),
            per_length: 1.0 / length,
            near,
            far,
            mask,
        }
    }

    /// Entry distance of a box, or infinity when the ray misses it or meets it beyond `limit`.
    #[inline(always)]
    fn entry(&self, node: &Node, limit: f32) -> f32 {
        let (min, max) = self.wide.corners(&node.min, &node.max);
        let (enter, leave) = crossing(&min, &max, self.inverse);
        let enter = most(enter, self.near);
        if enter <= least(leave, limit) { enter } else { f32::INFINITY }
    }

    /// Distance and reach of the hit with a triangle, up to `limit`.
    #[inline(always)]
    fn meet(&self, triangle: &PackedTriangle, limit: f32) -> Option<(f32, f32)> {
        let [x, y, z] = self.direction;
        let planes = EdgePlanes::new(triangle, self.origin);
        if !inside(planes.sides(x, y, z)) {
            return None;
        }
        let slope = dot(triangle.normal, x, y, z);
        let distance = planes.height(triangle.normal) / slope;
        if slope == 0.0 || !(distance >= self.near && distance <= limit) || !triangle.mask.meets(self.mask) {
            return None;
        }
        let (min, max) = triangle.corners();
        let (min, max) = self.wide.corners(&min, &max);
        let (enter, leave) = crossing(&min, &max, self.inverse);
        (enter <= distance && distance <= leave).then(|| (distance, reach(distance, slope.abs() * self.per_length)))
    }
}

/// Offers every hit that may matter to `nearest`. `owner`: source and id of an instance; nothing for static geometry.
#[inline]
pub(in super::super) fn closest(tree: &TriangleBvh, probe: &Probe, owner: Option<(u32, i32)>, nearest: &mut Nearest) {
    let offer = |node: &Node, nearest: &mut Nearest| {
        let first = node.first as usize;
        for (k, triangle) in tree.triangles[first..first + node.count()].iter().enumerate() {
            if let Some((distance, reach)) = probe.meet(triangle, least(nearest.limit, probe.far)) {
                let (source, id) = owner.unwrap_or((0, triangle.id));
                let slot = (first + k) as u32;
                nearest.offer(Candidate { distance, reach, id, source, triangle: triangle.index, slot });
            }
        }
    };
    if probe.entry(&tree.root, least(nearest.limit, probe.far)) == f32::INFINITY {
        return;
    }
    if tree.root.count() > 0 {
        return offer(&tree.root, nearest);
    }
    // Entry distance, pair.
    let mut stack = [(0.0_f32, 0_u32); STACK];
    let mut top = 0;
    let mut pair = tree.root.first as usize;
    loop {
        let nodes = &tree.pairs[pair].0;
        let end = least(nearest.limit, probe.far);
        let entries = [probe.entry(&nodes[0], end), probe.entry(&nodes[1], end)];
        let closer = usize::from(entries[1] < entries[0]);
        let mut next = None;
        for k in [closer, 1 - closer] {
            if entries[k] > least(nearest.limit, probe.far) || entries[k] == f32::INFINITY {
                continue;
            }
            if nodes[k].count() > 0 {
                offer(&nodes[k], nearest);
            } else if next.is_none() {
                next = Some(nodes[k].first);
            } else {
                stack[top] = (entries[k], nodes[k].first);
                top += 1;
            }
        }
        if let Some(first) = next {
            pair = first as usize;
            continue;
        }
        loop {
            if top == 0 {
                return;
            }
            top -= 1;
            if stack[top].0 <= least(nearest.limit, probe.far) {
                pair = stack[top].1 as usize;
                break;
            }
        }
    }
}

/// Whether anything lies in the ray's range.
#[inline]
pub(in super::super) fn occluded(tree: &TriangleBvh, probe: &Probe) -> bool {
    let mut stack = [0_u32; STACK];
    let mut top = 0;
    if probe.entry(&tree.root, probe.far) == f32::INFINITY {
        return false;
    }
    let meets = |node: &Node| {
        let first = node.first as usize;
        tree.triangles[first..first + node.count()].iter().any(|t| probe.meet(t, probe.far).is_some())
    };
    if tree.root.count() > 0 {
        return meets(&tree.root);
    }
    let mut pair = tree.root.first as usize;
    loop {
        let mut next = None;
        for node in &tree.pairs[pair].0 {
            if probe.entry(node, probe.far) == f32::INFINITY {
                continue;
            }
            if node.count() > 0 {
                if meets(node) {
                    return true;
                }
            } else if next.is_none() {
                next = Some(node.first);
            } else {
                stack[top] = node.first;
                top += 1;
            }
        }
        if let Some(first) = next {
            pair = first as usize;
        } else if top > 0 {
            top -= 1;
            pair = stack[top] as usize;
        } else {
            return false;
        }
    }
}
