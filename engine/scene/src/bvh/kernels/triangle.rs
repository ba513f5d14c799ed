//! Rays against triangles, without cracks.
//!
//! Edge functions in Plücker form: neighbours that share two corners compute the same number for their common edge, with
//! opposite signs, so a ray cannot slip between them.
//!
//! # Source
//! R. Shevtsov, A. Soupikov, A. Kapustin, "Ray-Triangle Intersection Algorithm for Modern CPU Architectures" (2007); the
//! property of the shared edge: T. Davidovič et al., "3D Rasterization: A Bridge between Rasterization and Ray Casting" (2012).

use super::super::triangles::PackedTriangle;
use super::slab::{least, most};

/// A triangle as seen from an origin: per edge the normal of the plane through the edge and the origin.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct EdgePlanes {
    /// Opposite the second corner, the third, the first.
    pub(in super::super) normals: [[f32; 3]; 3],
    /// The lower corner of the triangle's box, relative to nothing.
    corner: [f32; 3],
}

#[inline(always)]
pub(in super::super) fn minus(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn plus(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline(always)]
pub(in super::super) fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline(always)]
pub(in super::super) fn dot(a: [f32; 3], x: f32, y: f32, z: f32) -> f32 {
    (a[0] * x + a[1] * y) + a[2] * z
}

impl EdgePlanes {
    #[inline(always)]
    pub(in super::super) fn new(triangle: &PackedTriangle, origin: [f32; 3]) -> Self {
        let a = minus(triangle.a, origin);
        let b = minus(triangle.b, origin);
        let c = minus(triangle.c, origin);
        Self {
            normals: [
                cross(minus(c, a), plus(c, a)),
                cross(minus(a, b), plus(a, b)),
                cross(minus(b, c), plus(b, c)),
            ],
            corner: a,
        }
    }

    /// Edge functions of a direction, proportional to the weights of the second, third and first corner at the hit.
    #[inline(always)]
    pub(in super::super) fn sides(&self, x: f32, y: f32, z: f32) -> [f32; 3] {
        [dot(self.normals[0], x, y, z), dot(self.normals[1], x, y, z), dot(self.normals[2], x, y, z)]
    }

    /// Distance of the triangle's plane times the projection of its normal on a direction.
    #[inline(always)]
    pub(in super::super) fn height(&self, normal: [f32; 3]) -> f32 {
        dot(normal, self.corner[0], self.corner[1], self.corner[2])
    }
}

/// Whether edge functions say that the ray passes inside, from either side.
#[inline(always)]
pub(in super::super) fn inside(sides: [f32; 3]) -> bool {
    let lowest = least(least(sides[0], sides[1]), sides[2]);
    let highest = most(most(sides[0], sides[1]), sides[2]);
    (lowest >= 0.0) | (highest <= 0.0)
}

/// Weights of the second and third corner from the edge functions of a ray that passes inside.
#[inline]
pub(in super::super) fn weights(sides: [f32; 3]) -> (f32, f32) {
    let sum = (sides[0] + sides[1]) + sides[2];
    if sum == 0.0 { (0.0, 0.0) } else { (sides[0] / sum, sides[1] / sum) }
}
