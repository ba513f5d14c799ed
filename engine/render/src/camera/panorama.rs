//! Panoramic cameras: equirectangular pictures and cube maps.

use dwell_scene::math;
use glam::{Vec2, Vec3};
use std::f32::consts::{PI, TAU};

/// Right, up and back of each face of a cube map, in the camera's frame: ahead, left, behind, right, up, down.
const FACES: [[Vec3; 3]; 6] = [
    [Vec3::X, Vec3::Y, Vec3::Z],
    [Vec3::NEG_Z, Vec3::Y, Vec3::X],
    [Vec3::NEG_X, Vec3::Y, Vec3::NEG_Z],
    [Vec3::Z, Vec3::Y, Vec3::NEG_X],
    [Vec3::X, Vec3::Z, Vec3::NEG_Y],
    [Vec3::X, Vec3::NEG_Z, Vec3::Y],
];

/// The unit direction at a point of an equirectangular image.
pub(super) fn sphere_direction(image: Vec2, (width, height): (f32, f32)) -> Vec3 {
    let (sin_right, cos_right) = math::sin_cos((image.x / width - 0.5) * TAU);
    let (sin_up, cos_up) = math::sin_cos((0.5 - image.y / height) * PI);
    Vec3::new(sin_right * cos_up, sin_up, -cos_right * cos_up)
}

/// Returns the image of a point in an equirectangular image.
pub(super) fn sphere_project(point: Vec3, (width, height): (f32, f32)) -> Option<Vec2> {
    if point == Vec3::ZERO {
        return None;
    }
    let right = math::atan2(point.x, -point.z);
    let across = (point.x * point.x + point.z * point.z).sqrt();
    let up = math::atan2(point.y, across);
    Some(Vec2::new(
        (right / TAU + 0.5) * width,
        (0.5 - up / PI) * height,
    ))
}

/// The unit direction at a point of a cube map with faces of `edge` pixels.
pub(super) fn cube_direction(image: Vec2, edge: f32) -> Vec3 {
    let face = ((image.y / edge) as usize).min(5);
    let [right, up, back] = FACES[face];
    let x = 2.0 * image.x / edge - 1.0;
    let y = 1.0 - 2.0 * (image.y / edge - face as f32);
    (right * x + up * y - back).normalize_or_zero()
}

/// Returns the image of a point in a cube map.
pub(super) fn cube_project(point: Vec3, edge: f32) -> Option<Vec2> {
    let mut best: Option<(usize, f32)> = None;
    for (k, [.., back]) in FACES.iter().enumerate() {
        let depth = -point.dot(*back);
        if depth > best.map_or(0.0, |(_, deepest)| deepest) {
            best = Some((k, depth));
        }
    }
    let (face, depth) = best?;
    let [right, up, _] = FACES[face];
    let x = (point.dot(right) / depth + 1.0) * 0.5 * edge;
    let y = (1.0 - point.dot(up) / depth) * 0.5 * edge;
    Some(Vec2::new(x, y + face as f32 * edge))
}
