//! Bent round bars: handles, taps, rings, metal frames.

use super::SolidMesh;
use super::grid::{Vertex, add_grid};
use super::revolve::profile_point;
use dwell_scene::{Collider, Mesh, Pose, math};
use glam::{Quat, Vec2, Vec3};
use std::f32::consts::TAU;

/// A straight round bar.
pub fn rod(from: [f32; 3], to: [f32; 3], radius_m: f32) -> SolidMesh {
    tube(&[from, to], radius_m, 8)
}

/// A round bar along `path`, flat ends. It collides as a cylinder for each straight piece.
pub fn tube(path: &[[f32; 3]], radius_m: f32, sides: usize) -> SolidMesh {
    let path: Vec<Vec3> = path.iter().map(|p| Vec3::from(*p)).collect();
    let last = path.len() - 1;
    let direction = |k: usize| (path[k + 1] - path[k]).normalize_or(Vec3::Y);
    // Cross sections stand halfway between neighbouring pieces and turn as little as possible from one to the next.
    let tangent = |k: usize| match k {
        0 => direction(0),
        k if k == last => direction(last - 1),
        k => (direction(k - 1) + direction(k)).normalize_or(direction(k)),
    };
    let mut frames = vec![Quat::from_rotation_arc(Vec3::Y, tangent(0))];
    for k in 1..=last {
        frames.push(Quat::from_rotation_arc(tangent(k - 1), tangent(k)) * frames[k - 1]);
    }
    let mut lengths = vec![0.0];
    for k in 1..=last {
        lengths.push(lengths[k - 1] + (path[k] - path[k - 1]).length());
    }
    let mut mesh = Mesh::default();
    // Seen from outside, columns run around (to the right) and rows along the path (upwards).
    add_grid(&mut mesh, sides + 1, last + 1, |i, k| {
        let normal = frames[k] * profile_point((1.0, 0.0), i, sides);
        let uv = Vec2::new(lengths[k], radius_m * TAU * i as f32 / sides as f32);
        Vertex {
            position: path[k] + normal * radius_m,
            normal,
            uv,
        }
    });
    for (end, outward) in [(0, -1.0), (last, 1.0_f32)] {
        let normal = frames[end] * Vec3::Y * outward;
        add_grid(&mut mesh, sides + 1, 2, |i, j| {
            let rim = (frames[end] * profile_point((1.0, 0.0), i, sides)) * radius_m;
            let offset = if (j == 0) == (outward > 0.0) {
                rim
            } else {
                Vec3::ZERO
            };
            Vertex {
                position: path[end] + offset,
                normal,
                uv: Vec2::new(rim.x, rim.z),
            }
        });
    }
    let colliders = (0..last)
        .map(|k| bar(path[k], path[k + 1], radius_m))
        .collect();
    SolidMesh::new(mesh, colliders)
}

/// A round bar bent to a ring about +Y, in the plane y = 0. It collides as a cylinder for each of eight pieces.
pub fn torus(radius_m: f32, bar_radius_m: f32, segments: usize) -> SolidMesh {
    let sides = 8;
    let mut mesh = Mesh::default();
    add_grid(&mut mesh, segments + 1, sides + 1, |i, j| {
        let outward = profile_point((1.0, 0.0), i, segments);
        let (sin, cos) = math::sin_cos(TAU * (j % sides) as f32 / sides as f32);
        let normal = outward * cos + Vec3::Y * sin;
        let uv = Vec2::new(
            radius_m * TAU * i as f32 / segments as f32,
            bar_radius_m * TAU * j as f32 / sides as f32,
        );
        Vertex {
            position: outward * radius_m + normal * bar_radius_m,
            normal,
            uv,
        }
    });
    let corner = |k: usize| profile_point((radius_m, 0.0), k, 8);
    let colliders = (0..8)
        .map(|k| bar(corner(k), corner(k + 1), bar_radius_m))
        .collect();
    SolidMesh::new(mesh, colliders)
}

fn bar(from: Vec3, to: Vec3, radius: f32) -> Collider {
    let along = to - from;
    let rotation = Quat::from_rotation_arc(Vec3::Y, along.normalize_or(Vec3::Y));
    Collider::Cylinder {
        part_from_cylinder: Pose::new((from + to) * 0.5, rotation),
        half_height: along.length() * 0.5,
        radius,
    }
}
