//! Trees as rows of four numbers, for processors that traverse them without this crate.

use glam::{Vec3, Vec4};

use super::instances::InstanceSet;
use super::node::{Node, NodeLink, WIDTH};
use super::ray::RayMask;
use super::triangles::TriangleBvh;
use super::wide::WideBvh;
use crate::bounds::Aabb;
use crate::space::Pose;

/// Four numbers as bits: `f32`, `i32` or `u32`.
pub type PackedRow = [u32; 4];

/// Rows of a node: lower corners of its children's boxes along x, y and z, upper corners, and links. A link is [`NO_LINK`],
/// the position of a node, or, with bit 31 set, of a block (an instance in the tree of an [`InstanceSet`]).
pub const NODE_ROWS: usize = 7;

/// Rows of a block of four triangles: first corners along x, y and z, second and third corners, normals, ids, and positions
/// in the list that the tree was built of, `u32::MAX` for a place that is not used.
pub const BLOCK_ROWS: usize = 14;

/// Rows of an instance. Three: a row of the inverse of its transform's linear part, and in the last place a coordinate of
/// its origin. Two: lower and upper corner of its box, with the longest row of that inverse (0: hidden) and its id.
pub const INSTANCE_ROWS: usize = 5;

/// The link to nothing.
pub const NO_LINK: u32 = u32::MAX;

/// The rows of a tree written by [`TriangleBvh::flatten`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlatBvhRoot {
    /// The link to its root.
    pub root: u32,
    /// Around all triangles, m.
    pub bounds: Aabb,
    /// Largest size of a traversal's stack.
    pub stack_size: usize,
}

fn bits(row: Vec4) -> PackedRow {
    row.to_array().map(f32::to_bits)
}

fn corner(point: Vec3, last: u32) -> PackedRow {
    let [x, y, z] = point.to_array().map(f32::to_bits);
    [x, y, z, last]
}

/// Returns a link in lists in which its tree starts at the given node and block.
fn rebase_link(link: NodeLink, first_node: usize, first_leaf: usize) -> u32 {
    if link == NodeLink::NONE {
        return NO_LINK;
    }
    let link = match link.unpack() {
        (true, leaf) => NodeLink::leaf(first_leaf + leaf),
        (false, node) => NodeLink::node(first_node + node),
    };
    link.bits()
}

fn write_nodes(tree: &WideBvh, first_node: usize, first_leaf: usize, rows: &mut Vec<PackedRow>) {
    for Node {
        planes,
        links,
        present: _,
    } in &tree.nodes
    {
        rows.extend(planes.map(bits));
        rows.push(links.map(|link| rebase_link(link, first_node, first_leaf)));
    }
}

/// Returns the largest number of stacked links below a link.
fn max_stack_depth(tree: &WideBvh, link: NodeLink) -> usize {
    let (true, node) = (link != NodeLink::NONE, link.unpack()) else {
        return 0;
    };
    let (false, index) = node else { return 0 };
    let children = tree.nodes[index].links.iter();
    let children: Vec<usize> = children
        .filter(|link| **link != NodeLink::NONE)
        .map(|link| max_stack_depth(tree, *link))
        .collect();
    children.len().saturating_sub(1) + children.iter().max().copied().unwrap_or(0)
}

impl TriangleBvh {
    /// Appends the tree's rows to those of others. Triangles that `mask` excludes are left out.
    pub fn flatten(
        &self,
        mask: RayMask,
        nodes: &mut Vec<PackedRow>,
        blocks: &mut Vec<PackedRow>,
    ) -> FlatBvhRoot {
        let (first_node, first_block) = (nodes.len() / NODE_ROWS, blocks.len() / BLOCK_ROWS);
        write_nodes(&self.tree, first_node, first_block, nodes);
        for (block, surfaces) in self.blocks.iter().zip(self.surfaces.as_chunks::<WIDTH>().0) {
            let seen = surfaces.map(|s| s.index != u32::MAX && s.mask.intersects(mask));
            for row in [block.a, block.b, block.c, block.normal].as_flattened() {
                let row = row.to_array();
                blocks.push(std::array::from_fn(|k| {
                    if seen[k] { row[k].to_bits() } else { 0 }
                }));
            }
            blocks.push(surfaces.map(|surface| surface.id as u32));
            blocks.push(std::array::from_fn(|k| {
                if seen[k] { surfaces[k].index } else { u32::MAX }
            }));
        }
        FlatBvhRoot {
            root: rebase_link(self.tree.root, first_node, first_block),
            bounds: self.tree.bounds,
            stack_size: max_stack_depth(&self.tree, self.tree.root),
        }
    }
}

impl InstanceSet {
    /// Appends the rows of the tree over the instances; returns the link to its root. Positions in links count from the
    /// first of these rows, and from the first instance.
    pub fn flatten_tree(&self, nodes: &mut Vec<PackedRow>) -> u32 {
        write_nodes(&self.tree, 0, 0, nodes);
        rebase_link(self.tree.root, 0, 0)
    }

    /// Returns the rows of an instance; one that `mask` excludes is hidden.
    pub fn flat_instance(
        &self,
        instance: usize,
        mask: RayMask,
    ) -> Option<[PackedRow; INSTANCE_ROWS]> {
        let placed = self.placed.get(instance)?;
        let [x, y, z] = placed.mesh_from_world.rows();
        let longest = if placed.mask.intersects(mask) {
            placed.mesh_from_world.max_component
        } else {
            0.0
        };
        Some([
            bits(x),
            bits(y),
            bits(z),
            corner(placed.bounds.min, longest.to_bits()),
            corner(placed.bounds.max, placed.id as u32),
        ])
    }
}

/// Returns a pose as two rows: its rotation as a quaternion, and its position.
pub fn flat_pose(pose: &Pose) -> [PackedRow; 2] {
    [bits(Vec4::from(pose.rotation)), corner(pose.position, 0)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bvh::TriangleAttributes;
    use crate::random::RandomKey;

    /// Traversal of the rows from the root visits every triangle of the list once, inside the boxes above it.
    #[test]
    fn rows_hold_every_triangle_within_its_boxes() {
        let mut stream = RandomKey::root(5).stream();
        let positions: Vec<Vec3> = (0..900)
            .map(|_| {
                Vec3::new(
                    stream.range(-5.0, 5.0),
                    stream.range(0.0, 3.0),
                    stream.range(-5.0, 5.0),
                )
            })
            .collect();
        let triangles: Vec<[u32; 3]> = (0..300).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        let bvh = TriangleBvh::build_tagged(&positions, &triangles, |k| TriangleAttributes {
            id: k as i32 + 7,
            mask: if k % 3 == 0 {
                RayMask::EAR
            } else {
                RayMask::ALL
            },
        });
        // Behind another tree.
        let other = TriangleBvh::build(&positions[..30], &triangles[..10]);
        let (mut nodes, mut blocks) = (Vec::new(), Vec::new());
        other.flatten(RayMask::EYE, &mut nodes, &mut blocks);
        let flat = bvh.flatten(RayMask::EYE, &mut nodes, &mut blocks);
        let number = |row: &PackedRow, k: usize| f32::from_bits(row[k]);
        let mut seen = vec![0; 300];
        let mut open = vec![(flat.root, flat.bounds)];
        let mut most = 0;
        while let Some((link, bounds)) = open.pop() {
            most = most.max(open.len());
            if link >> 31 == 0 {
                let node = &nodes[link as usize * NODE_ROWS..][..NODE_ROWS];
                for k in (0..4).filter(|k| node[6][*k] != NO_LINK) {
                    let at = |first: usize| {
                        let coordinate = |axis: usize| number(&node[first + axis], k);
                        Vec3::new(coordinate(0), coordinate(1), coordinate(2))
                    };
                    open.push((
                        node[6][k],
                        Aabb {
                            min: at(0),
                            max: at(3),
                        },
                    ));
                }
                continue;
            }
            let block = &blocks[(link & !(1 << 31)) as usize * BLOCK_ROWS..][..BLOCK_ROWS];
            for k in (0..4).filter(|k| block[13][*k] != u32::MAX) {
                let index = block[13][k] as usize;
                seen[index] += 1;
                assert_eq!(block[12][k] as usize, index + 7);
                for corner in 0..3 {
                    let coordinate = |axis: usize| number(&block[3 * corner + axis], k);
                    let point = Vec3::new(coordinate(0), coordinate(1), coordinate(2));
                    assert_eq!(point, positions[3 * index + corner]);
                    assert!(
                        point.cmpge(bounds.min).all() && point.cmple(bounds.max).all(),
                        "{index}"
                    );
                }
            }
        }
        for (k, count) in seen.iter().enumerate() {
            assert_eq!(*count, i32::from(k % 3 != 0), "{k}");
        }
        assert!(most <= flat.stack_size, "{most} {}", flat.stack_size);
    }
}
