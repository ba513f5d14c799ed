//! Watertight ray-triangle intersection.
//!
//! Edge functions in Plücker form, each with a bound of its rounding: a ray passes inside when it may, so of the triangles
//! around an edge or a corner at least one is hit. A triangle grows by some 1e-6 of its distance this way.
//!
//! # Source
//! R. Shevtsov, A. Soupikov, A. Kapustin, "Ray-Triangle Intersection Algorithm for Modern CPU Architectures" (2007); with edges
//! relative to the origin as in T. Davidovič et al., "3D Rasterization: A Bridge between Rasterization and Ray Casting" (2012).

use glam::Vec4;

use super::super::node::TriangleBlock;
use super::array3;
use super::slab::{PaddedOrigin, max_f32, min_f32};

/// Four triangles as seen from an origin.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct EdgePlanes {
    /// Per edge the normal of the plane through the edge and the origin; the edges opposite the second corner, the third,
    /// the first. Shape (edge, axis, triangle).
    normals: [[Vec4; 3]; 3],
    /// Bounds on the rounding errors of the edge functions. Shape (edge, triangle).
    tolerances: [Vec4; 3],
}

#[inline(always)]
fn minus(a: &[Vec4; 3], b: &[Vec4; 3]) -> [Vec4; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn plus(a: &[Vec4; 3], b: &[Vec4; 3]) -> [Vec4; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline(always)]
fn cross(a: [Vec4; 3], b: [Vec4; 3]) -> [Vec4; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

#[inline(always)]
pub(in super::super) fn dot(a: [f32; 3], x: f32, y: f32, z: f32) -> f32 {
    (a[0] * x + a[1] * y) + a[2] * z
}

#[inline(always)]
fn dot4(a: &[Vec4; 3], d: [f32; 3]) -> Vec4 {
    (a[0] * d[0] + a[1] * d[1]) + a[2] * d[2]
}

/// Bound of the relative rounding of an edge function: seven roundings of 2^-24 each.
const ROUNDING: f32 = 8.0 / 16_777_216.0;

#[inline(always)]
fn sum_of_sizes(v: &[Vec4; 3]) -> Vec4 {
    v[0].abs() + v[1].abs() + v[2].abs()
}

impl EdgePlanes {
    /// `longest`: no component of a direction exceeds it.
    #[inline(always)]
    pub(in super::super) fn new(block: &TriangleBlock, origin: [f32; 3], longest: f32) -> Self {
        let origin = array3(|axis| Vec4::splat(origin[axis]));
        let a = minus(&block.a, &origin);
        let b = minus(&block.b, &origin);
        let c = minus(&block.c, &origin);
        let edges = [minus(&c, &a), minus(&a, &b), minus(&b, &c)];
        let sums = [plus(&c, &a), plus(&a, &b), plus(&b, &c)];
        let off =
            |k: usize| sum_of_sizes(&edges[k]) * sum_of_sizes(&sums[k]) * (ROUNDING * longest);
        Self {
            normals: [
                cross(edges[0], sums[0]),
                cross(edges[1], sums[1]),
                cross(edges[2], sums[2]),
            ],
            tolerances: [off(0), off(1), off(2)],
        }
    }

    /// Edge functions of a direction, proportional to the weights of the second, third and first corner at the hit.
    #[inline(always)]
    pub(in super::super) fn edge_functions(&self, direction: [f32; 3]) -> [Vec4; 3] {
        [
            dot4(&self.normals[0], direction),
            dot4(&self.normals[1], direction),
            dot4(&self.normals[2], direction),
        ]
    }

    /// Returns the triangles that a ray may pass inside, as bits, from either side.
    #[inline(always)]
    pub(in super::super) fn triangles_hit(&self, direction: [f32; 3]) -> u32 {
        let ([u, v, w], [tu, tv, tw]) = (self.edge_functions(direction), self.tolerances);
        let lowest = (u + tu).min(v + tv).min(w + tw);
        let highest = (u - tu).max(v - tv).max(w - tw);
        (lowest.cmpge(Vec4::ZERO) | highest.cmple(Vec4::ZERO)).bitmask()
    }

    /// Returns the triangles that some ray whose direction lies between `low` and `high` may pass inside, as bits.
    #[inline(always)]
    pub(in super::super) fn triangles_hit_by_any(&self, low: [f32; 3], high: [f32; 3]) -> u32 {
        let bounds = |n: &[Vec4; 3]| {
            let least = array3(|k| (n[k] * low[k]).min(n[k] * high[k]));
            let most = array3(|k| (n[k] * low[k]).max(n[k] * high[k]));
            (
                (least[0] + least[1]) + least[2],
                (most[0] + most[1]) + most[2],
            )
        };
        let ((u0, u1), (v0, v1), (w0, w1)) = (
            bounds(&self.normals[0]),
            bounds(&self.normals[1]),
            bounds(&self.normals[2]),
        );
        let [tu, tv, tw] = self.tolerances;
        let all_may_be_positive = (u1 + tu).min(v1 + tv).min(w1 + tw).cmpge(Vec4::ZERO);
        let all_may_be_negative = (u0 - tu).max(v0 - tv).max(w0 - tw).cmple(Vec4::ZERO);
        (all_may_be_positive | all_may_be_negative).bitmask()
    }
}

/// Four triangles prepared for rays with one origin, one number after the other.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct OriginTriangles {
    /// See [`EdgePlanes`]. Shape (edge, axis, triangle).
    pub(in super::super) edges: [[[f32; 4]; 3]; 3],
    /// Shape (edge, triangle).
    pub(in super::super) tolerances: [[f32; 4]; 3],
    /// Shape (axis, triangle).
    pub(in super::super) normal: [[f32; 4]; 3],
    /// Distances of the planes from the origin, along their normals.
    pub(in super::super) height: [f32; 4],
    /// The triangles' boxes as seen from the origin: lower corners, upper corners. Shape (6, triangle).
    pub(in super::super) bounds: [[f32; 4]; 6],
}

impl OriginTriangles {
    #[inline(always)]
    pub(in super::super) fn new(
        block: &TriangleBlock,
        planes: &EdgePlanes,
        origin: [f32; 3],
        wide: &PaddedOrigin,
    ) -> Self {
        let corner = minus(&block.a, &array3(|axis| Vec4::splat(origin[axis])));
        let n = &block.normal;
        let height = (n[0] * corner[0] + n[1] * corner[1]) + n[2] * corner[2];
        let low = |k: usize| (block.a[k].min(block.b[k]).min(block.c[k]) - wide.0[k]).to_array();
        let high =
            |k: usize| (block.a[k].max(block.b[k]).max(block.c[k]) - wide.0[k + 3]).to_array();
        Self {
            edges: array3(|edge| array3(|axis| planes.normals[edge][axis].to_array())),
            tolerances: array3(|edge| planes.tolerances[edge].to_array()),
            normal: array3(|axis| n[axis].to_array()),
            height: height.to_array(),
            bounds: [low(0), low(1), low(2), high(0), high(1), high(2)],
        }
    }
}

/// Distance of the plane of one triangle of a block from an origin, along its normal.
#[inline(always)]
pub(in super::super) fn plane_distance(
    block: &TriangleBlock,
    lane: usize,
    origin: [f32; 3],
) -> f32 {
    let [x, y, z] = array3(|axis| block.a[axis][lane] - origin[axis]);
    dot(block.normal_of(lane), x, y, z)
}

/// Returns whether the edge functions allow the ray to pass inside, from either side.
#[inline(always)]
pub(in super::super) fn is_inside([u, v, w]: [f32; 3], [tu, tv, tw]: [f32; 3]) -> bool {
    let lowest = min_f32(min_f32(u + tu, v + tv), w + tw);
    let highest = max_f32(max_f32(u - tu, v - tv), w - tw);
    (lowest >= 0.0) | (highest <= 0.0)
}

/// Weights of the second and third corner from the edge functions of a ray that passes inside; at least 0, at most 1 in all.
#[inline]
pub(in super::super) fn barycentric_weights([u, v, w]: [f32; 3]) -> (f32, f32) {
    let front = ((u + v) + w) >= 0.0;
    let sign = if front { 1.0 } else { -1.0 };
    let (u, v, w) = (
        max_f32(sign * u, 0.0),
        max_f32(sign * v, 0.0),
        max_f32(sign * w, 0.0),
    );
    let sum = (u + v) + w;
    if sum > 0.0 {
        (u / sum, v / sum)
    } else {
        (0.0, 0.0)
    }
}

/// Returns the distance at which a ray hits a triangle, or NaN. `distance`: of the plane, along the ray; `slope`: its
/// direction along the normal; `margin`: of boxes.
///
/// Rounding may put the plane's distance outside the range in which the ray crosses the triangle's box, most so at grazing
/// angles. There it counts as far as the plane is within the margin. So hits always lie in the boxes of their triangles,
/// and no box can be skipped wrongly.
#[inline(always)]
pub(in super::super) fn clamped_hit_distance(
    distance: f32,
    slope: f32,
    (enter, leave): (f32, f32),
    margin: f32,
) -> f32 {
    let inside = min_f32(max_f32(distance, enter), leave);
    let off = (distance - inside) * slope;
    let counts = (slope != 0.0) & (enter <= leave) & (max_f32(off, -off) <= margin);
    if counts { inside } else { f32::NAN }
}

/// The smallest box around one triangle of a block.
#[inline(always)]
pub(in super::super) fn bounds(block: &TriangleBlock, lane: usize) -> ([f32; 3], [f32; 3]) {
    let corner = |k: usize| (block.a[k][lane], block.b[k][lane], block.c[k][lane]);
    let ((ax, bx, cx), (ay, by, cy), (az, bz, cz)) = (corner(0), corner(1), corner(2));
    (
        [
            min_f32(min_f32(ax, bx), cx),
            min_f32(min_f32(ay, by), cy),
            min_f32(min_f32(az, bz), cz),
        ],
        [
            max_f32(max_f32(ax, bx), cx),
            max_f32(max_f32(ay, by), cy),
            max_f32(max_f32(az, bz), cz),
        ],
    )
}
