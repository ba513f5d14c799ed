//! Prisms over any polygon.

use super::Solid;
use super::grid::add_face;
use dwell_scene::{Collider, Mesh};
use glam::{Vec2, Vec3};

/// The prism over a simple polygon in the (x, y) plane, corners counter-clockwise, from z = 0 to `depth_m`. It collides as
/// the hull of its corners: give a polygon that is not convex its own pieces.
pub fn extrude(polygon: &[[f32; 2]], depth_m: f32) -> Solid {
    let corners: Vec<Vec2> = polygon.iter().map(|p| Vec2::from(*p)).collect();
    let lift = |p: Vec2, z: f32| p.extend(z);
    let mut mesh = Mesh::default();
    for [a, b, c] in triangulate(&corners) {
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
    Solid::new(mesh, vec![Collider::Hull { points }])
}

/// Triangles of a simple polygon, by cutting ears.
fn triangulate(polygon: &[Vec2]) -> Vec<[Vec2; 3]> {
    let mut rest = polygon.to_vec();
    let mut triangles = Vec::with_capacity(polygon.len());
    let turn = |a: Vec2, b: Vec2, c: Vec2| (b - a).perp_dot(c - a);
    while rest.len() > 3 {
        let count = rest.len();
        let ear = (0..count).find(|&k| {
            let (a, b, c) = (
                rest[(k + count - 1) % count],
                rest[k],
                rest[(k + 1) % count],
            );
            let holds = |p: &Vec2| {
                ![a, b, c].contains(p)
                    && turn(a, b, *p) >= 0.0
                    && turn(b, c, *p) >= 0.0
                    && turn(c, a, *p) >= 0.0
            };
            turn(a, b, c) > 0.0 && !rest.iter().any(holds)
        });
        // A polygon that crosses itself has no ear left: what was cut so far is all there is.
        let Some(k) = ear else { return triangles };
        triangles.push([
            rest[(k + count - 1) % count],
            rest[k],
            rest[(k + 1) % count],
        ]);
        rest.remove(k);
    }
    if let [a, b, c] = rest[..] {
        triangles.push([a, b, c]);
    }
    triangles
}
