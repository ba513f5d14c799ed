//! Any house as a GLB file that every viewer opens.

use std::collections::BTreeMap;
use std::path::Path;

use dwell_scene::{House, HouseData, Id, Material, MaterialId, Mesh, MeshId, Mobility};
use glam::{Affine3A, Vec2, Vec3};
use serde_json::{Value, json};

use super::glb::{Binary, UNSIGNED_INT, UNSIGNED_SHORT};
use crate::build::encode_png;
use crate::error::HousesError;
use crate::loss::{Loss, Losses};

/// Where the numbers of a mesh stand in the file: accessors.
#[derive(Debug, Clone, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
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

/// A written house: the file, and where its tables went.
pub(crate) struct Written {
    pub(crate) file: Vec<u8>,
    pub(crate) meshes: Vec<MeshAccessors>,
}

/// Writes a house as a GLB file, as it stands at the start, and returns what the file does not hold.
///
/// # Errors
/// [`HousesError::Unwritable`] beyond the format's 4 GiB, [`HousesError::Io`] when the system refuses.
pub fn write(house: &House, path: &Path) -> Result<Vec<Loss>, HousesError> {
    let written = encode(house).map_err(|message| HousesError::Unwritable {
        path: path.to_owned(),
        message,
    })?;
    crate::atomic::write_file(path, &written.file)?;
    Ok(losses(house))
}

fn losses(house: &HouseData) -> Vec<Loss> {
    let mut losses = Losses::default();
    losses.add("rooms; their floors become one room", house.rooms.len());
    losses.add(
        "categories beyond what the object's name says",
        house
            .objects
            .iter()
            .filter(|o| !o.category.fine.is_empty())
            .count(),
    );
    losses.add("joints; parts stand as they start", house.joints.len());
    let moving = house
        .objects
        .iter()
        .filter(|object| object.mobility != Mobility::Fixed)
        .count();
    losses.add("masses and colliders", moving);
    losses.add(
        "sound and density of materials beyond what the name says",
        house.materials.len(),
    );
    losses.add("lights", house.lights.len());
    losses.add("sound emitters", house.emitters.len());
    losses.add("receptacles", house.receptacles.len());
    losses.into_vec()
}

/// The file's bytes.
pub(crate) fn encode(house: &HouseData) -> Result<Written, String> {
    let mut binary = Binary::default();
    let meshes: Vec<MeshAccessors> = house
        .meshes
        .iter()
        .map(|mesh| mesh_accessors(&mut binary, mesh))
        .collect();
    let images: Vec<Value> = house
        .textures
        .iter()
        .map(|texture| {
            let view = binary.view(&encode_png(texture)?);
            Ok(json!({"bufferView": view, "mimeType": "image/png", "name": texture.name}))
        })
        .collect::<Result<_, String>>()?;
    let mut shapes = Shapes {
        house,
        accessors: &meshes,
        known: BTreeMap::new(),
        meshes: Vec::new(),
    };
    let mut nodes = Vec::new();
    for piece in &house.structure {
        let mesh = shapes.mesh(&mut binary, piece.mesh, &piece.materials);
        nodes.push(node(&piece.name, mesh, None));
    }
    for object in &house.objects {
        for part in object.parts().map(|part| &house.parts[part]) {
            let name = if object.part_count == 1 {
                object.name.clone()
            } else {
                format!("{}.{}", object.name, part.name)
            };
            let mesh = shapes.mesh(&mut binary, part.mesh, &part.materials);
            nodes.push(node(
                &name,
                mesh,
                Some(part.world_from_part.to_affine() * part.part_from_mesh),
            ));
        }
    }
    let mut document = json!({
        "asset": {"version": "2.0", "generator": "dwell"},
        "extensionsUsed": ["KHR_texture_transform"],
    });
    // The format forbids empty tables, and scenes without nodes.
    if !nodes.is_empty() {
        let node_ids: Vec<usize> = (0..nodes.len()).collect();
        document["scene"] = json!(0);
        document["scenes"] = json!([{"name": house.name, "nodes": node_ids}]);
    }
    let tables = [
        ("nodes", nodes),
        ("meshes", shapes.meshes),
        ("materials", house.materials.iter().map(material).collect()),
        (
            "textures",
            (0..images.len()).map(|k| json!({"source": k})).collect(),
        ),
        ("images", images),
    ];
    for (name, table) in tables.into_iter().filter(|(_, table)| !table.is_empty()) {
        document[name] = Value::Array(table);
    }
    Ok(Written {
        file: binary.into_glb(document)?,
        meshes,
    })
}

fn mesh_accessors(binary: &mut Binary, mesh: &Mesh) -> MeshAccessors {
    let some = |count: usize| (count > 0).then_some(());
    let positions = some(mesh.positions.len())
        .map(|()| binary.floats(mesh.positions.iter().map(Vec3::to_array), "VEC3", true));
    let normals = some(mesh.normals.len())
        .map(|()| binary.floats(mesh.normals.iter().map(Vec3::to_array), "VEC3", false));
    let uvs = some(mesh.uvs.len())
        .map(|()| binary.floats(mesh.uvs.iter().map(Vec2::to_array), "VEC2", false));
    let triangles = some(mesh.triangles.len()).map(|()| {
        let bytes: Vec<u8> = mesh
            .triangles
            .iter()
            .flatten()
            .flat_map(|index| index.to_le_bytes())
            .collect();
        let view = binary.view(&bytes);
        binary.accessor(view, 0, UNSIGNED_INT, mesh.triangles.len() * 3, "SCALAR")
    });
    let slots = some(mesh.slots.len()).map(|()| {
        let bytes: Vec<u8> = mesh
            .slots
            .iter()
            .flat_map(|slot| slot.to_le_bytes())
            .collect();
        let view = binary.view(&bytes);
        binary.accessor(view, 0, UNSIGNED_SHORT, mesh.slots.len(), "SCALAR")
    });
    MeshAccessors {
        positions,
        normals,
        uvs,
        triangles,
        slots,
    }
}

fn node(name: &str, mesh: Option<usize>, world_from_mesh: Option<Affine3A>) -> Value {
    let mut node = json!({"name": name});
    if let Some(mesh) = mesh {
        node["mesh"] = json!(mesh);
    }
    if let Some(map) = world_from_mesh.filter(|map| *map != Affine3A::IDENTITY) {
        node["matrix"] = json!(glam::Mat4::from(map).to_cols_array().to_vec());
    }
    node
}

fn material(material: &Material) -> Value {
    let [r, g, b] = material.base_color;
    let mut pbr = json!({
        "baseColorFactor": [r, g, b, material.opacity],
        "metallicFactor": material.metallic,
        "roughnessFactor": material.roughness,
    });
    if let Some(texture) = material.texture {
        // Our v counts upwards, glTF's downwards: the view is turned over, the numbers stay as they are.
        let turned = json!({"KHR_texture_transform": {"offset": [0.0, 1.0], "scale": [1.0, -1.0]}});
        pbr["baseColorTexture"] = json!({"index": texture.index(), "extensions": turned});
    }
    let mut value =
        json!({"name": material.name, "pbrMetallicRoughness": pbr, "doubleSided": true});
    if material.opacity < 1.0 {
        value["alphaMode"] = json!("BLEND");
    }
    if material.emission.iter().any(|e| *e > 0.0) {
        // The format caps emission at 1.
        value["emissiveFactor"] = json!(material.emission.map(|e| e.min(1.0)));
    }
    value
}

/// glTF binds materials to meshes where we bind them to instances: a mesh of the file for each pair in use.
struct Shapes<'a> {
    house: &'a HouseData,
    accessors: &'a [MeshAccessors],
    known: BTreeMap<(MeshId, &'a [MaterialId]), usize>,
    meshes: Vec<Value>,
}

impl<'a> Shapes<'a> {
    /// The mesh of the file; `None` when it has no triangle.
    fn mesh(
        &mut self,
        binary: &mut Binary,
        id: MeshId,
        materials: &'a [MaterialId],
    ) -> Option<usize> {
        if let Some(known) = self.known.get(&(id, materials)) {
            return Some(*known);
        }
        let mesh = &self.house.meshes[id];
        let accessors = &self.accessors[id.index()];
        let (Some(positions), Some(_)) = (accessors.positions, accessors.triangles) else {
            return None;
        };
        let mut attributes = json!({"POSITION": positions});
        if let Some(normals) = accessors.normals {
            attributes["NORMAL"] = json!(normals);
        }
        if let Some(uvs) = accessors.uvs {
            attributes["TEXCOORD_0"] = json!(uvs);
        }
        let primitives: Vec<Value> = by_slot(mesh)
            .into_iter()
            .map(|(slot, triangles)| {
                let bytes: Vec<u8> = triangles
                    .iter()
                    .flat_map(|k| mesh.triangles[*k])
                    .flat_map(u32::to_le_bytes)
                    .collect();
                let view = binary.view(&bytes);
                let indices = binary.accessor(view, 0, UNSIGNED_INT, triangles.len() * 3, "SCALAR");
                let mut primitive = json!({"attributes": attributes, "indices": indices});
                if let Some(material) = materials.get(usize::from(slot)) {
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

/// The triangles of each slot in use.
fn by_slot(mesh: &Mesh) -> BTreeMap<u16, Vec<usize>> {
    let mut slots: BTreeMap<u16, Vec<usize>> = BTreeMap::new();
    for k in 0..mesh.triangles.len() {
        slots.entry(mesh.slot(k)).or_default().push(k);
    }
    slots
}
