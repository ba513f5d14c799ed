//! Building the tree. Plain arrays go in and come out; obvhs is known here only.

use obvhs::Boundable;
use obvhs::aabb::Aabb as ObvhsBox;
use obvhs::bvh2::leaf_collapser::collapse;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

use super::binary::{BinaryNode, BinaryTree, median_tree};
use super::node::WIDTH;
use crate::bounds::Aabb;

// Measured on the sample house of 102,076 triangles (one core): building takes 33 ms; search distances of 1 to 2 save 4 ms
// and cost 3 to 8 % of the rays a second; 14, or more reinsertion, gains nothing. Leaves by a traversal cost of 1 or 2 triangles
// need 20 to 60 % more memory for the same speed.
const SEARCH: PlocSearchDistance = PlocSearchDistance::Low;
const SEARCH_FROM_DEPTH: usize = 2;
const REINSERTED: f32 = 0.02;
const TRAVERSAL_COST: f32 = 3.0;

/// A tree of good quality (bottom-up clustering, reinsertion, leaves by cost); leaves hold at most [`WIDTH`] boxes.
///
/// # Source
/// Meister and Bittner, "Parallel Locally-Ordered Clustering for Bounding Volume Hierarchy Construction" (2018), and
/// "Parallel Reinsertion for Bounding Volume Hierarchy Optimization" (2018), as built by obvhs.
pub(super) fn tree(boxes: &[Aabb]) -> BinaryTree {
    struct Primitive(ObvhsBox);
    impl Boundable for Primitive {
        fn aabb(&self) -> ObvhsBox {
            self.0
        }
    }
    if boxes.len() <= WIDTH {
        return median_tree(boxes);
    }
    let primitives: Vec<Primitive> = boxes
        .iter()
        .map(|b| {
            Primitive(ObvhsBox::new(
                b.min.to_array().into(),
                b.max.to_array().into(),
            ))
        })
        .collect();
    let indices = (0..boxes.len() as u32).collect();
    let mut builder = PlocBuilder::with_capacity(boxes.len());
    let mut built = builder.build(
        SEARCH,
        &primitives,
        indices,
        SortPrecision::U64,
        SEARCH_FROM_DEPTH,
    );
    ReinsertionOptimizer::default().run(&mut built, REINSERTED, None);
    collapse(&mut built, WIDTH as u32, TRAVERSAL_COST);
    let nodes = built.nodes.iter().map(|node| {
        let (min, max): ([f32; 3], [f32; 3]) = (node.aabb().min.into(), node.aabb().max.into());
        BinaryNode {
            bounds: Aabb {
                min: min.into(),
                max: max.into(),
            },
            first: node.first_index,
            count: node.prim_count,
        }
    });
    BinaryTree {
        nodes: nodes.collect(),
        order: built.primitive_indices,
    }
}
