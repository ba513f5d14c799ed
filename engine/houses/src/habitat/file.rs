//! The files of a Habitat scene data set, field by field. Sources: `docs/formats/habitat.md`.

use serde::Deserialize;
use serde_json::{Map, Value};
use std::collections::BTreeMap;

/// `NAME.scene_dataset_config.json`: the files of the data set.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct DatasetFile {
    pub(super) stages: TemplateSection,
    pub(super) objects: TemplateSection,
    pub(super) articulated_objects: TemplateSection,
    /// Handles with paths, or a [`TemplateSection`].
    pub(super) semantic_scene_descriptor_instances: Map<String, Value>,
}

/// Templates of one kind.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct TemplateSection {
    /// Attributes of every template that does not state them.
    pub(super) default_attributes: Map<String, Value>,
    /// Folders by file ending, each relative to the data set's file, with `*` for a folder's name.
    pub(super) paths: BTreeMap<String, Vec<String>>,
    /// Templates that have no file of their own.
    pub(super) configs: Vec<InlineTemplate>,
}

/// A template inside the data set's file.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct InlineTemplate {
    /// The file it changes, relative to the data set's.
    pub(super) original_file: Option<String>,
    pub(super) template_handle: String,
    pub(super) attributes: Map<String, Value>,
}

/// `NAME.scene_instance.json`: the instances with their poses.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct SceneFile {
    pub(super) stage_instance: Value,
    pub(super) object_instances: Vec<Value>,
    pub(super) articulated_object_instances: Vec<Value>,
    /// `"asset_local"` or `"COM"`; the default of instances that state none.
    pub(super) translation_origin: Option<String>,
    pub(super) default_lighting: Option<String>,
}

/// An instance of a stage, an object or an articulated object.
#[derive(Debug, Deserialize)]
pub(super) struct ObjectInstance {
    pub(super) template_name: String,
    /// m.
    #[serde(default)]
    pub(super) translation: [f32; 3],
    /// w, x, y, z.
    #[serde(default = "no_rotation")]
    pub(super) rotation: [f32; 4],
    /// `"STATIC"`, `"KINEMATIC"` or `"DYNAMIC"`.
    #[serde(default)]
    pub(super) motion_type: Option<String>,
    #[serde(default = "one")]
    pub(super) uniform_scale: f32,
    #[serde(default = "ones")]
    pub(super) non_uniform_scale: [f32; 3],
    #[serde(default = "one")]
    pub(super) mass_scale: f32,
    #[serde(default)]
    pub(super) apply_scale_to_mass: bool,
    #[serde(default)]
    pub(super) translation_origin: Option<String>,
    #[serde(default)]
    pub(super) fixed_base: Option<bool>,
    /// Positions in order, or by the joints' names.
    #[serde(default)]
    pub(super) initial_joint_pose: Value,
}

/// `NAME.object_config.json` and `NAME.stage_config.json`, after the data set's own attributes.
#[derive(Debug, Deserialize)]
#[serde(default)]
pub(super) struct Template {
    /// Relative to the template's folder.
    pub(super) render_asset: String,
    pub(super) collision_asset: String,
    /// Up and front of the asset's own axes.
    pub(super) up: [f32; 3],
    pub(super) front: [f32; 3],
    /// Of the asset's own axes.
    pub(super) scale: [f32; 3],
    pub(super) units_to_meters: f32,
    /// kg.
    pub(super) mass: Option<f32>,
    /// Centre of mass in the object's axes; without it the middle of its box.
    #[serde(rename = "COM")]
    pub(super) com: Option<[f32; 3]>,
    pub(super) semantic_id: Option<i64>,
}

impl Default for Template {
    fn default() -> Self {
        Self {
            render_asset: String::new(),
            collision_asset: String::new(),
            up: [0.0, 1.0, 0.0],
            front: [0.0, 0.0, -1.0],
            scale: ones(),
            units_to_meters: 1.0,
            mass: None,
            com: None,
            semantic_id: None,
        }
    }
}

/// `NAME.ao_config.json`, after the data set's own attributes.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct ArticulatedTemplate {
    /// Relative to the template's folder.
    pub(super) urdf_filepath: String,
    pub(super) uniform_scale: Option<f32>,
    pub(super) mass_scale: Option<f32>,
    /// `"free"` or `"fixed"`.
    pub(super) base_type: Option<String>,
    pub(super) semantic_id: Option<i64>,
}

/// `NAME.semantic_config.json`: the rooms of a scene.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct SemanticFile {
    /// The lexicon, relative to this file's folder.
    pub(super) semantic_descriptor_filename: Option<String>,
    pub(super) region_annotations: Vec<Value>,
}

/// A room.
#[derive(Debug, Deserialize)]
pub(super) struct Region {
    pub(super) name: String,
    #[serde(default)]
    pub(super) label: String,
    /// Corners of the floor, x, y, z.
    pub(super) poly_loop: Vec<[f32; 3]>,
    pub(super) floor_height: f32,
    pub(super) extrusion_height: f32,
}

/// The lexicon: names of semantic ids.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Lexicon {
    pub(super) classes: Vec<LexiconClass>,
}

/// One name.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct LexiconClass {
    pub(super) id: i64,
    pub(super) name: String,
}

fn no_rotation() -> [f32; 4] {
    [1.0, 0.0, 0.0, 0.0]
}

fn one() -> f32 {
    1.0
}

fn ones() -> [f32; 3] {
    [1.0; 3]
}
