//! Prisms over any polygon.

use super::SolidMesh;
use super::grid::add_face;
use super::polygon::triangulate;
use dwell_scene::{Collider, Mesh};
use glam::{DVec2, Vec2, Vec3};

/// The prism over a simple polygon in the (x, y) plane, corners counter-clockwise, from z = 0 to `depth_m`. It collides as
/// the hull of its corners: give a polygon that is not convex its own pieces.
pub fn extrude(polygon: &[[f32; 2]], depth_m: f32) -> SolidMesh {
    let corners: Vec<Vec2> = polygon.iter().map(|p| Vec2::from(*p)).collect();
    let lift = |p: Vec2, z: f32| p.extend(z);
    let mut mesh = Mesh::default();
    let exact: Vec<DVec2> = corners.iter().map(|p| p.as_dvec2()).collect();
    for triangle in triangulate(&exact) {
        let [a, b, c] = triangle.map(|k| corners[k]);
        add_face(&mut mesh, &[a, b, c].map(|p| lift(p, depth_m)), Vec3::X);
        add_face(&mut mesh, &[a, c, b].map(|p| lift(p, 0.0)), Vec3::NEG_X);
    }
    for (k, a) in corners.iter().enumerate() {
        let b = corners[(k + 1) % corners.len()];
        let quad = [
            lift(*a, 0.0),
            lift(b, 0.0),
            lift(b, depth_m),
            lift(*a, depth_m),
        ];
        let along = if (b - *a).length() >= depth_m {
            (b - *a).normalize_or_zero().extend(0.0)
        } else {
            Vec3::Z
        };
        add_face(&mut mesh, &quad, along);
    }
    let points = corners
        .iter()
        .flat_map(|p| [lift(*p, 0.0), lift(*p, depth_m)])
        .collect();
    SolidMesh::new(mesh, vec![Collider::Hull { points }])
}
