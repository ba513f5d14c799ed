//! Normals of curved meshes.

use dwell_scene::Mesh;
use glam::Vec3;
use std::collections::BTreeMap;

/// Sets each vertex's normal to the mean of the faces that meet at its place, weighted by area.
pub(super) fn smooth_normals(mesh: &mut Mesh) {
    // Adding 0 makes -0 and 0 one place.
    let key = |p: Vec3| (p + Vec3::ZERO).to_array().map(f32::to_bits);
    let mut sums: BTreeMap<[u32; 3], Vec3> = BTreeMap::new();
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|vertex| mesh.positions[vertex as usize]);
        let area = (b - a).cross(c - a);
        for corner in [a, b, c] {
            *sums.entry(key(corner)).or_default() += area;
        }
    }
    mesh.normals = mesh
        .positions
        .iter()
        .map(|p| {
            sums.get(&key(*p))
                .map_or(Vec3::Y, |sum| sum.normalize_or(Vec3::Y))
        })
        .collect();
}
