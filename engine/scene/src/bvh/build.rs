//! Construction of the tree. Plain arrays go in and come out; obvhs is used here only.

use obvhs::Boundable;
use obvhs::aabb::Aabb as ObvhsBox;
use obvhs::bvh2::leaf_collapser::collapse;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

use super::binary::{BinaryBvh, BinaryNode, median_tree};
use super::node::WIDTH;
use crate::bounds::Aabb;
use glam::Vec3;

// Measured on the sample house of 102,076 triangles (one core): building takes 33 ms; search distances of 1 to 2 save 4 ms
// and cost 3 to 8 % of the rays a second; 14, or more reinsertion, gains nothing. Leaves with a traversal cost of 1 or 2
// triangles need 20 to 60 % more memory for the same speed.
const SEARCH: PlocSearchDistance = PlocSearchDistance::Low;
const SEARCH_FROM_DEPTH: usize = 2;
const REINSERTED: f32 = 0.02;
const TRAVERSAL_COST: f32 = 3.0;
/// Most steps in stretches of boxes along the Morton curve of which no two merge in the first round. Where all are alike, as
/// in a row or at one place, each round merges one pair, so that n boxes take n² steps and make a tree n deep. 16 million steps
/// take less than half a second.
const MAX_STEPS: usize = 1 << 24;
/// Length from which a stretch counts; shorter ones take few steps a box.
const LONG_STRETCH: usize = 256;

/// A tree of good quality (bottom-up clustering, reinsertion, leaves by cost); leaves hold at most [`WIDTH`] boxes.
///
/// # Source
/// Meister and Bittner, "Parallel Locally-Ordered Clustering for Bounding Volume Hierarchy Construction" (2018), and
/// "Parallel Reinsertion for Bounding Volume Hierarchy Optimization" (2018), as built by obvhs.
pub(super) fn ploc_tree(boxes: &[Aabb]) -> BinaryBvh {
    struct Primitive(ObvhsBox);
    impl Boundable for Primitive {
        fn aabb(&self) -> ObvhsBox {
            self.0
        }
    }
    if boxes.len() <= WIDTH || unmerged_steps(boxes) > MAX_STEPS {
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
    BinaryBvh {
        nodes: nodes.collect(),
        primitive_order: built.primitive_indices,
    }
}

/// Returns the sum of the squared lengths of long stretches of boxes along the Morton curve of which no two are each other's
/// nearest; 0 for few boxes.
///
/// # Source
/// Meister and Bittner, "Parallel Locally-Ordered Clustering" (2018), section 3, with a search distance of 1.
fn unmerged_steps(boxes: &[Aabb]) -> usize {
    if boxes.len() * boxes.len() <= MAX_STEPS {
        return 0;
    }
    let mut centers = Aabb::EMPTY;
    for b in boxes {
        centers.add_point(b.center());
    }
    let size = centers.size().max(Vec3::splat(f32::MIN_POSITIVE));
    let mut order: Vec<(u64, u32)> = (0_u32..)
        .zip(boxes)
        .map(|(k, b)| (morton((b.center() - centers.min) / size), k))
        .collect();
    order.sort_unstable();
    let cost = |pair: &[(u64, u32)]| {
        let [a, b] = [pair[0], pair[1]].map(|(_, k)| &boxes[k as usize]);
        a.union(b).half_area()
    };
    // A pair merges where it costs no more than the pair before, and less than the one after.
    let (mut steps, mut since, mut falls) = (0, 0, true);
    let steps_of = |since: usize| {
        if since > LONG_STRETCH {
            since * since
        } else {
            0
        }
    };
    let mut costs = order.windows(2).map(cost).peekable();
    while let Some(cost) = costs.next() {
        since += 1;
        let rises = costs.peek().is_none_or(|next| cost < *next);
        if falls && rises {
            steps += steps_of(since);
            since = 0;
        }
        falls = costs.peek().is_some_and(|next| *next <= cost);
    }
    steps + steps_of(since)
}

/// Returns the Morton code of a point of the unit cube, 21 bits an axis.
fn morton(point: Vec3) -> u64 {
    // Moves halves apart, then quarters, to single bits: two zeros between each.
    let spread = |x: f32| {
        let x = u64::from((x * 2_097_151.0) as u32);
        let x = (x | x << 32) & 0x001f_0000_0000_ffff;
        let x = (x | x << 16) & 0x001f_0000_ff00_00ff;
        let x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
        let x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
        (x | x << 2) & 0x1249_2492_4924_9249
    };
    spread(point.x) | spread(point.y) << 1 | spread(point.z) << 2
}

#[cfg(test)]
mod tests {
    use super::*;

    fn depth(tree: &BinaryBvh, k: usize) -> usize {
        let node = &tree.nodes[k];
        if node.count > 0 {
            return 0;
        }
        let first = node.first as usize;
        1 + depth(tree, first).max(depth(tree, first + 1))
    }

    /// A box of 1 m at a place.
    fn at(x: f32, z: f32) -> Aabb {
        Aabb::new(Vec3::new(x, 0.0, z), Vec3::new(x + 1.0, 1.0, z + 1.0))
    }

    /// 20,000 boxes that are alike, beside 2,000 others: the tree is about as deep as one of boxes that differ.
    fn is_balanced(alike: impl Fn(usize) -> Aabb) {
        let mut boxes: Vec<Aabb> = (0..2_000)
            .map(|k| at((k * k) as f32 * 0.37, 50.0))
            .collect();
        boxes.extend((0..20_000).map(alike));
        assert!(unmerged_steps(&boxes) > MAX_STEPS);
        let tree = ploc_tree(&boxes);
        assert!(depth(&tree, 0) <= 16, "{}", depth(&tree, 0));
        let mut order = tree.primitive_order;
        order.sort_unstable();
        assert!(order.into_iter().eq(0..boxes.len() as u32));
    }

    #[test]
    fn boxes_at_one_place_make_a_balanced_tree() {
        is_balanced(|_| at(5.0, 0.0));
    }

    /// As the frames of many doors at one place: each stretch is short, and all of them together take too long.
    #[test]
    fn boxes_at_several_places_make_a_balanced_tree() {
        is_balanced(|k| at(5.0 + (k / 1_000) as f32 * 3.0, 0.0));
    }

    #[test]
    fn boxes_in_a_row_make_a_balanced_tree() {
        is_balanced(|k| at(0.125 * k as f32, 0.0));
    }

    /// Of random boxes a third merges in each round.
    #[test]
    fn boxes_that_differ_are_clustered() {
        let mut stream = crate::random::RandomKey::root(3).stream();
        let boxes: Vec<Aabb> = (0..20_000)
            .map(|_| at(100.0 * stream.uniform_f32(), 100.0 * stream.uniform_f32()))
            .collect();
        assert_eq!(unmerged_steps(&boxes), 0);
    }
}
