//! Leaves and clusters of them.

use super::SolidMesh;
use super::cloth::thick_sheet;
use super::solid::axis_rotation;
use dwell_scene::random::RandomKey;
use dwell_scene::{Collider, Pose, math};
use glam::Vec3;
use std::f32::consts::TAU;

/// Directions along which the hull of a crown is taken.
const HULL_DIRECTIONS: usize = 18;

/// One leaf: from the origin along +Z, arching up and down again by `droop` (0 flat, 1 strong), widest in its lower half.
/// Nothing touches it.
pub fn leaf(length_m: f32, width_m: f32, droop: f32) -> SolidMesh {
    let rows = 6;
    let mesh = thick_sheet(
        3,
        rows,
        |i, j| {
            let t = j as f32 / (rows - 1) as f32;
            let half = 0.5
                * width_m
                * math::pow(
                    math::sin(std::f32::consts::PI * (0.04 + 0.94 * math::pow(t, 0.8))),
                    0.9,
                );
            let side = 1.0 - i as f32;
            // The halves fold up a little along the rib.
            let y = length_m * (0.45 * t - droop * t * t) + 0.35 * half * side.abs();
            Vec3::new(side * half, y, length_m * t * (1.0 - 0.25 * droop * t))
        },
        Vec3::Y * 0.0015,
    );
    SolidMesh::new(mesh, Vec::new())
}

/// A crown of `count` leaves around +Y, from the origin up: lower ones larger and flatter. It collides as its hull.
pub fn foliage(
    count: usize,
    length_m: f32,
    width_m: f32,
    height_m: f32,
    key: RandomKey,
) -> SolidMesh {
    let mut random = key.stream();
    let mut crown = SolidMesh::default();
    for k in 0..count {
        let level = (k as f32 + 0.5) / count as f32;
        let size = (1.05 - 0.45 * level) * random.range(0.85, 1.15);
        // Successive leaves stand at the golden angle, as in many plants.
        let around = TAU * 0.381_966 * k as f32 + random.range(-0.2, 0.2);
        let lift = -(0.15 + 1.0 * level) * random.range(0.8, 1.2);
        let one = leaf(length_m * size, width_m * size, 0.55 - 0.25 * level);
        let pose = Pose::new(
            Vec3::Y * (height_m * level * 0.8),
            axis_rotation(Vec3::Y, around) * axis_rotation(Vec3::X, lift * 0.6),
        );
        crown = crown.merged(one.transformed(&pose));
    }
    let direction = |k: usize| {
        let y = 1.0 - 2.0 * (k as f32 + 0.5) / HULL_DIRECTIONS as f32;
        let (sin, cos) = math::sin_cos(TAU * 0.381_966 * k as f32);
        let r = (1.0 - y * y).max(0.0).sqrt();
        Vec3::new(r * sin, y, r * cos)
    };
    let far = |d: Vec3| {
        crown
            .mesh
            .positions
            .iter()
            .copied()
            .max_by(|a, b| a.dot(d).total_cmp(&b.dot(d)))
    };
    let points = (0..HULL_DIRECTIONS)
        .filter_map(|k| far(direction(k)))
        .collect();
    crown.colliders = vec![Collider::Hull { points }];
    crown
}
