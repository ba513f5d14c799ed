//! Search for boxes near a place.

use super::binary::{BinaryBvh, rebuild_median_tree};
use crate::bounds::Aabb;
use glam::Vec3;

/// Boxes in a leaf.
const LEAF: usize = 4;
/// Most calls of `counts` for each box to be found.
const TESTS_PER_BOX: usize = 32;

/// A tree over fixed boxes, to find those that touch another box without testing all of them.
///
/// Building takes n log n steps. Empty boxes touch nothing.
///
/// ```
/// use dwell_scene::Aabb;
/// use dwell_scene::bvh::BoxTree;
/// use glam::Vec3;
/// let at = |x: f32| Aabb::new(Vec3::splat(x), Vec3::splat(x + 1.0));
/// let tree = BoxTree::new((0..100).map(|k| at(2.0 * k as f32)).collect());
/// assert_eq!(tree.intersecting(&at(20.5)), [10]);
/// assert_eq!(tree.intersecting(&at(20.5).grown(1.0)), [10, 11]);
/// ```
#[derive(Clone, Debug, Default)]
pub struct BoxTree {
    tree: BinaryBvh,
    boxes: Vec<Aabb>,
}

impl BoxTree {
    /// Builds the tree; boxes keep their numbers.
    pub fn new(boxes: Vec<Aabb>) -> Self {
        let mut tree = BinaryBvh::default();
        rebuild_median_tree(&boxes, LEAF, &mut tree);
        Self { tree, boxes }
    }

    /// Returns the box of a number.
    pub fn get(&self, index: usize) -> Option<&Aabb> {
        self.boxes.get(index)
    }

    /// Returns the numbers of all boxes that share a point with `reach`, rising.
    pub fn intersecting(&self, reach: &Aabb) -> Vec<usize> {
        self.k_nearest_intersecting(reach, usize::MAX, |_| true)
    }

    /// Calls `visit` with the number of each box that contains `point`, border included, in no particular order.
    ///
    /// It takes no memory: for queries that are made often.
    pub fn for_each_at(&self, point: Vec3, mut visit: impl FnMut(usize)) {
        if !self.tree.nodes.is_empty() {
            self.visit_node(0, point, &mut visit);
        }
    }

    /// The tree is split in the middle: it is as deep as the logarithm of the number of boxes.
    fn visit_node(&self, k: usize, point: Vec3, visit: &mut impl FnMut(usize)) {
        let node = &self.tree.nodes[k];
        if !node.bounds.contains(point) {
            return;
        }
        let first = node.first as usize;
        if node.count == 0 {
            self.visit_node(first, point, visit);
            self.visit_node(first + 1, point, visit);
            return;
        }
        for index in &self.tree.primitive_order[first..first + node.count as usize] {
            if self.boxes[*index as usize].contains(point) {
                visit(*index as usize);
            }
        }
    }

    /// Returns the numbers of at most `most` boxes that share a point with `reach` and for which `counts` is true, rising.
    ///
    /// Of more than `most` it returns those about the middle of `reach`: of two branches of the tree the one whose middle
    /// is nearer is searched first. It calls `counts` for at most 32 times `most` boxes, however many lie in one place.
    pub fn k_nearest_intersecting(
        &self,
        reach: &Aabb,
        most: usize,
        mut counts: impl FnMut(usize) -> bool,
    ) -> Vec<usize> {
        let mut found = Vec::new();
        if reach.is_empty() || self.tree.nodes.is_empty() {
            return found;
        }
        let middle = reach.center();
        let mut asked = 0;
        let most_asked = most.saturating_mul(TESTS_PER_BOX);
        let mut open = vec![0_usize];
        while let Some(k) = open.pop() {
            let node = &self.tree.nodes[k];
            if !node.bounds.intersects(reach) {
                continue;
            }
            let first = node.first as usize;
            if node.count == 0 {
                let away = |k: usize| center_distance_squared(&self.tree.nodes[k].bounds, middle);
                let nearer = usize::from(away(first + 1) < away(first));
                open.extend([first + 1 - nearer, first + nearer]);
                continue;
            }
            for index in &self.tree.primitive_order[first..first + node.count as usize] {
                let index = *index as usize;
                if found.len() < most && asked < most_asked && self.boxes[index].intersects(reach) {
                    asked += 1;
                    found.extend(counts(index).then_some(index));
                }
            }
            if found.len() >= most || asked >= most_asked {
                break;
            }
        }
        found.sort_unstable();
        found
    }
}

/// Returns the squared distance of a box's middle, m².
fn center_distance_squared(bounds: &Aabb, point: Vec3) -> f32 {
    bounds.center().distance_squared(point)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::RandomKey;

    fn cloud(count: usize, edge_m: f32) -> Vec<Aabb> {
        let mut stream = RandomKey::root(4).stream();
        let mut point = |low: f32, high: f32| {
            Vec3::new(
                stream.range(low, high),
                stream.range(low, high),
                stream.range(low, high),
            )
        };
        (0..count)
            .map(|_| {
                let at = point(0.0, edge_m);
                Aabb::new(at, at + point(0.1, 1.0))
            })
            .collect()
    }

    #[test]
    fn it_finds_what_looking_at_all_finds() {
        let mut boxes = cloud(300, 6.0);
        boxes[7] = Aabb::EMPTY;
        let tree = BoxTree::new(boxes.clone());
        for reach in cloud(100, 6.0) {
            let all = boxes.iter().enumerate();
            let touching = all.filter(|(_, b)| !b.is_empty() && b.intersects(&reach));
            let expected: Vec<usize> = touching.map(|(k, _)| k).collect();
            assert_eq!(tree.intersecting(&reach), expected);
            let odd: Vec<usize> = expected.into_iter().filter(|k| k % 2 == 1).collect();
            assert_eq!(
                tree.k_nearest_intersecting(&reach, 1000, |k| k % 2 == 1),
                odd
            );
        }
        assert!(tree.intersecting(&Aabb::EMPTY).is_empty());
        assert!(BoxTree::new(Vec::new()).intersecting(&boxes[0]).is_empty());
    }

    #[test]
    fn at_a_point_it_finds_what_looking_at_all_finds() {
        let mut boxes = cloud(300, 6.0);
        boxes[7] = Aabb::EMPTY;
        let tree = BoxTree::new(boxes.clone());
        let corners = boxes.iter().skip(8).map(|b| b.min);
        for point in corners.chain(cloud(100, 6.0).iter().map(Aabb::center)) {
            let mut found = Vec::new();
            tree.for_each_at(point, |k| found.push(k));
            found.sort_unstable();
            let all = boxes.iter().enumerate();
            let around = all.filter(|(_, b)| b.contains(point)).map(|(k, _)| k);
            assert_eq!(found, around.collect::<Vec<usize>>());
        }
        BoxTree::default().for_each_at(Vec3::ZERO, |_| unreachable!("it has no boxes"));
    }

    #[test]
    fn it_asks_of_few_of_those_in_one_place() {
        let one = Aabb::new(Vec3::ZERO, Vec3::ONE);
        let tree = BoxTree::new(vec![one; 10_000]);
        for (counts, expected) in [(true, (64, 64)), (false, (0, 32 * 64))] {
            let mut asked = 0;
            let found = tree.k_nearest_intersecting(&one, 64, |_| {
                asked += 1;
                counts
            });
            assert_eq!((found.len(), asked), expected);
        }
    }

    #[test]
    fn of_many_it_finds_those_about_the_middle() {
        let boxes: Vec<Aabb> = (0..1000)
            .map(|k| Aabb::new(Vec3::X * k as f32, Vec3::X * (k as f32 + 1.5) + Vec3::ONE))
            .collect();
        let tree = BoxTree::new(boxes);
        let reach = Aabb::new(Vec3::X * 500.0, Vec3::X * 700.0);
        let found = tree.k_nearest_intersecting(&reach, 20, |_| true);
        assert_eq!(found.len(), 20);
        assert!(found.iter().all(|k| (560..640).contains(k)), "{found:?}");
    }
}
