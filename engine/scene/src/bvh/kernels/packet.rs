//! Many rays with one origin against one tree: boxes and planes are moved to the origin once for all rays.

use super::super::node::{Node, STACK};
use super::super::ray::RayMask;
use super::super::triangles::{PackedTriangle, TriangleBvh};
use super::nearest::{Candidate, Nearest, reach};
use super::slab::{WideOrigin, inverse, least, margin, most};
use super::triangle::{EdgePlanes, dot, inside};

/// Rays with one origin in the space of a tree, prepared; lanes side by side.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(in super::super) struct Fan<const N: usize> {
    pub(in super::super) direction: [[f32; N]; 3],
    inverse: [[f32; N]; 3],
    near: [f32; N],
    /// Hits beyond do not matter; below everything for a lane that is out of use.
    limit: [f32; N],
    /// 1 / length of the direction.
    per_length: [f32; N],
    pub(in super::super) origin: [f32; 3],
    wide: WideOrigin,
    mask: RayMask,
    /// For each axis whether most rays go up it.
    upwards: [bool; 3],
    /// Whether the rays in use all go the same way along every axis.
    parallel: bool,
}

impl<const N: usize> Fan<N> {
    /// A lane is out of use where its range is empty.
    #[inline(always)]
    pub(in super::super) fn new(
        root: &Node,
        origin: [f32; 3],
        direction: &[[f32; N]; 3],
        (near, far): (&[f32; N], &[f32; N]),
        mask: RayMask,
    ) -> Self {
        let mut inverses = [[0.0; N]; 3];
        let mut per_length = [0.0; N];
        let mut upwards = [0_u32; 3];
        let mut used = 0;
        for axis in 0..3 {
            for k in 0..N {
                inverses[axis][k] = inverse(direction[axis][k]);
                upwards[axis] += u32::from((inverses[axis][k] > 0.0) & (near[k] <= far[k]));
            }
        }
        for k in 0..N {
            let [x, y, z] = [direction[0][k], direction[1][k], direction[2][k]];
            per_length[k] = 1.0 / dot([x, y, z], x, y, z).sqrt();
            used += u32::from(near[k] <= far[k]);
        }
        Self {
            direction: *direction,
            inverse: inverses,
            near: *near,
            limit: *far,
            per_length,
            origin,
            wide: WideOrigin::new(origin, margin(origin, root)),
            mask,
            upwards: upwards.map(|count| 2 * count > used),
            parallel: upwards.iter().all(|&count| count == 0 || count == used),
        }
    }

    /// Whether any ray enters the box before its limit.
    #[inline(always)]
    fn enters<const PARALLEL: bool>(&self, node: &Node) -> bool {
        let (min, max) = self.wide.corners(&node.min, &node.max);
        let [ix, iy, iz] = &self.inverse;
        let mut any = 0_u32;
        if PARALLEL {
            let pick = |axis: usize| if self.upwards[axis] { (min[axis], max[axis]) } else { (max[axis], min[axis]) };
            let ((x0, x1), (y0, y1), (z0, z1)) = (pick(0), pick(1), pick(2));
            for k in 0..N {
                let enter = most(most(most(x0 * ix[k], y0 * iy[k]), z0 * iz[k]), self.near[k]);
                let leave = least(least(least(x1 * ix[k], y1 * iy[k]), z1 * iz[k]), self.limit[k]);
                any |= u32::from(enter <= leave);
            }
        } else {
            for k in 0..N {
                let (enter, leave) = super::slab::crossing(&min, &max, [ix[k], iy[k], iz[k]]);
                any |= u32::from(most(enter, self.near[k]) <= least(leave, self.limit[k]));
            }
        }
        any != 0
    }

    /// Lanes that hit a triangle within their range, as bits, and the distances.
    #[inline(always)]
    fn meet(&self, triangle: &PackedTriangle, distances: &mut [f32; N]) -> u64 {
        let planes = EdgePlanes::new(triangle, self.origin);
        let [x, y, z] = &self.direction;
        let mut any = 0_u32;
        let mut within = [0_u32; N];
        for k in 0..N {
            let passes = u32::from(inside(planes.sides(x[k], y[k], z[k])));
            within[k] = passes;
            any |= passes;
        }
        if any == 0 {
            return 0;
        }
        let height = planes.height(triangle.normal);
        let (min, max) = triangle.corners();
        let (min, max) = self.wide.corners(&min, &max);
        let [ix, iy, iz] = &self.inverse;
        let mut hits = 0_u64;
        let mut counts = [0_u32; N];
        for k in 0..N {
            let slope = dot(triangle.normal, x[k], y[k], z[k]);
            let distance = height / slope;
            let (enter, leave) = super::slab::crossing(&min, &max, [ix[k], iy[k], iz[k]]);
            let counts_here = (slope != 0.0)
                & (distance >= self.near[k])
                & (distance <= self.limit[k])
                & (enter <= distance)
                & (distance <= leave);
            distances[k] = distance;
            counts[k] = within[k] & u32::from(counts_here);
        }
        for k in 0..N {
            hits |= u64::from(counts[k]) << k;
        }
        hits
    }
}

/// Calls `accept` for every triangle that rays hit, with the hits as bits and their distances, nearer parts of the tree
/// first. `accept` may lower limits, and ends the search by returning `true`.
#[inline(always)]
fn traverse<const N: usize, const PARALLEL: bool>(
    tree: &TriangleBvh,
    fan: &mut Fan<N>,
    mut accept: impl FnMut(&mut Fan<N>, usize, u64, &[f32; N]) -> bool,
) {
    let mut stack = [0_u32; STACK];
    let mut top = 0;
    let mut node = &tree.root;
    let mut distances = [0.0; N];
    loop {
        if fan.enters::<PARALLEL>(node) {
            if node.count() == 0 {
                // The half that lies first on the way of most rays.
                let later = u32::from(fan.upwards[node.axis()]);
                stack[top] = node.first * 2 + later;
                top += 1;
                node = &tree.pairs[node.first as usize].0[1 - later as usize];
                continue;
            }
            let first = node.first as usize;
            for (k, triangle) in tree.triangles[first..first + node.count()].iter().enumerate() {
                let hits = fan.meet(triangle, &mut distances);
                if hits != 0 && triangle.mask.meets(fan.mask) && accept(fan, first + k, hits, &distances) {
                    return;
                }
            }
        }
        if top == 0 {
            return;
        }
        top -= 1;
        node = &tree.pairs[stack[top] as usize / 2].0[stack[top] as usize % 2];
    }
}

/// Offers every hit that may matter to the rays' `nearest`.
#[inline(always)]
pub(in super::super) fn closest<const N: usize>(
    tree: &TriangleBvh,
    fan: &mut Fan<N>,
    owner: Option<(u32, i32)>,
    nearest: &mut [Nearest; N],
) {
    let accept = |fan: &mut Fan<N>, slot: usize, mut hits: u64, distances: &[f32; N]| {
        let triangle = &tree.triangles[slot];
        let (source, id) = owner.unwrap_or((0, triangle.id));
        while hits != 0 {
            let k = hits.trailing_zeros() as usize;
            hits &= hits - 1;
            let slope = dot(triangle.normal, fan.direction[0][k], fan.direction[1][k], fan.direction[2][k]);
            let reach = reach(distances[k], slope.abs() * fan.per_length[k]);
            nearest[k].offer(Candidate {
                distance: distances[k],
                reach,
                id,
                source,
                triangle: triangle.index,
                slot: slot as u32,
            });
            fan.limit[k] = least(fan.limit[k], nearest[k].limit);
        }
        false
    };
    if fan.parallel {
        traverse::<N, true>(tree, fan, accept);
    } else {
        traverse::<N, false>(tree, fan, accept);
    }
}
