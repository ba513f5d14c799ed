//! A small data set in Habitat's form, of our own making: a room, blocks, a vase, a cupboard with a door.

use std::path::{Path, PathBuf};

use dwell_scene::{House, Mesh, ShoeboxMaterials};
use glam::Vec3;

/// The scene's file in the data set.
pub(crate) const SCENE: &str = "room.scene_instance.json";

const DATASET: &str = r#"{
  "stages": {"paths": {".json": ["stages"]}},
  "objects": {
    "default_attributes": {"mass": 3.0},
    "paths": {".json": ["objects/*"]},
    "configs": [{"original_file": "objects/b/block.object_config.json", "template_handle": "heavy_block", "attributes": {"mass": 20.0}}]
  },
  "articulated_objects": {"paths": {".urdf": ["urdf/*"]}},
  "semantic_scene_descriptor_instances": {
    "default_attributes": {"semantic_descriptor_filename": "../lexicon.json"},
    "paths": {".json": ["semantics/*"]}
  }
}"#;

const SCENE_TEXT: &str = r#"{
  "stage_instance": {"template_name": "stages/room"},
  "translation_origin": "asset_local",
  "default_lighting": "",
  "object_instances": [
    {"template_name": "block", "translation": [1.0, 0.0, 2.0], "motion_type": "DYNAMIC"},
    {"template_name": "block", "translation": [2.0, 1.0, 1.0], "rotation": [0.7071068, 0.0, 0.7071068, 0.0],
     "non_uniform_scale": [2.0, 1.0, 1.0], "motion_type": "STATIC"},
    {"template_name": "heavy_block", "translation": [4.0, 0.3, 2.0], "translation_origin": "COM", "motion_type": "DYNAMIC"},
    {"template_name": "my_vase_01", "translation": [4.5, 0.0, 1.0], "uniform_scale": 0.5, "apply_scale_to_mass": true,
     "motion_type": "DYNAMIC"}
  ],
  "articulated_object_instances": [
    {"template_name": "cupboard", "translation": [5.0, 0.0, 0.5], "rotation": [0.7071068, 0.0, 0.7071068, 0.0],
     "fixed_base": true, "initial_joint_pose": {"hinge": 0.5}}
  ]
}"#;

/// Like those of `ReplicaCAD`, in Habitat's axes: +Y up.
const CUPBOARD: &str = r#"<robot name="cupboard">
  <link name="body">
    <visual><origin xyz="0 0.5 0"/><geometry><box size="0.6 1 0.4"/></geometry></visual>
    <collision><origin xyz="0 0.5 0"/><geometry><box size="0.6 1 0.4"/></geometry></collision>
  </link>
  <link name="leaf">
    <inertial><origin xyz="0.3 0.5 0"/><mass value="4"/><inertia ixx="0.3" iyy="0.1" izz="0.3"/></inertial>
    <visual><origin xyz="0.3 0.5 0"/><geometry><box size="0.6 1 0.02"/></geometry></visual>
    <collision><origin xyz="0.3 0.5 0"/><geometry><box size="0.6 1 0.02"/></geometry></collision>
  </link>
  <joint name="hinge" type="revolute">
    <parent link="body"/><child link="leaf"/><origin xyz="-0.3 0 0.22"/><axis xyz="0 1 0"/>
    <limit lower="-1.6" upper="0.1" effort="0" velocity="0"/>
  </joint>
</robot>"#;

const REGIONS: &str = r#"{"region_annotations": [
  {"name": "bedroom_0", "label": "bedroom", "poly_loop": [[0,0,0],[3,0,0],[3,0,4],[0,0,4]], "floor_height": 0.0, "extrusion_height": 2.5},
  {"name": "hall_0", "label": "hallway/lobby", "poly_loop": [[3,0,0],[6,0,0],[6,0,4],[3,0,4]], "floor_height": 0.0, "extrusion_height": 2.5}
]}"#;

/// A box as glTF text with its buffer in it.
fn box_gltf(name: &str, min: Vec3, max: Vec3) -> String {
    mesh_gltf(name, &Mesh::cuboid(min, max))
}

/// The same, seen from inside: a room without names.
pub(crate) fn inside_of_a_box(name: &str, min: Vec3, max: Vec3) -> String {
    let mut mesh = Mesh::cuboid(min, max);
    mesh.triangles
        .iter_mut()
        .for_each(|triangle| triangle.swap(1, 2));
    mesh_gltf(name, &mesh)
}

fn mesh_gltf(name: &str, mesh: &Mesh) -> String {
    let mut bytes: Vec<u8> = Vec::new();
    for position in &mesh.positions {
        bytes.extend(position.to_array().into_iter().flat_map(f32::to_le_bytes));
    }
    let split = bytes.len();
    for triangle in &mesh.triangles {
        bytes.extend(
            triangle
                .iter()
                .flat_map(|vertex| (*vertex as u16).to_le_bytes()),
        );
    }
    let (vertices, corners) = (mesh.positions.len(), mesh.triangles.len() * 3);
    let (total, rest) = (bytes.len(), bytes.len() - split);
    let bounds = mesh.bounds();
    let (low, high) = (bounds.min.to_array(), bounds.max.to_array());
    let data = super::base64(&bytes);
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}],
        "nodes": [{{"mesh": 0, "name": "{name}"}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1, "material": 0}}]}}],
        "materials": [{{"name": "oak", "pbrMetallicRoughness": {{"baseColorFactor": [0.6, 0.4, 0.2, 1]}}}}],
        "accessors": [
            {{"bufferView": 0, "componentType": 5126, "count": {vertices}, "type": "VEC3", "min": {low:?}, "max": {high:?}}},
            {{"bufferView": 1, "componentType": 5123, "count": {corners}, "type": "SCALAR"}}],
        "bufferViews": [{{"buffer": 0, "byteLength": {split}}}, {{"buffer": 0, "byteOffset": {split}, "byteLength": {rest}}}],
        "buffers": [{{"byteLength": {total}, "uri": "data:application/octet-stream;base64,{data}"}}]}}"#
    )
}

/// Writes the data set into a folder and gives the scene's path.
pub(crate) fn write(folder: &Path) -> PathBuf {
    let put = |name: &str, text: &str| {
        let path = folder.join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    };
    put("set.scene_dataset_config.json", DATASET);
    put(SCENE, SCENE_TEXT);
    put(
        "stages/room.stage_config.json",
        r#"{"render_asset": "room.glb"}"#,
    );
    let house = House::shoebox([6.0, 2.5, 4.0], &ShoeboxMaterials::default()).unwrap();
    dwell_houses::gltf::write(&house, &folder.join("stages/room.glb")).unwrap();
    put(
        "objects/b/block.object_config.json",
        r#"{"render_asset": "block.gltf", "up": [0, 0, 1], "front": [0, 1, 0], "semantic_id": 7}"#,
    );
    let block = box_gltf("block", Vec3::ZERO, Vec3::new(0.2, 0.4, 0.6));
    put("objects/b/block.gltf", &block);
    put(
        "objects/v/my_vase_01.object_config.json",
        r#"{"render_asset": "vase.gltf"}"#,
    );
    let vase = box_gltf("vase", Vec3::new(-0.1, 0.0, -0.1), Vec3::new(0.1, 0.4, 0.1));
    put("objects/v/vase.gltf", &vase);
    put("urdf/cupboard/cupboard.urdf", CUPBOARD);
    put("semantics/scenes/room.semantic_config.json", REGIONS);
    put(
        "semantics/lexicon.json",
        r#"{"classes": [{"id": 0, "name": "unknown"}, {"id": 7, "name": "stool"}]}"#,
    );
    folder.join(SCENE)
}
