//! Merging of meshes.

use std::sync::Arc;

use dwell_scene::{MaterialId, Mesh};
use glam::Vec2;

/// Meshes with their materials as one mesh with a slot for each material. Where one has no normals, none has; those without
/// texture coordinates show the image's corner.
pub(crate) fn merge_meshes(pieces: &[(Arc<Mesh>, Vec<MaterialId>)]) -> (Mesh, Vec<MaterialId>) {
    let mut mesh = Mesh::default();
    let mut materials: Vec<MaterialId> = Vec::new();
    let flat = pieces.iter().any(|(piece, _)| piece.normals.is_empty());
    let bare = pieces.iter().all(|(piece, _)| piece.uvs.is_empty());
    for (piece, own) in pieces {
        let mut part = Mesh::clone(piece);
        if flat {
            part.normals.clear();
        }
        if !bare {
            part.uvs.resize(part.positions.len(), Vec2::ZERO);
        }
        let slots: Vec<u16> = own
            .iter()
            .map(|id| {
                let known = materials.iter().position(|other| other == id);
                known.unwrap_or_else(|| {
                    materials.push(*id);
                    materials.len() - 1
                }) as u16
            })
            .collect();
        let last = slots.first().copied().unwrap_or(0);
        part.slots = (0..part.triangles.len())
            .map(|k| {
                let slot = slots.get(usize::from(part.slot(k)));
                slot.copied().unwrap_or(last)
            })
            .collect();
        mesh.append(&part, 0);
    }
    (mesh, materials)
}
