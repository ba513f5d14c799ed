//! Upholstery: cushions and pillows.

use super::SolidMesh;
use super::blocks::SIDES;
use super::grid::{Vertex, add_grid};
use super::smooth::smooth_normals;
use dwell_scene::{Collider, Mesh, math};
use glam::{Vec2, Vec3};

/// Grid lines along each edge of a pillow.
const LINES: usize = 9;
/// Grid lines along each edge of a cushion: a sofa has six.
const CUSHION_LINES: usize = 6;

/// Grid line `k` of `count` in -1 to 1: denser towards the rims, exactly symmetric.
fn grid_coordinate(k: usize, count: usize) -> f32 {
    let t = (2.0 * k as f32 - (count - 1) as f32) / (count - 1) as f32;
    t * (1.5 - 0.5 * t * t)
}

/// A seat cushion between two corners: a superellipsoid, nearly a box. It collides as the box.
pub fn cushion(min: [f32; 3], max: [f32; 3]) -> SolidMesh {
    let (min, max) = (Vec3::from(min), Vec3::from(max));
    let (center, half) = ((min + max) * 0.5, (max - min) * 0.5);
    let mut mesh = Mesh::default();
    // The points of a cube, pulled in to |x|^8 + |y|^8 + |z|^8 = 1.
    for [axis, right, up] in SIDES {
        add_grid(&mut mesh, CUSHION_LINES, CUSHION_LINES, |i, j| {
            let at = |k| grid_coordinate(k, CUSHION_LINES);
            let cube = axis + right * at(i) + up * at(j);
            let power = |x: f32, n: f32| math::pow(x.abs(), n);
            let round = power(cube.x, 8.0) + power(cube.y, 8.0) + power(cube.z, 8.0);
            let on_unit = cube * math::pow(round, -1.0 / 8.0);
            let position = center + half * on_unit;
            let uv = Vec2::new(position.dot(right), position.dot(up));
            Vertex {
                position,
                normal: axis,
                uv,
            }
        });
    }
    smooth_normals(&mut mesh);
    SolidMesh::new(mesh, vec![Collider::cuboid(min, max)])
}

/// A pillow that lies on the origin's plane: `size_m` (x, thickness, z); thin rims, a bulging middle.
pub fn pillow(size_m: [f32; 3]) -> SolidMesh {
    let [width, height, depth] = size_m;
    let place = |s: f32, t: f32, side: f32| {
        let fall = |x: f32| (1.0 - x * x * x * x).max(0.0);
        let bulge = math::pow(fall(s) * fall(t), 0.45);
        // The sides curve in between the corners.
        let pull = |x: f32| 1.0 - 0.06 * (1.0 - x * x);
        let (x, z) = (0.5 * width * s * pull(t), 0.5 * depth * t * pull(s));
        Vec3::new(x, height * 0.5 * (1.0 + side * bulge), z)
    };
    let mut mesh = Mesh::default();
    for side in [1.0_f32, -1.0] {
        add_grid(&mut mesh, LINES, LINES, |i, j| {
            let (s, t) = (grid_coordinate(i, LINES), -side * grid_coordinate(j, LINES));
            let position = place(s, t, side);
            Vertex {
                position,
                normal: Vec3::Y,
                uv: Vec2::new(position.x, position.z),
            }
        });
    }
    smooth_normals(&mut mesh);
    // Flat above and below, so that it rests on four corners and others rest on it.
    let square = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let mut points = Vec::new();
    for (y, side) in [(0.0, -1.0), (height, 1.0)] {
        points.extend(square.map(|(s, t)| place(0.5 * s, 0.5 * t, side).with_y(y)));
    }
    points.extend(
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(s, t)| place(s, t, 0.0)),
    );
    SolidMesh::new(mesh, vec![Collider::Hull { points }])
}
