//! Helpers of the tests.

use dwell_scene::{Aabb, House, Mesh};
use glam::Vec3;
use std::sync::OnceLock;

/// The apartment, built once for all tests.
pub(crate) fn apartment() -> &'static House {
    static HOUSE: OnceLock<House> = OnceLock::new();
    HOUSE
        .get_or_init(|| crate::builtin::build("apartment").expect("the apartment is a valid house"))
}

/// The building as boxes, from its meshes alone: whatever lies inside their closed surfaces, cut at all their corners.
pub(crate) fn building_boxes(house: &House) -> Vec<Aabb> {
    let meshes = house
        .structure
        .iter()
        .map(|piece| &house.meshes[piece.mesh]);
    meshes.flat_map(|mesh| solid_boxes(mesh)).collect()
}

/// All faces of the mesh stand square to the axes.
fn solid_boxes(mesh: &Mesh) -> Vec<Aabb> {
    let lines = [0, 1, 2].map(|axis| {
        let mut lines: Vec<f32> = mesh.positions.iter().map(|p| p[axis]).collect();
        lines.sort_by(f32::total_cmp);
        lines.dedup_by(|a, b| (*a - *b).abs() < 1e-4);
        lines
    });
    let [x, y, z] = &lines;
    let mut boxes = Vec::new();
    for a in x.windows(2) {
        for b in y.windows(2) {
            for c in z.windows(2) {
                let cell = Aabb::new(Vec3::new(a[0], b[0], c[0]), Vec3::new(a[1], b[1], c[1]));
                // Beside the middle, where the diagonals of faces cross.
                if is_inside(mesh, cell.min + cell.size() * Vec3::new(0.37, 0.53, 0.59)) {
                    boxes.push(cell);
                }
            }
        }
    }
    boxes
}

/// Returns whether an odd number of faces lies above a point.
fn is_inside(mesh: &Mesh, point: Vec3) -> bool {
    let above = mesh.triangles.iter().filter(|triangle| {
        let corners = triangle.map(|k| mesh.positions[k as usize] - point);
        let side = |a: Vec3, b: Vec3| a.x * b.z - a.z * b.x;
        let [a, b, c] = corners;
        let sides = [side(a, b), side(b, c), side(c, a)];
        let around = sides.iter().all(|s| *s > 0.0) || sides.iter().all(|s| *s < 0.0);
        let total: f32 = sides.iter().sum();
        // The height where the vertical line meets the face.
        around && (sides[1] * a.y + sides[2] * b.y + sides[0] * c.y) / total > 0.0
    });
    above.count() % 2 == 1
}
