//! The tree of triangles of a mesh, or of all static geometry of a house.

use glam::{DVec3, Vec3};

use super::binary::{BinaryBvh, median_tree};
use super::build;
use super::node::{NodeLink, TriangleBlock, TriangleInfo, WIDTH};
use super::ray::RayMask;
use super::wide::WideBvh;
use crate::bounds::Aabb;

/// Largest coordinate, m; triangles beyond are left out.
const FURTHEST_M: f32 = 1e12;

/// The attributes of a triangle besides its corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TriangleAttributes {
    /// Reported by hits, and the tie-break among coincident surfaces: the lower id wins.
    pub id: i32,
    /// The rays that see the triangle.
    pub mask: RayMask,
}

impl TriangleAttributes {
    /// A tag seen by every ray.
    pub fn new(id: i32) -> Self {
        Self {
            id,
            mask: RayMask::ALL,
        }
    }
}

/// A tree of triangles, immutable once built. Triangles are seen from both sides.
#[derive(Debug, Default)]
pub struct TriangleBvh {
    pub(super) tree: WideBvh,
    pub(super) blocks: Vec<TriangleBlock>,
    /// Four for each block.
    pub(super) surfaces: Vec<TriangleInfo>,
    count: usize,
    left_out: usize,
}

impl TriangleBvh {
    /// Builds the tree of a mesh; every triangle has id 0 and is seen by every ray.
    ///
    /// `positions`: m. `triangles`: indices into `positions`, shape (triangle, 3). Triangles without area, with indices out
    /// of range or with coordinates that are not finite or exceed 10^12 m are left out (see [`Self::skipped_triangles`]); the others
    /// keep their numbers.
    ///
    /// # Determinism
    /// Equal input, equal tree.
    pub fn build(positions: &[Vec3], triangles: &[[u32; 3]]) -> Self {
        Self::build_tagged(positions, triangles, |_| TriangleAttributes::new(0))
    }

    /// As [`Self::build`]; `tag` gives the attributes of the triangle at a position of the list.
    pub fn build_tagged(
        positions: &[Vec3],
        triangles: &[[u32; 3]],
        tag: impl Fn(usize) -> TriangleAttributes,
    ) -> Self {
        let mut list = BuildTriangles::default();
        for (index, triangle) in triangles.iter().enumerate() {
            let corner = |k: usize| positions.get(triangle[k] as usize).copied();
            if let (Some(a), Some(b), Some(c)) = (corner(0), corner(1), corner(2)) {
                list.push([a, b, c], index, &tag);
            }
        }
        let mut bvh = Self {
            count: list.boxes.len(),
            left_out: triangles.len() - list.boxes.len(),
            ..Self::default()
        };
        if !bvh.fill(&list, &build::ploc_tree(&list.boxes)) {
            // A balanced tree is never too deep.
            bvh.fill(&list, &median_tree(&list.boxes));
        }
        bvh
    }

    /// Stores the triangles in the order of a tree's leaves; returns whether the tree is flat enough.
    fn fill(&mut self, list: &BuildTriangles, binary: &BinaryBvh) -> bool {
        self.blocks.clear();
        self.surfaces.clear();
        self.blocks.reserve(self.count / 2);
        self.surfaces.reserve(self.count * 2);
        let (blocks, surfaces) = (&mut self.blocks, &mut self.surfaces);
        self.tree.fill(binary, &mut |leaf| {
            let mut block = TriangleBlock::EMPTY;
            let first = surfaces.len();
            surfaces.resize(first + WIDTH, TriangleInfo::NONE);
            for (lane, &k) in binary.primitive_order[leaf].iter().enumerate() {
                let [a, b, c] = list.corners[k as usize];
                for axis in 0..3 {
                    block.a[axis][lane] = a[axis];
                    block.b[axis][lane] = b[axis];
                    block.c[axis][lane] = c[axis];
                    block.normal[axis][lane] = list.normals[k as usize][axis];
                }
                surfaces[first + lane] = list.surfaces[k as usize];
            }
            blocks.push(block);
            NodeLink::leaf(blocks.len() - 1)
        })
    }

    /// The smallest box around all triangles, m; empty when there are none.
    pub fn bounds(&self) -> Aabb {
        self.tree.bounds
    }

    /// Triangles in the tree.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Returns whether no ray can hit anything.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Returns the number of input triangles that were left out.
    pub fn skipped_triangles(&self) -> usize {
        self.left_out
    }

    /// Memory held, bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(self.tree.nodes.as_slice())
            + size_of_val(self.blocks.as_slice())
            + size_of_val(self.surfaces.as_slice())
    }
}

/// Triangles that are valid for a tree.
#[derive(Default)]
struct BuildTriangles {
    corners: Vec<[Vec3; 3]>,
    normals: Vec<Vec3>,
    boxes: Vec<Aabb>,
    surfaces: Vec<TriangleInfo>,
}

impl BuildTriangles {
    fn push(
        &mut self,
        [a, b, c]: [Vec3; 3],
        index: usize,
        tag: impl Fn(usize) -> TriangleAttributes,
    ) {
        let usable = |v: Vec3| v.is_finite() && v.abs().max_element() <= FURTHEST_M;
        if !(usable(a) && usable(b) && usable(c)) {
            return;
        }
        let Some(normal) = normal(a, b, c) else {
            return;
        };
        self.corners.push([a, b, c]);
        self.normals.push(normal);
        self.boxes.push(Aabb {
            min: a.min(b).min(c),
            max: a.max(b).max(c),
        });
        let TriangleAttributes { id, mask } = tag(index);
        self.surfaces.push(TriangleInfo {
            id,
            index: index as u32,
            mask,
        });
    }
}

/// Returns the unit normal, or `None` for a degenerate triangle. In double precision, so that slivers have good planes, too.
fn normal(a: Vec3, b: Vec3, c: Vec3) -> Option<Vec3> {
    let (a, b, c) = (a.as_dvec3(), b.as_dvec3(), c.as_dvec3());
    let normal: DVec3 = (b - a).cross(c - a);
    let length = normal.length();
    (length > 0.0 && length.is_finite()).then(|| (normal / length).as_vec3())
}
