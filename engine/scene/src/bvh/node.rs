//! The tree in memory: nodes with four children, and triangles in blocks of four, each laid out for four-wide arithmetic.

use glam::{Vec3, Vec4};

use super::ray::RayMask;
use crate::bounds::Aabb;

/// Children of a node, and triangles of a block.
pub(super) const WIDTH: usize = 4;

/// A link to a node's child, or to the top of a tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct NodeLink(u32);

impl NodeLink {
    /// The null link.
    pub(super) const NONE: Self = Self(u32::MAX);

    const LEAF: u32 = 1 << 31;

    /// The node at a position.
    pub(super) fn node(index: usize) -> Self {
        Self(index as u32)
    }

    /// The leaf at a position: a block of triangles, or an item of another kind.
    pub(super) fn leaf(index: usize) -> Self {
        Self(index as u32 | Self::LEAF)
    }

    /// Returns it as a number: bit 31 marks leaves.
    pub(super) fn bits(self) -> u32 {
        self.0
    }

    /// Returns whether it is a leaf, and its position.
    #[inline(always)]
    pub(super) fn unpack(self) -> (bool, usize) {
        (self.0 & Self::LEAF != 0, (self.0 & !Self::LEAF) as usize)
    }
}

/// Four boxes with their links; 128 bytes.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    /// Lower corners, then upper corners, m. Shape (6, child).
    pub(super) planes: [Vec4; 6],
    pub(super) links: [NodeLink; WIDTH],
    /// Existing children, as bits.
    pub(super) present: u32,
}

impl Node {
    /// A node without children.
    pub(super) const EMPTY: Self = Self {
        planes: [Vec4::ZERO; 6],
        links: [NodeLink::NONE; WIDTH],
        present: 0,
    };

    /// Makes `link` a child.
    pub(super) fn set(&mut self, child: usize, bounds: &Aabb, link: NodeLink) {
        self.set_bounds(child, bounds);
        self.links[child] = link;
        self.present |= 1 << child;
    }

    /// Changes the box of a child.
    pub(super) fn set_bounds(&mut self, child: usize, bounds: &Aabb) {
        for axis in 0..3 {
            self.planes[axis][child] = bounds.min[axis];
            self.planes[axis + 3][child] = bounds.max[axis];
        }
    }

    /// The smallest box around the boxes of all children.
    pub(super) fn bounds(&self) -> Aabb {
        let corner = |child: usize, first: usize| {
            Vec3::new(
                self.planes[first][child],
                self.planes[first + 1][child],
                self.planes[first + 2][child],
            )
        };
        let present = (0..WIDTH).filter(|child| self.present & (1 << child) != 0);
        present.fold(Aabb::EMPTY, |all, child| {
            all.union(&Aabb {
                min: corner(child, 0),
                max: corner(child, 3),
            })
        })
    }
}

/// Up to four triangles; 192 bytes. An unused place holds NaN and is never hit.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug)]
pub(super) struct TriangleBlock {
    /// First corners, m. Shape (axis, triangle); so are the next two.
    pub(super) a: [Vec4; 3],
    pub(super) b: [Vec4; 3],
    pub(super) c: [Vec4; 3],
    /// Unit length, by the right-hand rule from the first corner over the second to the third. Shape (axis, triangle).
    pub(super) normal: [Vec4; 3],
}

impl TriangleBlock {
    pub(super) const EMPTY: Self = Self {
        a: [Vec4::NAN; 3],
        b: [Vec4::NAN; 3],
        c: [Vec4::NAN; 3],
        normal: [Vec4::NAN; 3],
    };

    /// The normal of one of the triangles.
    #[inline(always)]
    pub(super) fn normal_of(&self, lane: usize) -> [f32; 3] {
        [
            self.normal[0][lane],
            self.normal[1][lane],
            self.normal[2][lane],
        ]
    }
}

/// The identity of a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct TriangleInfo {
    pub(super) id: i32,
    /// Position in the input.
    pub(super) index: u32,
    pub(super) mask: RayMask,
}

impl TriangleInfo {
    pub(super) const NONE: Self = Self {
        id: 0,
        index: u32::MAX,
        mask: RayMask::NONE,
    };
}

/// Most nodes on a path from the root of a tree to a leaf; builders keep to it.
pub(super) const MAX_DEPTH: usize = 32;

/// Entries of a traversal stack: at each level all children but the one that is followed.
pub(super) const STACK: usize = MAX_DEPTH * (WIDTH - 1);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_node_fills_two_cache_lines_and_a_block_three() {
        assert_eq!(size_of::<Node>(), 128);
        assert_eq!(align_of::<Node>(), 64);
        assert_eq!(size_of::<TriangleBlock>(), 192);
    }
}
