//! Conversion of binary trees to trees with four children a node.

use super::binary::BinaryBvh;
use super::node::{MAX_DEPTH, Node, NodeLink, WIDTH};
use crate::bounds::Aabb;

/// A tree in the kernels' layout.
#[derive(Clone, Debug)]
pub(super) struct WideBvh {
    pub(super) nodes: Vec<Node>,
    pub(super) root: NodeLink,
    pub(super) bounds: Aabb,
}

impl Default for WideBvh {
    fn default() -> Self {
        Self {
            nodes: Vec::new(),
            root: NodeLink::NONE,
            bounds: Aabb::EMPTY,
        }
    }
}

impl WideBvh {
    /// Replaces the tree, reusing its memory. `leaf` turns the boxes of a leaf, as a range of the binary tree's order, into
    /// a link. Returns whether the tree is flat enough for the kernels; one that is not is incomplete.
    pub(super) fn fill(
        &mut self,
        tree: &BinaryBvh,
        leaf: &mut impl FnMut(std::ops::Range<usize>) -> NodeLink,
    ) -> bool {
        self.nodes.clear();
        self.bounds = tree.nodes.first().map_or(Aabb::EMPTY, |top| top.bounds);
        let top = if tree.nodes.is_empty() {
            Some(NodeLink::NONE)
        } else {
            self.collapse_subtree(tree, 0, 0, leaf)
        };
        self.root = top.unwrap_or(NodeLink::NONE);
        top.is_some()
    }

    /// Returns the link to node `k` of the binary tree, or `None` when it leads too deep.
    fn collapse_subtree(
        &mut self,
        tree: &BinaryBvh,
        k: usize,
        depth: usize,
        leaf: &mut impl FnMut(std::ops::Range<usize>) -> NodeLink,
    ) -> Option<NodeLink> {
        let node = &tree.nodes[k];
        let first = node.first as usize;
        if node.count > 0 {
            return Some(leaf(first..first + node.count as usize));
        }
        if depth == MAX_DEPTH {
            return None;
        }
        // The children of the largest child take its place until there are four.
        let mut children = [first, first + 1, 0, 0];
        let mut count = 2;
        while count < WIDTH {
            let area = |k: usize| tree.nodes[children[k]].bounds.half_area();
            let inner = (0..count).filter(|k| tree.nodes[children[*k]].count == 0);
            let Some(largest) = inner.max_by(|a, b| area(*a).total_cmp(&area(*b))) else {
                break;
            };
            let first = tree.nodes[children[largest]].first as usize;
            children[largest] = first;
            children[count] = first + 1;
            count += 1;
        }
        let index = self.nodes.len();
        self.nodes.push(Node::EMPTY);
        for (place, &k) in children[..count].iter().enumerate() {
            let link = self.collapse_subtree(tree, k, depth + 1, leaf)?;
            self.nodes[index].set(place, &tree.nodes[k].bounds, link);
        }
        Some(NodeLink::node(index))
    }
}

#[cfg(test)]
mod tests {
    use super::super::binary::BinaryNode;
    use super::*;
    use glam::Vec3;

    /// Each node has a leaf and the next node.
    fn chain(length: usize) -> BinaryBvh {
        let bounds = Aabb::new(Vec3::ZERO, Vec3::ONE);
        let mut nodes = vec![BinaryNode {
            bounds,
            first: 1,
            count: 0,
        }];
        for k in 1..=length {
            let last = u32::from(k == length);
            nodes.push(BinaryNode {
                bounds,
                first: 0,
                count: 1,
            });
            nodes.push(BinaryNode {
                bounds,
                first: 2 * k as u32 + 1,
                count: last,
            });
        }
        BinaryBvh {
            nodes,
            primitive_order: vec![0],
        }
    }

    #[test]
    fn only_trees_that_fit_the_stacks_are_taken() {
        let mut tree = WideBvh::default();
        // Four children take three levels of a chain.
        assert!(tree.fill(&chain(3 * MAX_DEPTH), &mut |_| NodeLink::leaf(0)));
        assert_eq!(tree.nodes.len(), MAX_DEPTH);
        assert!(!tree.fill(&chain(3 * MAX_DEPTH + 1), &mut |_| NodeLink::leaf(0)));
        assert!(tree.fill(&chain(1), &mut |_| NodeLink::leaf(0)));
        assert_eq!(tree.nodes.len(), 1);
    }
}
