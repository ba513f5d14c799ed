//! Building the tree. Plain arrays go in and come out; obvhs is known here only.

use obvhs::Boundable;
use obvhs::aabb::Aabb as ObvhsBox;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::leaf_collapser::collapse;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

use super::median::median_tree;
use super::node::{Node, NodePair, STACK};
use crate::bounds::Aabb;

/// A tree over boxes: nodes, and the boxes in the order in which leaves refer to them.
#[derive(Debug, Default)]
pub(super) struct Tree {
    /// The whole; a box that no ray enters when there are no boxes.
    pub(super) root: Node,
    /// Siblings; an inner node names the pair of its children.
    pub(super) pairs: Vec<NodePair>,
    /// Positions in the input. Shape (boxes,).
    pub(super) order: Vec<u32>,
}

pub static mut P: (u32, usize, f32, u32, f32, f32) = (14, 3, 0.02, 8, 3.0, 0.0);

/// A tree of good quality (bottom-up clustering, reinsertion, leaves by cost).
///
/// # Source
/// Meister and Bittner, "Parallel Locally-Ordered Clustering for Bounding Volume Hierarchy Construction" (2018), and
/// "Parallel Reinsertion for Bounding Volume Hierarchy Optimization" (2018), as built by obvhs.
pub(super) fn tree(boxes: &[Aabb]) -> Tree {
    if boxes.is_empty() {
        return Tree::default();
    }
    struct Primitive(ObvhsBox);
    impl Boundable for Primitive {
        fn aabb(&self) -> ObvhsBox {
            self.0
        }
    }
    let p = unsafe { P };
    let primitives: Vec<Primitive> =
        boxes.iter().map(|b| Primitive(ObvhsBox::new(b.min.to_array().into(), b.max.to_array().into()))).collect();
    let indices = (0..boxes.len() as u32).collect();
    let mut built = PlocBuilder::with_capacity(boxes.len()).build(p.0.into(), &primitives, indices, SortPrecision::U64, p.1);
    let mut optimizer = ReinsertionOptimizer::default();
    optimizer.run(&mut built, p.2, None);
    collapse(&mut built, p.3, p.4);
    optimizer.run(&mut built, p.5, None);
    flatten(&built).unwrap_or_else(|| median_tree(boxes))
}

/// Pairs in depth-first order, or nothing when the tree is too deep for the stacks of the kernels.
fn flatten(built: &Bvh2) -> Option<Tree> {
    let mut tree = Tree {
        root: Node::NOTHING,
        pairs: Vec::with_capacity(built.nodes.len() / 2 + 1),
        order: Vec::with_capacity(built.primitive_indices.len()),
    };
    // (node, where its plain form goes: pair and slot, depth)
    let mut stack = vec![(0_usize, None::<(usize, usize)>, 1_usize)];
    while let Some((k, place, depth)) = stack.pop() {
        if depth >= STACK {
            return None;
        }
        let (min, max) = corners(built, k);
        let first = built.nodes[k].first_index as usize;
        let node = if built.nodes[k].is_leaf() {
            let (start, count) = (tree.order.len() as u32, built.nodes[k].prim_count as usize);
            tree.order.extend_from_slice(&built.primitive_indices[first..first + count]);
            Node::leaf(min, max, start, count as u32)
        } else {
            let (a, b) = (corners(built, first), corners(built, first + 1));
            let axis = separating_axis(a, b);
            let swapped = usize::from(a.0[axis] + a.1[axis] > b.0[axis] + b.1[axis]);
            let pair = tree.pairs.len();
            tree.pairs.push(NodePair([Node::NOTHING; 2]));
            stack.push((first + 1, Some((pair, 1 - swapped)), depth + 1));
            stack.push((first, Some((pair, swapped)), depth + 1));
            Node::inner(min, max, pair as u32, axis as u32)
        };
        match place {
            Some((pair, slot)) => tree.pairs[pair].0[slot] = node,
            None => tree.root = node,
        }
    }
    Some(tree)
}

fn corners(built: &Bvh2, k: usize) -> ([f32; 3], [f32; 3]) {
    let aabb = built.nodes[k].aabb();
    (aabb.min.into(), aabb.max.into())
}

/// The axis along which the middles of two boxes lie furthest apart.
fn separating_axis(a: ([f32; 3], [f32; 3]), b: ([f32; 3], [f32; 3])) -> usize {
    let gap = |k: usize| ((a.0[k] + a.1[k]) - (b.0[k] + b.1[k])).abs();
    let wider = usize::from(gap(1) > gap(0));
    if gap(2) > gap(wider) { 2 } else { wider }
}
