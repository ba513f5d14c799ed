//! Balanced trees by halving: for the few boxes of moving things, and for input that clusters badly.

use super::build::Tree;
use super::node::{Node, NodePair};
use crate::bounds::Aabb;

/// Boxes in a leaf of [`median_tree`].
const LEAF: usize = 2;

/// A tree whose depth is the binary logarithm of the number of boxes.
pub(super) fn median_tree(boxes: &[Aabb]) -> Tree {
    let mut tree = Tree::default();
    rebuild(boxes, &mut tree);
    tree
}

/// As [`median_tree`], in the memory of an earlier tree.
pub(super) fn rebuild(boxes: &[Aabb], tree: &mut Tree) {
    tree.pairs.clear();
    tree.order.clear();
    tree.order.extend(0..boxes.len() as u32);
    tree.root = if boxes.is_empty() { Node::NOTHING } else { subtree(boxes, tree, 0, boxes.len()) };
}

/// The node over `order[start..end]`, and all below it.
fn subtree(boxes: &[Aabb], tree: &mut Tree, start: usize, end: usize) -> Node {
    let order = &mut tree.order[start..end];
    let (mut all, mut centers) = (Aabb::EMPTY, Aabb::EMPTY);
    for &k in order.iter() {
        all = all.union(&boxes[k as usize]);
        centers.add_point(boxes[k as usize].center());
    }
    let (min, max) = (all.min.to_array(), all.max.to_array());
    if order.len() <= LEAF {
        return Node::leaf(min, max, start as u32, order.len() as u32);
    }
    let size = centers.size();
    let axis = if size.x >= size.y && size.x >= size.z { 0 } else { 1 + usize::from(size.z > size.y) };
    let middle = order.len() / 2;
    let key = |k: u32| boxes[k as usize].min[axis] + boxes[k as usize].max[axis];
    order.select_nth_unstable_by(middle, |&a, &b| key(a).total_cmp(&key(b)).then(a.cmp(&b)));
    let pair = tree.pairs.len();
    tree.pairs.push(NodePair([Node::NOTHING; 2]));
    let lower = subtree(boxes, tree, start, start + middle);
    let upper = subtree(boxes, tree, start + middle, end);
    tree.pairs[pair] = NodePair([lower, upper]);
    Node::inner(min, max, pair as u32, axis as u32)
}
