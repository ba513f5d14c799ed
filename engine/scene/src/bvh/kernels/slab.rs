//! Rays against boxes: conservative, and free of NaN.
//!
//! Boxes are widened by a margin that grows with the distance between ray and tree and exceeds the rounding of the
//! triangle test. All kernels compute the same entry and exit, bit for bit, and rounding is monotone: a ray that enters a
//! box enters every box around it. A triangle's hit counts only inside the triangle's own box, so no order of
//! traversal, no kernel and no tree can lose it.

use super::super::node::Node;

/// Largest magnitude of an inverse direction: a difference of coordinates times this stays finite.
const LARGEST_INVERSE: f32 = 1e24;

/// The margin of boxes seen from `origin`, m: 2^-20 of the distance to the far corner of the whole tree.
#[inline]
pub(in super::super) fn margin(origin: [f32; 3], root: &Node) -> f32 {
    let mut reach = 0.0_f32;
    for k in 0..3 {
        reach = reach.max((origin[k] - root.min[k]).abs()).max((origin[k] - root.max[k]).abs());
    }
    (reach * (1.0 / 1_048_576.0)).clamp(1e-9, 1e18)
}

/// The inverse of a component of a direction, limited, never zero or NaN for finite input.
#[inline(always)]
pub(in super::super) fn inverse(component: f32) -> f32 {
    let inverse = 1.0 / component;
    if inverse > LARGEST_INVERSE {
        LARGEST_INVERSE
    } else if inverse < -LARGEST_INVERSE {
        -LARGEST_INVERSE
    } else {
        inverse
    }
}

/// What a ray, or a packet with one origin, asks of every box: its origin moved outwards by the margin.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct WideOrigin {
    /// Subtracted from lower corners.
    pub(in super::super) low: [f32; 3],
    /// Subtracted from upper corners.
    pub(in super::super) high: [f32; 3],
}

impl WideOrigin {
    #[inline(always)]
    pub(in super::super) fn new(origin: [f32; 3], margin: f32) -> Self {
        Self { low: origin.map(|o| o + margin), high: origin.map(|o| o - margin) }
    }

    /// The corners of a box as seen from the origin.
    #[inline(always)]
    pub(in super::super) fn corners(&self, min: &[f32; 3], max: &[f32; 3]) -> ([f32; 3], [f32; 3]) {
        (
            [min[0] - self.low[0], min[1] - self.low[1], min[2] - self.low[2]],
            [max[0] - self.high[0], max[1] - self.high[1], max[2] - self.high[2]],
        )
    }
}

#[inline(always)]
pub(in super::super) fn least(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[inline(always)]
pub(in super::super) fn most(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// Distances at which a ray enters and leaves a box given by its corners as seen from the origin; it misses the box when
/// it leaves before it enters.
#[inline(always)]
pub(in super::super) fn crossing(min: &[f32; 3], max: &[f32; 3], inverse: [f32; 3]) -> (f32, f32) {
    let (x0, x1) = (min[0] * inverse[0], max[0] * inverse[0]);
    let (y0, y1) = (min[1] * inverse[1], max[1] * inverse[1]);
    let (z0, z1) = (min[2] * inverse[2], max[2] * inverse[2]);
    let enter = most(most(least(x0, x1), least(y0, y1)), least(z0, z1));
    let leave = least(least(most(x0, x1), most(y0, y1)), most(z0, z1));
    (enter, leave)
}
