//! Rays against boxes: conservative, and free of NaN.
//!
//! Boxes are widened by a margin that grows with the distance between ray and tree and exceeds the rounding of the
//! triangle test. All kernels compute the same entry and exit, bit for bit, and rounding is monotone: a ray that enters a
//! box enters every box around it. A triangle's hit counts only inside the triangle's own box, so no order of
//! traversal, no kernel and no tree can lose it.

use glam::Vec4;

use super::super::node::Node;
use crate::bounds::Aabb;

/// Largest magnitude of an inverse direction: a difference of coordinates times this stays finite.
pub(in super::super) const LARGEST_INVERSE: f32 = 1e24;

/// The margin of boxes seen from `origin`, m: 2^-20 of the distance to the far corner of the whole tree.
#[inline]
pub(in super::super) fn box_margin(origin: [f32; 3], bounds: &Aabb) -> f32 {
    let mut reach = 0.0_f32;
    for k in 0..3 {
        reach = reach
            .max((origin[k] - bounds.min[k]).abs())
            .max((origin[k] - bounds.max[k]).abs());
    }
    (reach * (1.0 / 1_048_576.0)).clamp(1e-9, 1e18)
}

/// The inverse of a component of a direction, limited, never zero or NaN for finite input.
#[inline(always)]
pub(in super::super) fn safe_inverse(component: f32) -> f32 {
    let inverse = 1.0 / component;
    let inverse = if inverse < LARGEST_INVERSE {
        inverse
    } else {
        LARGEST_INVERSE
    };
    if inverse > -LARGEST_INVERSE {
        inverse
    } else {
        -LARGEST_INVERSE
    }
}

/// The value that a ray, or a packet with one origin, subtracts from every box: its origin moved outwards by the margin,
/// for lower corners and for upper corners.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct PaddedOrigin(pub(super) [f32; 6]);

impl PaddedOrigin {
    #[inline(always)]
    pub(in super::super) fn new(origin: [f32; 3], margin: f32) -> Self {
        let [x, y, z] = origin;
        Self([
            x + margin,
            y + margin,
            z + margin,
            x - margin,
            y - margin,
            z - margin,
        ])
    }

    /// The corners of a box as seen from the origin.
    #[inline(always)]
    pub(in super::super) fn corners(&self, min: &[f32; 3], max: &[f32; 3]) -> ([f32; 3], [f32; 3]) {
        let o = &self.0;
        (
            [min[0] - o[0], min[1] - o[1], min[2] - o[2]],
            [max[0] - o[3], max[1] - o[4], max[2] - o[5]],
        )
    }
}

#[inline(always)]
pub(in super::super) fn min_f32(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[inline(always)]
pub(in super::super) fn max_f32(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// Distances at which a ray enters and leaves a box given by its corners as seen from the origin; it misses the box when
/// it leaves before it enters.
#[inline(always)]
pub(in super::super) fn slab_range(
    min: &[f32; 3],
    max: &[f32; 3],
    inverse: [f32; 3],
) -> (f32, f32) {
    let (x0, x1) = (min[0] * inverse[0], max[0] * inverse[0]);
    let (y0, y1) = (min[1] * inverse[1], max[1] * inverse[1]);
    let (z0, z1) = (min[2] * inverse[2], max[2] * inverse[2]);
    let enter = max_f32(max_f32(min_f32(x0, x1), min_f32(y0, y1)), min_f32(z0, z1));
    let leave = min_f32(min_f32(max_f32(x0, x1), max_f32(y0, y1)), max_f32(z0, z1));
    (enter, leave)
}

/// As [`slab_range`] for the children of a node and a ray with `wide` origin.
#[inline(always)]
pub(in super::super) fn slab_range4(
    node: &Node,
    wide: &PaddedOrigin,
    inverse: &[Vec4; 3],
) -> (Vec4, Vec4) {
    let at = |plane: usize, axis: usize| {
        (node.planes[plane] - Vec4::splat(wide.0[plane])) * inverse[axis]
    };
    let (x0, x1) = (at(0, 0), at(3, 0));
    let (y0, y1) = (at(1, 1), at(4, 1));
    let (z0, z1) = (at(2, 2), at(5, 2));
    let enter = x0.min(x1).max(y0.min(y1)).max(z0.min(z1));
    let leave = x0.max(x1).min(y0.max(y1)).min(z0.max(z1));
    (enter, leave)
}
