//! Rays with one origin, prepared for a tree: boxes and planes are moved to the origin once for all rays.

use glam::Vec4;

use super::super::node::Node;
use super::array3;
use super::slab::{
    LARGEST_INVERSE, PaddedOrigin, box_margin, max_f32, min_f32, safe_inverse, slab_range,
};
use super::triangle::{OriginTriangles, clamped_hit_distance, dot, is_inside};
use crate::bounds::Aabb;

/// Rays with one origin in the space of a tree, prepared; lanes side by side.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(in super::super) struct PreparedPacket<const N: usize> {
    pub(in super::super) direction: [[f32; N]; 3],
    inverse: [[f32; N]; 3],
    pub(in super::super) near: [f32; N],
    /// Hits beyond do not matter; minus infinity for an inactive lane.
    pub(in super::super) limit: [f32; N],
    pub(in super::super) origin: [f32; 3],
    pub(super) padded_origin: PaddedOrigin,
    margin: f32,
    /// See [`EdgePlanes::new`].
    pub(super) max_direction_component: f32,
    /// Bounds of the range over all active rays.
    nearest: f32,
    pub(in super::super) max_limit: f32,
    /// Bounds of the direction. Shape (axis,).
    pub(super) min_direction: [f32; 3],
    pub(super) max_direction: [f32; 3],
    /// Bounds of the inverse direction; infinite where it has both signs.
    slow: [f32; 3],
    fast: [f32; 3],
    /// Infinite where the inverse direction has both signs, else zero.
    leave_at_least: [f32; 3],
    /// The plane of a box that the rays meet first along an axis, and the one they meet last.
    first: [usize; 3],
    last: [usize; 3],
    mixed: bool,
}

impl<const N: usize> PreparedPacket<N> {
    /// A lane is inactive where its range is empty.
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
                inverses[axis][k] = safe_inverse(value);
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
        let margin = box_margin(origin, all);
        let mixed = array3(|axis| lowest[axis] <= 0.0 && highest[axis] >= 0.0);
        let up = array3(|axis| lowest[axis] > 0.0);
        Self {
            direction: *direction,
            inverse: inverses,
            near: start,
            limit,
            origin,
            padded_origin: PaddedOrigin::new(origin, margin),
            margin,
            max_direction_component: longest,
            nearest: lowest_of(start),
            max_limit: highest_of(limit),
            min_direction: lowest,
            max_direction: highest,
            slow: array3(|axis| {
                if mixed[axis] {
                    -LARGEST_INVERSE
                } else {
                    safe_inverse(highest[axis])
                }
            }),
            fast: array3(|axis| {
                if mixed[axis] {
                    LARGEST_INVERSE
                } else {
                    safe_inverse(lowest[axis])
                }
            }),
            leave_at_least: array3(|axis| {
                if mixed[axis] {
                    f32::INFINITY
                } else {
                    f32::NEG_INFINITY
                }
            }),
            first: array3(|axis| if up[axis] { axis } else { axis + 3 }),
            last: array3(|axis| if up[axis] { axis + 3 } else { axis }),
            mixed: mixed != [false; 3],
        }
    }

    /// Prepares for another tree in the same space.
    #[inline(always)]
    pub(in super::super) fn prepare_for_tree(&mut self, all: &Aabb) {
        self.margin = box_margin(self.origin, all);
        self.padded_origin = PaddedOrigin::new(self.origin, self.margin);
    }

    /// Returns whether no ray is active.
    #[inline(always)]
    pub(in super::super) fn is_done(&self) -> bool {
        self.max_limit == f32::NEG_INFINITY
    }

    /// Updates the bounds after a change of `limit`.
    #[inline(always)]
    pub(in super::super) fn update_limit_bounds(&mut self) {
        self.max_limit = highest_of(self.limit);
    }

    /// Returns the interval of each ray inside a box, within its own range.
    #[inline(always)]
    pub(in super::super) fn range_in_box(&self, bounds: &Aabb) -> ([f32; N], [f32; N]) {
        let (min, max) = self
            .padded_origin
            .corners(bounds.min.as_ref(), bounds.max.as_ref());
        let [ix, iy, iz] = &self.inverse;
        let (mut start, mut end) = ([0.0; N], [0.0; N]);
        for k in 0..N {
            let (enter, leave) = slab_range(&min, &max, [ix[k], iy[k], iz[k]]);
            start[k] = max_f32(enter, self.near[k]);
            end[k] = min_f32(leave, self.limit[k]);
        }
        (start, end)
    }

    /// Returns the children whose boxes some ray enters before its limit, as bits, and a lower bound of the entry.
    #[inline(always)]
    pub(super) fn intersect_children(&self, node: &Node) -> (u32, Vec4) {
        // All rays at once by the bounds of their directions; this loses nothing, as rounding is monotone.
        let mut enter = Vec4::splat(self.nearest);
        let mut leave = Vec4::splat(self.max_limit);
        let mut planes = [[0.0; 4]; 6];
        for axis in 0..3 {
            let (first, last) = (self.first[axis], self.last[axis]);
            let first = node.planes[first] - Vec4::splat(self.padded_origin.0[first]);
            let last = node.planes[last] - Vec4::splat(self.padded_origin.0[last]);
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
            if !self.any_enters(&array3(|p| planes[p][k]), &array3(|p| planes[p + 3][k])) {
                bits &= !(1 << k);
            }
        }
        (bits, enter)
    }

    /// Returns whether some ray enters a box before its limit. `first`, `last`: its planes as seen from the origin, in the
    /// order in which the rays meet them.
    #[inline(always)]
    fn any_enters(&self, first: &[f32; 3], last: &[f32; 3]) -> bool {
        let [ix, iy, iz] = &self.inverse;
        let mut any = 0_u32;
        if self.mixed {
            for k in 0..N {
                let (enter, leave) = slab_range(first, last, [ix[k], iy[k], iz[k]]);
                any |= u32::from(max_f32(enter, self.nearest) <= min_f32(leave, self.limit[k]));
            }
        } else {
            for k in 0..N {
                let enter = max_f32(
                    max_f32(
                        max_f32(first[0] * ix[k], first[1] * iy[k]),
                        first[2] * iz[k],
                    ),
                    self.nearest,
                );
                let leave = min_f32(
                    min_f32(min_f32(last[0] * ix[k], last[1] * iy[k]), last[2] * iz[k]),
                    self.limit[k],
                );
                any |= u32::from(enter <= leave);
            }
        }
        any != 0
    }

    /// Returns the distances at which the rays hit one of four triangles, NaN for those that do not within their range; `None` for no hit.
    #[inline(always)]
    pub(super) fn intersect_triangle(
        &self,
        facets: &OriginTriangles,
        lane: usize,
    ) -> Option<[f32; N]> {
        if self.mixed {
            self.intersect_ordered(facets, lane, |first, last, inverse| {
                slab_range(first, last, inverse)
            })
        } else {
            self.intersect_ordered(facets, lane, |first, last, inverse| {
                (
                    max_f32(
                        max_f32(first[0] * inverse[0], first[1] * inverse[1]),
                        first[2] * inverse[2],
                    ),
                    min_f32(
                        min_f32(last[0] * inverse[0], last[1] * inverse[1]),
                        last[2] * inverse[2],
                    ),
                )
            })
        }
    }

    /// Returns the distances at which a ray enters and leaves a box, from the planes it meets first, those it meets last,
    /// and its inverse direction.
    #[inline(always)]
    fn intersect_ordered(
        &self,
        facets: &OriginTriangles,
        lane: usize,
        cross: impl Fn(&[f32; 3], &[f32; 3], [f32; 3]) -> (f32, f32),
    ) -> Option<[f32; N]> {
        let [u, v, w] = array3(|edge| array3(|axis| facets.edges[edge][axis][lane]));
        let tolerances = array3(|edge| facets.tolerances[edge][lane]);
        let normal = array3(|axis| facets.normal[axis][lane]);
        let height = facets.height[lane];
        let first = array3(|axis| facets.bounds[self.first[axis]][lane]);
        let last = array3(|axis| facets.bounds[self.last[axis]][lane]);
        let ([x, y, z], [ix, iy, iz]) = (&self.direction, &self.inverse);
        let mut distances = [0.0; N];
        let mut any = 0_u32;
        for k in 0..N {
            let (x, y, z) = (x[k], y[k], z[k]);
            let sides = [dot(u, x, y, z), dot(v, x, y, z), dot(w, x, y, z)];
            let slope = dot(normal, x, y, z);
            let range = cross(&first, &last, [ix[k], iy[k], iz[k]]);
            let distance = clamped_hit_distance(height / slope, slope, range, self.margin);
            let in_range = (distance >= self.near[k]) & (distance <= self.limit[k]);
            let counts = is_inside(sides, tolerances) & in_range;
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
            values[k] = min_f32(values[k], values[k + half]);
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
            values[k] = max_f32(values[k], values[k + half]);
        }
        half /= 2;
    }
    values[0]
}
