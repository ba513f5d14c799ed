//! Triangles of the faces of an OBJ file.

use glam::{DVec2, Vec3};

use crate::import::triangulate;

/// Largest number of corners of a concave face that is cut; some 0.1 s for one that crosses itself all over.
const MAX_CONCAVE_CORNERS: usize = 4096;
/// Sine of the angle by which a corner may turn inwards in a convex face: that of rounded coordinates.
const STRAIGHT: f64 = 1e-5;
/// Share of its area by which the triangles of a face may differ from it.
const AREA_TOLERANCE: f64 = 1e-3;

/// Cuts faces into triangles.
#[derive(Default)]
pub(super) struct FaceTriangulator {
    corners: Vec<DVec2>,
    /// Number of faces that cross themselves or have too many corners; they are fans of triangles, as convex faces are.
    pub(super) unfilled: u64,
}

impl FaceTriangulator {
    /// Triangles of a face, as positions among its corners `points` (m), with its unit normal: a fan from the first corner where the
    /// face is convex, and triangles that fill it otherwise. They turn as the face turns.
    pub(super) fn triangulate_face(&mut self, points: &[Vec3], normal: Vec3) -> Vec<[usize; 3]> {
        let fan = || (1..points.len() - 1).map(|k| [0, k, k + 1]).collect();
        if points.len() == 3 {
            return fan();
        }
        self.corners.clear();
        self.corners
            .extend(points.iter().map(|p| project_along_normal(*p, normal)));
        if is_convex(&self.corners) {
            return fan();
        }
        if points.len() <= MAX_CONCAVE_CORNERS {
            let triangles = triangulate(&self.corners);
            let cut: f64 = triangles
                .iter()
                .map(|t| area(&t.map(|k| self.corners[k])))
                .sum();
            let whole = area(&self.corners);
            if whole > 0.0 && (cut - whole).abs() <= AREA_TOLERANCE * whole {
                return triangles;
            }
        }
        self.unfilled += 1;
        fan()
    }
}

/// A point without the coordinate along which the normal is longest, so that faces turn counter-clockwise.
fn project_along_normal(p: Vec3, normal: Vec3) -> DVec2 {
    let [x, y, z] = p.as_dvec3().to_array();
    let long = normal.abs();
    let (u, v, along) = if long.z >= long.x && long.z >= long.y {
        (x, y, normal.z)
    } else if long.y >= long.x {
        (z, x, normal.y)
    } else {
        (y, z, normal.x)
    };
    DVec2::new(if along < 0.0 { -u } else { u }, v)
}

/// The area, positive where the corners turn counter-clockwise.
fn area(corners: &[DVec2]) -> f64 {
    let origin = corners[0];
    let pairs = corners.windows(2);
    pairs
        .map(|p| (p[0] - origin).perp_dot(p[1] - origin))
        .sum::<f64>()
        / 2.0
}

/// Returns whether no corner turns inwards.
fn is_convex(corners: &[DVec2]) -> bool {
    let count = corners.len();
    (0..count).all(|k| {
        let edge = corners[(k + 1) % count] - corners[k];
        let next = corners[(k + 2) % count] - corners[(k + 1) % count];
        edge.perp_dot(next) >= -STRAIGHT * edge.length() * next.length()
    })
}
