//! Any house as a GLB file that every viewer opens.
//!
//! Nodes: storeys and the sun; in storeys rooms, in them pieces of the building and objects, in those parts and lights.
//! The meaning of a node beyond its shape is in its `extras.dwell`.

mod extras;
mod lights;
mod materials;
mod meshes;

pub(crate) use meshes::MeshAccessors;

use std::path::Path;

use dwell_scene::{House, HouseData, Id, LevelId, Mobility, RoomId, interrupt};
use glam::Affine3A;
use serde_json::{Value, json};

use super::glb::{GlbBufferBuilder, SidecarFile};
use crate::error::HousesError;
use crate::export_loss::{ExportLoss, ExportLosses};
use crate::import::encode_png;
use meshes::GltfMeshCache;

/// A written house: the file, and the files beside it.
pub(crate) struct WrittenGlb {
    pub(crate) file: Vec<u8>,
    /// Files beside it that its URIs name: what several houses share.
    pub(crate) sidecars: Vec<SidecarFile>,
    pub(crate) meshes: Vec<MeshAccessors>,
}

/// The storage of meshes of objects, and of images.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum AssetStorage {
    /// In the file: it needs nothing beside it.
    Inside,
    /// In files named by their content, in `object/` and `texture/` of the folder two above the file's, so that houses share
    /// them.
    Shared,
}

/// Writes a house as a GLB file, as it stands at the start, and returns what the file does not hold.
///
/// # Errors
/// [`HousesError::NotRepresentable`] beyond the format's 4 GiB, [`HousesError::Io`] when the system refuses.
pub fn write(house: &House, path: &Path) -> Result<Vec<ExportLoss>, HousesError> {
    let unwritable = |message: String| HousesError::NotRepresentable {
        path: path.to_owned(),
        message,
    };
    if !super::recognizes(path) {
        let message = "its name does not end in .glb, by which it is known again";
        return Err(unwritable(message.to_owned()));
    }
    let written = encode(house, AssetStorage::Inside).map_err(unwritable)?;
    crate::atomic::write_file(path, &written.file)?;
    Ok(losses(house))
}

/// Returns the losses for viewers: they may ignore `extras`, which our own reader reads.
fn losses(house: &HouseData) -> Vec<ExportLoss> {
    let mut losses = ExportLosses::default();
    losses.add(
        "rooms; named nodes, told in extras, which our reader reads",
        house.rooms.len(),
    );
    losses.add(
        "joints; parts stand as they start, joints are told in extras, which our reader reads",
        house.joints.len(),
    );
    let moving = house
        .objects
        .iter()
        .filter(|object| object.mobility != Mobility::Fixed)
        .count();
    losses.add(
        "masses and colliders; told in extras, which our reader reads",
        moving,
    );
    losses.add(
        "sound, friction and density of materials; told in extras, which our reader reads",
        house.materials.len(),
    );
    lights::add_light_losses(house, &mut losses);
    losses.add(
        "sound emitters; told in extras, which our reader reads",
        house.emitters.len(),
    );
    losses.add(
        "receptacles; told in extras, which our reader reads",
        house.receptacles.len(),
    );
    losses.add(
        "sound files, and emitters that play them",
        house.sound_files.len(),
    );
    losses.add("agents' starts", house.agent_starts.len());
    losses.into_vec()
}

/// The file's bytes.
pub(crate) fn encode(house: &HouseData, storage: AssetStorage) -> Result<WrittenGlb, String> {
    let mut binary = GlbBufferBuilder::default();
    let mut of_building = vec![false; house.meshes.len()];
    for piece in &house.structure {
        of_building[piece.mesh.index()] = true;
    }
    let stored: Vec<meshes::MeshInFile> = house
        .meshes
        .iter_ids()
        .map(|(id, mesh)| {
            interrupt::unwind_if_cancelled();
            let apart = storage == AssetStorage::Shared && !of_building[id.index()];
            binary.with_buffer("object", apart, |binary| meshes::write_mesh(binary, mesh))
        })
        .collect();
    let images: Vec<Value> = house
        .textures
        .iter()
        .map(|texture| {
            interrupt::unwind_if_cancelled();
            let bytes = encode_png(texture)?;
            let mut image = json!({"mimeType": "image/png", "name": texture.name});
            match storage {
                AssetStorage::Inside => image["bufferView"] = json!(binary.add_buffer_view(&bytes)),
                AssetStorage::Shared => {
                    image["uri"] = json!(binary.add_sidecar("texture", "png", bytes));
                }
            }
            Ok(image)
        })
        .collect::<Result<_, String>>()?;
    let mut tree = NodeTreeBuilder::new(house, GltfMeshCache::new(house, &stored));
    tree.fill();
    let NodeTreeBuilder {
        nodes,
        roots,
        shapes,
        lights,
        ..
    } = tree;
    let mut used = vec!["KHR_texture_transform"];
    let mut document = json!({"asset": {"version": "2.0", "generator": "dwell"}});
    if !lights.is_empty() {
        used.push(lights::EXTENSION);
        document["extensions"] = json!({lights::EXTENSION: {"lights": lights}});
    }
    document["extensionsUsed"] = json!(used);
    // The format forbids empty tables, and scenes without nodes.
    if !nodes.is_empty() {
        document["scene"] = json!(0);
        document["scenes"] = json!([{"name": house.name, "nodes": roots}]);
    }
    let tables = [
        ("nodes", nodes),
        ("meshes", shapes.meshes),
        (
            "materials",
            house.materials.iter().map(materials::material).collect(),
        ),
        (
            "textures",
            (0..images.len()).map(|k| json!({"source": k})).collect(),
        ),
        ("images", images),
    ];
    for (name, table) in tables.into_iter().filter(|(_, table)| !table.is_empty()) {
        document[name] = Value::Array(table);
    }
    let (file, beside) = binary.into_glb(document)?;
    Ok(WrittenGlb {
        file,
        sidecars: beside,
        meshes: stored.into_iter().map(|stored| stored.accessors).collect(),
    })
}

/// The nodes under construction.
struct NodeTreeBuilder<'a> {
    house: &'a HouseData,
    shapes: GltfMeshCache<'a>,
    nodes: Vec<Value>,
    /// Nodes of storeys, and of the sun.
    roots: Vec<usize>,
    /// Lights of the extension.
    lights: Vec<Value>,
    of_level: Vec<usize>,
    of_room: Vec<usize>,
}

impl<'a> NodeTreeBuilder<'a> {
    fn new(house: &'a HouseData, shapes: GltfMeshCache<'a>) -> Self {
        Self {
            house,
            shapes,
            nodes: Vec::new(),
            roots: Vec::new(),
            lights: Vec::new(),
            of_level: Vec::new(),
            of_room: Vec::new(),
        }
    }

    fn fill(&mut self) {
        let house = self.house;
        for level in &house.levels {
            let id = self.add(json!({"name": format!("level_{}", level.name)}), None);
            self.roots.push(id);
            self.of_level.push(id);
        }
        for room in &house.rooms {
            let node = json!({"name": room.name, "extras": extras::room(room)});
            let id = self.add(node, Some(self.of_level[room.level.index()]));
            self.of_room.push(id);
        }
        for piece in &house.structure {
            interrupt::unwind_if_cancelled();
            let mesh = self.shapes.mesh_index(piece.mesh, &piece.materials);
            let node = mesh_node(&piece.name, mesh, None, &extras::structure(piece));
            self.add(node, Some(self.parent_node(piece.level, piece.room)));
        }
        for (id, object) in house.objects.iter_ids() {
            interrupt::unwind_if_cancelled();
            let home = self.parent_node(object.level, object.room);
            let about = extras::object(house, id, object);
            let node = self.add(json!({"name": object.name, "extras": about}), Some(home));
            for part in object.parts().map(|part| &house.parts[part]) {
                interrupt::unwind_if_cancelled();
                let name = if object.part_count == 1 {
                    object.name.clone()
                } else {
                    format!("{}.{}", object.name, part.name)
                };
                let mesh = self.shapes.mesh_index(part.mesh, &part.materials);
                let place = part.world_from_part.to_affine() * part.part_from_mesh;
                self.add(
                    mesh_node(&name, mesh, Some(place), &extras::part(part)),
                    Some(node),
                );
            }
            for light in house.lights.iter().filter(|light| light.object == id) {
                let lamp = lights::light(house, light, self.lights.len());
                self.lights.push(lamp.light);
                self.add(lamp.node, Some(node));
            }
        }
        if let Some(sky) = &house.sky {
            let sun = lights::sun(sky, self.lights.len());
            self.lights.push(sun.light);
            let id = self.add(sun.node, None);
            self.roots.push(id);
        }
    }

    /// The node of a room, or of a storey.
    fn parent_node(&self, level: LevelId, room: Option<RoomId>) -> usize {
        room.map_or_else(
            || self.of_level[level.index()],
            |room| self.of_room[room.index()],
        )
    }

    fn add(&mut self, node: Value, parent: Option<usize>) -> usize {
        let id = self.nodes.len();
        self.nodes.push(node);
        if let Some(parent) = parent {
            match &mut self.nodes[parent]["children"] {
                Value::Array(children) => children.push(json!(id)),
                none => *none = json!([id]),
            }
        }
        id
    }
}

/// A node that shows a mesh.
fn mesh_node(
    name: &str,
    mesh: Option<usize>,
    world_from_mesh: Option<Affine3A>,
    extras: &Value,
) -> Value {
    let mut node = json!({"name": name, "extras": extras});
    if let Some(mesh) = mesh {
        node["mesh"] = json!(mesh);
    }
    if let Some(map) = world_from_mesh.filter(|map| *map != Affine3A::IDENTITY) {
        node["matrix"] = json!(glam::Mat4::from(map).to_cols_array().to_vec());
    }
    node
}
