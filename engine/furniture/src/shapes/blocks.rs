//! Boxes with sharp and with rounded edges.

use super::SolidMesh;
use super::grid::{Vertex, add_face, add_grid};
use dwell_scene::{Collider, Mesh};
use glam::{Vec2, Vec3};

/// For each side of a box: its outward axis and the axes that run right and up when one looks at it.
pub(super) const SIDES: [[Vec3; 3]; 6] = [
    [Vec3::X, Vec3::NEG_Z, Vec3::Y],
    [Vec3::NEG_X, Vec3::Z, Vec3::Y],
    [Vec3::Y, Vec3::X, Vec3::NEG_Z],
    [Vec3::NEG_Y, Vec3::X, Vec3::Z],
    [Vec3::Z, Vec3::X, Vec3::Y],
    [Vec3::NEG_Z, Vec3::NEG_X, Vec3::Y],
];

/// A box with sharp edges between two corners, m.
pub fn block(min: [f32; 3], max: [f32; 3]) -> SolidMesh {
    let (min, max) = (Vec3::from(min), Vec3::from(max));
    let (center, half) = ((min + max) * 0.5, (max - min) * 0.5);
    let mut mesh = Mesh::default();
    for [axis, right, up] in SIDES {
        let corner = |r: f32, u: f32| {
            // Picked from the two corners, so that neighbouring faces meet exactly.
            let toward = axis + right * r + up * u;
            Vec3::select(toward.cmpgt(Vec3::ZERO), max, min)
        };
        let corners = [
            corner(-1.0, -1.0),
            corner(1.0, -1.0),
            corner(1.0, 1.0),
            corner(-1.0, 1.0),
        ];
        let along = if half.dot(right.abs()) >= half.dot(up.abs()) {
            right
        } else {
            up
        };
        add_face(&mut mesh, &corners, along);
    }
    SolidMesh::new(mesh, vec![Collider::cuboid(center - half, center + half)])
}

/// A box with rounded edges between two corners, m; `steps` faces make a quarter of a round edge. It collides as the
/// sharp box.
pub fn rounded_block(min: [f32; 3], max: [f32; 3], radius_m: f32, steps: usize) -> SolidMesh {
    let (min, max) = (Vec3::from(min), Vec3::from(max));
    let (center, half) = ((min + max) * 0.5, (max - min) * 0.5);
    let radius = radius_m.min(half.min_element() * 0.98);
    let inner = half - radius;
    let mut mesh = Mesh::default();
    let count = 2 * steps + 2;
    // Distance of grid line `k` from the middle: `steps` lines in each rounded border, spaced by equal angles.
    let line = |k: usize, half: f32| {
        let border = |j: usize| {
            radius * dwell_scene::math::tan(std::f32::consts::FRAC_PI_4 * j as f32 / steps as f32)
        };
        // The ends are exact, so that neighbouring sides meet.
        if k == 0 {
            -half
        } else if k == count - 1 {
            half
        } else if k <= steps {
            -(half - radius + border(steps - k))
        } else {
            half - radius + border(k - steps - 1)
        }
    };
    for [axis, right, up] in SIDES {
        let (half_r, half_u) = (half.dot(right.abs()), half.dot(up.abs()));
        let swap = half_u > half_r;
        add_grid(&mut mesh, count, count, |i, j| {
            let (r, u) = (line(i, half_r), line(j, half_u));
            let on_box = axis * half.dot(axis.abs()) + right * r + up * u;
            let core = on_box.clamp(-inner, inner);
            let normal = (on_box - core).normalize_or_zero();
            let uv = if swap {
                Vec2::new(u, -r)
            } else {
                Vec2::new(r, u)
            };
            Vertex {
                position: center + core + normal * radius,
                normal,
                uv,
            }
        });
    }
    SolidMesh::new(mesh, vec![Collider::cuboid(min, max)])
}
