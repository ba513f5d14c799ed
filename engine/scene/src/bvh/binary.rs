//! Binary trees, as builders make them.

use super::node::WIDTH;
use crate::bounds::Aabb;

/// A node of a [`BinaryBvh`].
#[derive(Clone, Copy, Debug)]
pub(super) struct BinaryNode {
    pub(super) bounds: Aabb,
    /// Inner node: its first child; the second follows. Leaf: its first entry in the order.
    pub(super) first: u32,
    /// Boxes in a leaf; 0 for an inner node.
    pub(super) count: u32,
}

/// Node 0 is the root; no nodes when there are no boxes.
#[derive(Clone, Debug, Default)]
pub(super) struct BinaryBvh {
    pub(super) nodes: Vec<BinaryNode>,
    /// Positions in the input, referred to by leaves. Shape (boxes,).
    pub(super) primitive_order: Vec<u32>,
}

/// A balanced tree by halving at the median; its depth is the binary logarithm of the number of boxes. For the few boxes
/// of moving things, and for input that clusters badly.
pub(super) fn median_tree(boxes: &[Aabb]) -> BinaryBvh {
    let mut tree = BinaryBvh::default();
    rebuild_median_tree(boxes, WIDTH, &mut tree);
    tree
}

/// As [`median_tree`] with at most `leaf` boxes in a leaf, reusing an earlier tree's memory.
pub(super) fn rebuild_median_tree(boxes: &[Aabb], leaf: usize, tree: &mut BinaryBvh) {
    tree.nodes.clear();
    tree.primitive_order.clear();
    tree.primitive_order.extend(0..boxes.len() as u32);
    if !boxes.is_empty() {
        tree.nodes.push(BinaryNode {
            bounds: Aabb::EMPTY,
            first: 0,
            count: 0,
        });
        fill(boxes, leaf, tree, 0, (0, boxes.len()));
    }
}

/// Builds node `k` over `order[start..end]`, and all below it.
fn fill(boxes: &[Aabb], leaf: usize, tree: &mut BinaryBvh, k: usize, (start, end): (usize, usize)) {
    let order = &mut tree.primitive_order[start..end];
    let (mut all, mut centers) = (Aabb::EMPTY, Aabb::EMPTY);
    for &k in order.iter() {
        all = all.union(&boxes[k as usize]);
        centers.add_point(boxes[k as usize].center());
    }
    let node = BinaryNode {
        bounds: all,
        first: start as u32,
        count: order.len() as u32,
    };
    if order.len() <= leaf {
        tree.nodes[k] = node;
        return;
    }
    let size = centers.size();
    let axis = size.max_position();
    let middle = order.len() / 2;
    let key = |k: u32| boxes[k as usize].min[axis] + boxes[k as usize].max[axis];
    order.select_nth_unstable_by(middle, |&a, &b| key(a).total_cmp(&key(b)).then(a.cmp(&b)));
    let children = tree.nodes.len();
    tree.nodes[k] = BinaryNode {
        first: children as u32,
        count: 0,
        ..node
    };
    tree.nodes.extend([node; 2]);
    fill(boxes, leaf, tree, children, (start, start + middle));
    fill(boxes, leaf, tree, children + 1, (start + middle, end));
}
