//! Traversal of the trees by rays. One ray: `tree_ray` and `scene_ray`; many from one point: `tree_packet` and
//! `scene_packet`, by `dispatch`. Both are compiled for several instruction levels. All compute the same distances bit for
//! bit and judge them by the one rule of `closest_hit`; boxes are only ever skipped when nothing in them could count.

pub(super) mod closest_hit;
pub(super) mod dispatch;
mod prepared_packet;
mod scene_packet;
pub(super) mod scene_ray;
pub(super) mod slab;
pub(super) mod tree_packet;
pub(super) mod tree_ray;
pub(super) mod triangle;

use glam::Vec4;

use super::node::{Node, NodeLink, STACK, TriangleInfo};
use super::ray::RayMask;

/// The three results of `f`. Array methods with closures compile into calls; this does not.
#[inline(always)]
fn array3<T>(f: impl Fn(usize) -> T) -> [T; 3] {
    [f(0), f(1), f(2)]
}

/// The surfaces that a query can hit.
#[derive(Clone, Copy, Debug)]
pub(super) struct HitFilter {
    mask: RayMask,
    /// An id to ignore; beyond all ids when nothing is hidden.
    hidden: i64,
}

impl HitFilter {
    pub(super) fn new(mask: RayMask, hidden: Option<i32>) -> Self {
        Self {
            mask,
            hidden: hidden.map_or(i64::MAX, i64::from),
        }
    }

    /// The filter for the triangles of an instance that passed: they have no ids of their own.
    #[inline(always)]
    pub(super) fn for_instance_triangles(&self) -> Self {
        Self {
            hidden: i64::MAX,
            ..*self
        }
    }

    #[inline(always)]
    pub(super) fn accepts(&self, id: i32, mask: RayMask) -> bool {
        self.mask.intersects(mask) && i64::from(id) != self.hidden
    }

    #[inline(always)]
    fn admits_surface(&self, surface: &TriangleInfo) -> bool {
        self.accepts(surface.id, surface.mask)
    }
}

/// Returns the nearest of a node's children in `hits`, and pushes the others on the stack, further ones deeper.
#[inline(always)]
fn push_further(
    node: &Node,
    mut hits: u32,
    enter: Vec4,
    stack: &mut [(f32, NodeLink); STACK],
    top: &mut usize,
) -> NodeLink {
    let enter = enter.to_array();
    let first = hits.trailing_zeros() as usize;
    hits &= hits - 1;
    let mut closest = (enter[first], node.links[first]);
    let bottom = *top;
    while hits != 0 {
        let k = hits.trailing_zeros() as usize;
        hits &= hits - 1;
        let mut entry = (enter[k], node.links[k]);
        if entry.0 < closest.0 {
            std::mem::swap(&mut entry, &mut closest);
        }
        let mut place = *top;
        while place > bottom && stack[place - 1].0 < entry.0 {
            stack[place] = stack[place - 1];
            place -= 1;
        }
        stack[place] = entry;
        *top += 1;
    }
    closest.1
}
