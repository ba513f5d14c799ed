//! The tree in memory: 32-byte nodes in pairs, one cache line a pair.

/// An inner node or a leaf; 32 bytes.
#[repr(C, align(32))]
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    /// Lower corner, m.
    pub(super) min: [f32; 3],
    /// Inner node: index of the pair of its children. Leaf: its first triangle.
    pub(super) first: u32,
    /// Upper corner, m.
    pub(super) max: [f32; 3],
    /// Bits 0 to 7: triangles of a leaf, 0 for an inner node. Bits 8 and 9 of an inner node: the axis that separates its
    /// children; the one with the smaller coordinates comes first.
    pub(super) meta: u32,
}

impl Default for Node {
    fn default() -> Self {
        Self::NOTHING
    }
}

impl Node {
    /// Most triangles in a leaf.
    pub(super) const MAX_LEAF: u32 = 255;

    /// A box that no ray enters.
    pub(super) const NOTHING: Self = Self { min: [f32::MAX; 3], first: 0, max: [f32::MIN; 3], meta: 0 };

    pub(super) fn inner(min: [f32; 3], max: [f32; 3], children: u32, axis: u32) -> Self {
        Self { min, first: children, max, meta: axis << 8 }
    }

    pub(super) fn leaf(min: [f32; 3], max: [f32; 3], first: u32, count: u32) -> Self {
        Self { min, first, max, meta: count }
    }

    /// Triangles of a leaf; 0 for an inner node.
    #[inline(always)]
    pub(super) fn count(&self) -> usize {
        (self.meta & 255) as usize
    }

    /// The axis that separates the children of an inner node.
    #[inline(always)]
    pub(super) fn axis(&self) -> usize {
        (self.meta >> 8) as usize
    }
}

/// Two siblings; 64 bytes.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug)]
pub(super) struct NodePair(pub(super) [Node; 2]);

/// Entries of a traversal stack; builders never exceed the depth that needs it.
pub(super) const STACK: usize = 64;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pair_fills_one_cache_line() {
        assert_eq!(size_of::<Node>(), 32);
        assert_eq!(size_of::<NodePair>(), 64);
        assert_eq!(align_of::<NodePair>(), 64);
    }
}
