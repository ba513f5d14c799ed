//! Extents of things: the box, the outline from above, and the points of support.

use super::hull::Hull;
use super::triangles::PlacedTriangles;
use dwell_scene::{Aabb, House, ObjectId, State};
use glam::{Vec2, Vec3};

/// Thickness of the lowest layer of a thing that counts as its sole, m.
const SOLE_M: f32 = 0.02;
/// The number of points that stand for a sole.
const SOLE_POINTS: usize = 32;

/// The extent of an object in one state.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Extent {
    /// The box around it, m.
    pub bounds: Aabb,
    /// Its convex outline seen from above.
    pub footprint: Hull,
    /// Points spread evenly over the faces of its lowest 2 cm that look down or up, m; its lowest corners if it has no
    /// such face.
    pub sole: Vec<Vec3>,
}

impl Extent {
    /// Measures `object` as it stands in `state`.
    pub fn measure(house: &House, state: &State, object: ObjectId) -> Self {
        let placed = PlacedTriangles::gather(house, state, object);
        let mut bounds = Aabb::EMPTY;
        let mut outline = Vec::with_capacity(placed.positions.len());
        for corner in placed.used_positions() {
            bounds.add_point(corner);
            outline.push(Vec2::new(corner.x, corner.z));
        }
        let footprint = Hull::around(outline);
        let sole = underside_points(&placed, bounds.min.y + SOLE_M);
        Self {
            bounds,
            footprint,
            sole,
        }
    }

    /// The height of its lowest point, m.
    pub fn bottom_m(&self) -> f32 {
        self.bounds.min.y
    }
}

fn underside_points(placed: &PlacedTriangles, top: f32) -> Vec<Vec3> {
    let mut faces: Vec<([Vec3; 3], f32)> = Vec::new();
    for corners in placed.corners() {
        if !corners.iter().all(|corner| corner.y <= top) {
            continue;
        }
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a);
        if normal.y.abs() > 0.5 * normal.length() {
            faces.push((corners, normal.length() * 0.5));
        }
    }
    let total: f32 = faces.iter().map(|(_, area)| area).sum();
    if total <= 0.0 {
        let below = placed.corners().flatten().filter(|corner| corner.y <= top);
        let corners_below: Vec<Vec3> = below.collect();
        let step = corners_below.len().div_ceil(SOLE_POINTS).max(1);
        return corners_below.into_iter().step_by(step).collect();
    }
    // One point at the middle of each of 32 equal shares of the area, placed inside its triangle by an R2 sequence.
    let mut points = Vec::with_capacity(SOLE_POINTS);
    let (mut face, mut passed) = (0, 0.0);
    for k in 0..SOLE_POINTS {
        let wanted = (k as f32 + 0.5) / SOLE_POINTS as f32 * total;
        while face + 1 < faces.len() && passed + faces[face].1 < wanted {
            passed += faces[face].1;
            face += 1;
        }
        let ([a, b, c], _) = faces[face];
        let (mut u, mut v) = (
            (0.754_877_7 * (k + 1) as f32).fract(),
            (0.569_840_3 * (k + 1) as f32).fract(),
        );
        if u + v > 1.0 {
            (u, v) = (1.0 - u, 1.0 - v);
        }
        points.push(a + (b - a) * u + (c - a) * v);
    }
    points
}
