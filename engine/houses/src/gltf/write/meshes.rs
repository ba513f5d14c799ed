//! Meshes as accessors, and as meshes of the file.

use std::collections::BTreeMap;

use dwell_scene::{HouseData, Id, MaterialId, Mesh, MeshId};
use glam::{Vec2, Vec3};
use serde_json::{Value, json};

use super::super::glb::{GlbBufferBuilder, UNSIGNED_INT, UNSIGNED_SHORT};

/// The accessors of a mesh in the file.
#[derive(
    Debug, Clone, Default, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize,
)]
#[serde(deny_unknown_fields)]
pub(crate) struct MeshAccessors {
    /// Vertices, each three floats; `None` for a mesh without vertices.
    pub(crate) positions: Option<usize>,
    /// One for each vertex.
    pub(crate) normals: Option<usize>,
    /// One for each vertex, v upwards.
    pub(crate) uvs: Option<usize>,
    /// Three indices for each triangle.
    pub(crate) triangles: Option<usize>,
    /// One for each triangle.
    pub(crate) slots: Option<usize>,
}

/// A mesh in the file.
pub(super) struct MeshInFile {
    pub(super) accessors: MeshAccessors,
    /// The indices of each slot in use.
    by_slot: Vec<(u16, usize)>,
}

/// Writes the numbers of a mesh.
pub(super) fn write_mesh(binary: &mut GlbBufferBuilder, mesh: &Mesh) -> MeshInFile {
    let some = |count: usize| (count > 0).then_some(());
    let positions = some(mesh.positions.len()).map(|()| {
        binary.add_float_accessor(mesh.positions.iter().map(Vec3::to_array), "VEC3", true)
    });
    let normals = some(mesh.normals.len()).map(|()| {
        binary.add_float_accessor(mesh.normals.iter().map(Vec3::to_array), "VEC3", false)
    });
    let uvs = some(mesh.uvs.len())
        .map(|()| binary.add_float_accessor(mesh.uvs.iter().map(Vec2::to_array), "VEC2", false));
    let triangles = some(mesh.triangles.len())
        .map(|()| add_index_accessor(binary, mesh.triangles.iter().copied()));
    let slots = some(mesh.slots.len()).map(|()| {
        let bytes: Vec<u8> = mesh
            .slots
            .iter()
            .flat_map(|slot| slot.to_le_bytes())
            .collect();
        let view = binary.add_buffer_view(&bytes);
        binary.add_accessor(view, 0, UNSIGNED_SHORT, mesh.slots.len(), "SCALAR")
    });
    let groups = groups(mesh);
    let by_slot = match (groups.len(), triangles) {
        // One slot shows all triangles.
        (1, Some(all)) => groups.keys().map(|slot| (*slot, all)).collect(),
        _ => groups
            .into_iter()
            .map(|(slot, triangles)| {
                let of_slot = triangles.iter().map(|k| mesh.triangles[*k]);
                (slot, add_index_accessor(binary, of_slot))
            })
            .collect(),
    };
    MeshInFile {
        accessors: MeshAccessors {
            positions,
            normals,
            uvs,
            triangles,
            slots,
        },
        by_slot,
    }
}

fn add_index_accessor(
    binary: &mut GlbBufferBuilder,
    triangles: impl Iterator<Item = [u32; 3]>,
) -> usize {
    let bytes: Vec<u8> = triangles.flatten().flat_map(u32::to_le_bytes).collect();
    let view = binary.add_buffer_view(&bytes);
    binary.add_accessor(view, 0, UNSIGNED_INT, bytes.len() / 4, "SCALAR")
}

/// The triangles of each slot in use.
fn groups(mesh: &Mesh) -> BTreeMap<u16, Vec<usize>> {
    let mut slots: BTreeMap<u16, Vec<usize>> = BTreeMap::new();
    for k in 0..mesh.triangles.len() {
        slots.entry(mesh.slot(k)).or_default().push(k);
    }
    slots
}

/// glTF binds materials to meshes where we bind them to instances: a mesh of the file for each pair in use.
pub(super) struct GltfMeshCache<'a> {
    house: &'a HouseData,
    stored: &'a [MeshInFile],
    known: BTreeMap<(MeshId, &'a [MaterialId]), usize>,
    /// The meshes of the file.
    pub(super) meshes: Vec<Value>,
}

impl<'a> GltfMeshCache<'a> {
    pub(super) fn new(house: &'a HouseData, stored: &'a [MeshInFile]) -> Self {
        Self {
            house,
            stored,
            known: BTreeMap::new(),
            meshes: Vec::new(),
        }
    }

    /// The mesh of the file; `None` when it has no triangle.
    pub(super) fn mesh_index(&mut self, id: MeshId, materials: &'a [MaterialId]) -> Option<usize> {
        if let Some(known) = self.known.get(&(id, materials)) {
            return Some(*known);
        }
        let MeshInFile { accessors, by_slot } = &self.stored[id.index()];
        let (Some(positions), Some(_)) = (accessors.positions, accessors.triangles) else {
            return None;
        };
        let mesh = &self.house.meshes[id];
        let mut attributes = json!({"POSITION": positions});
        // Only whole attributes: the format wants as many normals as vertices.
        if let Some(normals) = accessors
            .normals
            .filter(|_| mesh.normals.len() == mesh.positions.len())
        {
            attributes["NORMAL"] = json!(normals);
        }
        if let Some(uvs) = accessors
            .uvs
            .filter(|_| mesh.uvs.len() == mesh.positions.len())
        {
            attributes["TEXCOORD_0"] = json!(uvs);
        }
        let primitives: Vec<Value> = by_slot
            .iter()
            .map(|(slot, indices)| {
                let mut primitive = json!({"attributes": attributes, "indices": indices});
                if let Some(material) = materials.get(usize::from(*slot)) {
                    primitive["material"] = json!(material.index());
                }
                primitive
            })
            .collect();
        self.meshes.push(json!({"primitives": primitives}));
        self.known.insert((id, materials), self.meshes.len() - 1);
        Some(self.meshes.len() - 1)
    }
}
