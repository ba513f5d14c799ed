//! Bodies through a stack of outlines: bowls, garments.

use super::SolidMesh;
use super::grid::{Vertex, add_grid, add_triangle};
use super::smooth::smooth_normals;
use dwell_scene::{Collider, Mesh};
use glam::{Vec2, Vec3};

/// The body through `rings` from below: outlines of equally many points, counter-clockwise seen from above, each convex and
/// level. Flat below and above. It collides as a hull between each two neighbours.
pub fn loft(rings: &[Vec<Vec3>]) -> SolidMesh {
    let count = rings.first().map_or(0, Vec::len);
    let mut mesh = Mesh::default();
    let ring_at = |i: usize, j: usize| rings[j][i % count];
    add_grid(&mut mesh, count + 1, rings.len(), |i, j| {
        let position = ring_at(i, j);
        Vertex {
            position,
            normal: Vec3::Y,
            uv: Vec2::new(position.x + position.z, position.y),
        }
    });
    smooth_normals(&mut mesh);
    for (level, up) in [(0, false), (rings.len() - 1, true)] {
        let base = mesh.positions.len() as u32;
        for position in &rings[level] {
            mesh.positions.push(*position);
            mesh.normals.push(if up { Vec3::Y } else { Vec3::NEG_Y });
            mesh.uvs.push(Vec2::new(position.x, position.z));
        }
        for k in 2..count as u32 {
            let corners = if up {
                [base, base + k - 1, base + k]
            } else {
                [base, base + k, base + k - 1]
            };
            add_triangle(&mut mesh, corners);
        }
    }
    // Every second corner does for a hull.
    let some = |ring: &[Vec3]| ring.iter().copied().step_by(2).collect::<Vec<_>>();
    let colliders = rings
        .windows(2)
        .map(|pair| Collider::Hull {
            points: [some(&pair[0]), some(&pair[1])].concat(),
        })
        .collect();
    SolidMesh::new(mesh, colliders)
}

/// A level oval with flat sides about (0, `y`, `z`): half widths along x and z, `sides` corners.
pub fn oval(half_x: f32, half_z: f32, y: f32, z: f32, sides: usize) -> Vec<Vec3> {
    (0..sides)
        .map(|k| {
            let p = super::revolve::profile_point((1.0, 0.0), k, sides);
            // A superellipse of exponent 2.6.
            let grow = dwell_scene::math::pow(
                dwell_scene::math::pow(p.x.abs(), 2.6) + dwell_scene::math::pow(p.z.abs(), 2.6),
                -1.0 / 2.6,
            );
            Vec3::new(p.x * grow * half_x, y, z + p.z * grow * half_z)
        })
        .collect()
}
