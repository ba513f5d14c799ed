//! A mesh, or all static geometry of a house, as a tree of triangles.

use glam::{DVec3, Vec3};

use super::build;
use super::node::{Node, NodePair};
use super::ray::RayMask;
use crate::bounds::Aabb;

/// Coordinates beyond this are no house's, m; such triangles are left out.
const FURTHEST_M: f32 = 1e12;

/// A triangle as the kernels read it; 64 bytes.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug)]
pub(super) struct PackedTriangle {
    pub(super) a: [f32; 3],
    pub(super) b: [f32; 3],
    pub(super) c: [f32; 3],
    /// Unit length, by the right hand from a over b to c.
    pub(super) normal: [f32; 3],
    pub(super) id: i32,
    /// Position in the input.
    pub(super) index: u32,
    pub(super) mask: RayMask,
}

/// What a triangle carries besides its corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TriangleTag {
    /// Reported by hits, and decides among coincident surfaces: the lower id wins.
    pub id: i32,
    /// The rays that see the triangle.
    pub mask: RayMask,
}

impl Default for TriangleTag {
    fn default() -> Self {
        Self { id: 0, mask: RayMask::ALL }
    }
}

/// A tree of triangles, immutable once built. Triangles are seen from both sides.
#[derive(Debug, Default)]
pub struct TriangleBvh {
    pub(super) root: Node,
    pub(super) pairs: Vec<NodePair>,
    pub(super) triangles: Vec<PackedTriangle>,
    bounds: Aabb,
    left_out: usize,
}

impl TriangleBvh {
    /// Builds the tree of a mesh; every triangle has id 0 and is seen by every ray.
    ///
    /// `positions`: m. `triangles`: indices into `positions`, shape (triangle, 3). Triangles without area, with indices
    /// out of range or with coordinates that are not finite or exceed 10^12 m are left out (see [`Self::left_out`]); they
    /// keep their place in the numbering.
    ///
    /// # Determinism
    /// Equal input, equal tree.
    pub fn build(positions: &[Vec3], triangles: &[[u32; 3]]) -> Self {
        Self::build_tagged(positions, triangles, |_| TriangleTag::default())
    }

    /// As [`Self::build`]; `tag` gives what the triangle at a position of the list carries.
    pub fn build_tagged(positions: &[Vec3], triangles: &[[u32; 3]], tag: impl Fn(usize) -> TriangleTag) -> Self {
        let mut packed = Vec::with_capacity(triangles.len());
        let mut boxes = Vec::with_capacity(triangles.len());
        for (index, corners) in triangles.iter().enumerate() {
            let corner = |k: usize| positions.get(corners[k] as usize).copied();
            let (Some(a), Some(b), Some(c)) = (corner(0), corner(1), corner(2)) else { continue };
            let Some(normal) = normal(a, b, c) else { continue };
            let (min, max) = (a.min(b).min(c), a.max(b).max(c));
            boxes.push(Aabb { min, max });
            let TriangleTag { id, mask } = tag(index);
            packed.push(PackedTriangle {
                a: a.to_array(),
                b: b.to_array(),
                c: c.to_array(),
                normal: normal.to_array(),
                id,
                index: index as u32,
                mask,
            });
        }
        let tree = build::tree(&boxes);
        let left_out = triangles.len() - packed.len();
        let ordered: Vec<PackedTriangle> = tree.order.iter().map(|&k| packed[k as usize]).collect();
        let bounds = boxes.iter().fold(Aabb::EMPTY, |all, b| all.union(b));
        Self { root: tree.root, pairs: tree.pairs, triangles: ordered, bounds, left_out }
    }

    /// The smallest box around all triangles, m; empty when there are none.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Triangles in the tree.
    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    /// Whether no ray can hit anything.
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// Triangles of the input that the tree does not hold.
    pub fn left_out(&self) -> usize {
        self.left_out
    }

    /// Memory held, bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(self.pairs.as_slice()) + size_of_val(self.triangles.as_slice())
    }
}

/// The unit normal, or nothing for corners that make no triangle.
fn normal(a: Vec3, b: Vec3, c: Vec3) -> Option<Vec3> {
    let usable = |v: Vec3| v.abs().max_element() <= FURTHEST_M && v.is_finite();
    if !(usable(a) && usable(b) && usable(c)) {
        return None;
    }
    // In double precision, so that slivers have good planes, too.
    let (a, b, c) = (a.as_dvec3(), b.as_dvec3(), c.as_dvec3());
    let normal: DVec3 = (b - a).cross(c - a);
    let length = normal.length();
    (length > 0.0 && length.is_finite()).then(|| (normal / length).as_vec3())
}

impl PackedTriangle {
    /// The smallest box around the triangle.
    #[inline(always)]
    pub(super) fn corners(&self) -> ([f32; 3], [f32; 3]) {
        let (mut min, mut max) = (self.a, self.a);
        for corner in [&self.b, &self.c] {
            for k in 0..3 {
                min[k] = if corner[k] < min[k] { corner[k] } else { min[k] };
                max[k] = if corner[k] > max[k] { corner[k] } else { max[k] };
            }
        }
        (min, max)
    }
}
