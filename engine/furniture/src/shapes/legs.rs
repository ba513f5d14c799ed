//! Legs of furniture.

use super::SolidMesh;
use super::grid::add_face;
use dwell_scene::{Collider, Mesh};
use glam::Vec3;

/// A square leg from `foot` to `top`, horizontal ends, `foot_m` and `top_m` wide. It collides as its hull.
pub fn tapered_leg(foot: [f32; 3], top: [f32; 3], foot_m: f32, top_m: f32) -> SolidMesh {
    let ring = |center: [f32; 3], width: f32| {
        [(-0.5, 0.5), (0.5, 0.5), (0.5, -0.5), (-0.5, -0.5)]
            .map(|(x, z)| Vec3::from(center) + Vec3::new(x * width, 0.0, z * width))
    };
    let (low, high) = (ring(foot, foot_m), ring(top, top_m));
    let mut mesh = Mesh::default();
    for k in 0..4 {
        let next = (k + 1) % 4;
        let along = (high[k] - low[k]).normalize_or_zero();
        add_face(&mut mesh, &[low[k], low[next], high[next], high[k]], along);
    }
    add_face(&mut mesh, &high, Vec3::X);
    add_face(&mut mesh, &[low[3], low[2], low[1], low[0]], Vec3::X);
    let points = low.into_iter().chain(high).collect();
    SolidMesh::new(mesh, vec![Collider::Hull { points }])
}
