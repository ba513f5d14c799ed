//! Surfaces from rectangular grids of points.

use dwell_scene::Mesh;
use glam::{Vec2, Vec3};

/// One vertex of a surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vertex {
    /// m.
    pub position: Vec3,
    /// Unit length.
    pub normal: Vec3,
    /// m.
    pub uv: Vec2,
}

/// Appends the surface through `columns` by `rows` vertices. It faces the side from which the columns run to the right and
/// the rows upwards. Triangles without area are left out.
pub(super) fn add_grid(
    mesh: &mut Mesh,
    columns: usize,
    rows: usize,
    vertex: impl Fn(usize, usize) -> Vertex,
) {
    let base = mesh.positions.len() as u32;
    for row in 0..rows {
        for column in 0..columns {
            let Vertex {
                position,
                normal,
                uv,
            } = vertex(column, row);
            mesh.positions.push(position);
            mesh.normals.push(normal);
            mesh.uvs.push(uv);
        }
    }
    let at = |column: usize, row: usize| base + (row * columns + column) as u32;
    for row in 1..rows {
        for column in 1..columns {
            let [a, b] = [at(column - 1, row - 1), at(column, row - 1)];
            let [c, d] = [at(column, row), at(column - 1, row)];
            add_triangle(mesh, [a, b, c]);
            add_triangle(mesh, [a, c, d]);
        }
    }
}

/// Appends a triangle unless two of its corners stand at the same place.
pub(super) fn add_triangle(mesh: &mut Mesh, triangle: [u32; 3]) {
    let [a, b, c] = triangle.map(|vertex| mesh.positions[vertex as usize]);
    if a != b && b != c && c != a {
        mesh.triangles.push(triangle);
    }
}

/// Appends a flat polygon, convex, corners counter-clockwise seen from the front; u runs along `u_axis`.
pub(super) fn add_face(mesh: &mut Mesh, corners: &[Vec3], u_axis: Vec3) {
    let normal = (corners[1] - corners[0])
        .cross(corners[2] - corners[0])
        .normalize_or_zero();
    let v_axis = normal.cross(u_axis);
    let base = mesh.positions.len() as u32;
    for corner in corners {
        mesh.positions.push(*corner);
        mesh.normals.push(normal);
        mesh.uvs
            .push(Vec2::new(corner.dot(u_axis), corner.dot(v_axis)));
    }
    for k in 2..corners.len() as u32 {
        mesh.triangles.push([base, base + k - 1, base + k]);
    }
}
