//! Helpers for meshes and colliders.

use dwell_scene::{Aabb, Collider, Mesh};
use glam::Vec3;
use std::collections::BTreeMap;

/// Returns how many edges of the mesh are not met by as many faces from one side as from the other, vertices at exactly the same
/// place counting as one.
pub fn open_edges(mesh: &Mesh) -> usize {
    let key = |p: Vec3| (p + Vec3::ZERO).to_array().map(f32::to_bits);
    let mut edges: BTreeMap<([u32; 3], [u32; 3]), i32> = BTreeMap::new();
    for triangle in 0..mesh.triangles.len() {
        let corners = mesh.corners(triangle).map(key);
        for k in 0..3 {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            *edges.entry((a.min(b), a.max(b))).or_default() += if a < b { 1 } else { -1 };
        }
    }
    edges.values().filter(|count| **count != 0).count()
}

/// Asks that the mesh is closed.
///
/// # Panics
/// When an edge is open.
pub fn assert_closed(name: &str, mesh: &Mesh) {
    let open = open_edges(mesh);
    assert_eq!(open, 0, "{name}: {open} edges are open");
}

/// The box around collision pieces; `None` without any.
pub fn collider_bounds(colliders: &[Collider]) -> Option<Aabb> {
    let bounds = colliders
        .iter()
        .filter_map(Collider::bounds)
        .fold(Aabb::EMPTY, |all, one| all.union(&one));
    (!bounds.is_empty()).then_some(bounds)
}
