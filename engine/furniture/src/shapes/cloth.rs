//! Cloth: hanging folds, and covers that lie over an edge.

use super::SolidMesh;
use super::grid::{Vertex, add_grid};
use super::smooth::smooth_normals;
use dwell_scene::{Collider, Mesh, math};
use glam::{Vec2, Vec3};
use std::f32::consts::TAU;

/// Thickness of cloth, m.
const CLOTH_M: f32 = 0.004;

/// A curtain that hangs in folds from y = 0 down to `-height_m`, `width_m` wide about x = 0, folds `depth_m` deep about z = 0.
/// It collides as the box around it.
pub fn curtain(width_m: f32, height_m: f32, depth_m: f32, folds: usize) -> SolidMesh {
    let (columns, rows) = (folds * 4 + 1, 3);
    let half = 0.5 * (depth_m - CLOTH_M);
    let sheet = |i: usize, j: usize| {
        let (across, up) = (
            i as f32 / (columns - 1) as f32,
            j as f32 / (rows - 1) as f32,
        );
        // Pleats are tight at the rail and open downwards; a slow wave keeps them from looking ruled.
        let phase = TAU * folds as f32 * across + 0.9 * math::sin(3.1 * across - 0.7 * up);
        let z = half * (1.0 - 0.45 * up) * math::sin(phase) + 0.5 * CLOTH_M;
        Vec3::new(width_m * (across - 0.5), -height_m * (1.0 - up), z)
    };
    let mesh = thick_sheet(columns, rows, sheet, Vec3::Z * CLOTH_M);
    let bounds = mesh.bounds();
    SolidMesh::new(mesh, vec![Collider::cuboid(bounds.min, bounds.max)])
}

/// A blanket over the upper edges of a box: it lies on the plane y = 0 over `width_m` (x) by `depth_m` (z) about the origin
/// and hangs down by `drop_m` outside both x edges and the +z edge, with soft corners. It collides as the sheet on top.
pub fn blanket(width_m: f32, depth_m: f32, drop_m: f32, thickness_m: f32) -> SolidMesh {
    let (x, z) = (0.5 * width_m, 0.5 * depth_m);
    let radius = 2.0 * thickness_m;
    // Along each direction: how far out, and how far down.
    let side = [
        (-1.0_f32, -1.0_f32),
        (-1.0, -0.55),
        (-1.0, -0.12),
        (-0.97, -0.03),
        (-0.92, 0.0),
        (-0.5, 0.0),
        (0.0, 0.0),
    ];
    let mut across: Vec<(f32, f32)> = side.to_vec();
    across.extend(side.iter().rev().skip(1).map(|(s, d)| (-s, *d)));
    let along: Vec<(f32, f32)> = [-1.0, -0.5, 0.0, 0.5]
        .into_iter()
        .map(|s| (s, 0.0))
        .chain([
            (0.92, 0.0),
            (0.97, -0.03),
            (1.0, -0.12),
            (1.0, -0.55),
            (1.0, -1.0),
        ])
        .collect();
    let sheet = |i: usize, j: usize| {
        let ((s, down_x), (t, down_z)) = (across[i], along[along.len() - 1 - j]);
        let down = down_x.min(down_z);
        let wave = 0.004 * math::sin(9.0 * t + 5.0 * s);
        let bulge = if down < -0.05 { 1.0 + radius / x } else { 1.0 };
        Vec3::new(
            s * x * bulge,
            down * drop_m + thickness_m - 0.004 + wave,
            t * z * bulge,
        )
    };
    let mesh = thick_sheet(across.len(), along.len(), sheet, Vec3::Y * thickness_m);
    let top = Collider::cuboid(Vec3::new(-x, 0.0, -z), Vec3::new(x, thickness_m, z));
    SolidMesh::new(mesh, vec![top])
}

/// A closed sheet: the surface through the points, the same surface moved by `-offset` behind it, and the rim between.
pub(super) fn thick_sheet(
    columns: usize,
    rows: usize,
    point: impl Fn(usize, usize) -> Vec3,
    offset: Vec3,
) -> Mesh {
    let uv = |i: usize, j: usize| {
        let width = (point(columns - 1, j) - point(0, j)).length();
        Vec2::new(
            width * i as f32 / (columns - 1) as f32,
            point(i, j).distance(point(i, 0)),
        )
    };
    let mut mesh = Mesh::default();
    add_grid(&mut mesh, columns, rows, |i, j| Vertex {
        position: point(i, j),
        normal: Vec3::Y,
        uv: uv(i, j),
    });
    smooth_normals(&mut mesh);
    let front = mesh.normals.clone();
    add_grid(&mut mesh, columns, rows, |i, j| {
        let i = columns - 1 - i;
        Vertex {
            position: point(i, j) - offset,
            normal: -front[j * columns + i],
            uv: uv(i, j),
        }
    });
    // The rim, once around: bottom, right, top, left, each with its own normals.
    let edges: [Vec<(usize, usize)>; 4] = [
        (0..columns).map(|i| (i, 0)).collect(),
        (0..rows).map(|j| (columns - 1, j)).collect(),
        (0..columns).rev().map(|i| (i, rows - 1)).collect(),
        (0..rows).rev().map(|j| (0, j)).collect(),
    ];
    for edge in edges {
        let at = |k: usize| point(edge[k].0, edge[k].1);
        let last = edge.len() - 1;
        add_grid(&mut mesh, edge.len(), 2, |k, side| {
            let along = at((k + 1).min(last)) - at(k.saturating_sub(1));
            let shift = if side == 0 { -offset } else { Vec3::ZERO };
            let normal = along.cross(offset).normalize_or(Vec3::Y);
            Vertex {
                position: at(k) + shift,
                normal,
                uv: uv(edge[k].0, edge[k].1),
            }
        });
    }
    mesh
}
