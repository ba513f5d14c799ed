//! `house.json` of the native form.

use dwell_scene::HouseData;
use serde::{Deserialize, Serialize};

use crate::gltf::MeshAccessors;

/// What the field `format` holds.
pub const FORMAT: &str = "dwell-house";
/// The version that is written.
pub const VERSION: u32 = 2;
/// The versions that are read. 1 had no inertials, no joints without limits, and of motors only the position servo.
pub(super) const VERSIONS: [u32; 2] = [1, VERSION];

/// The head of the file, which every version has.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Head {
    /// [`FORMAT`].
    #[serde(default)]
    pub(super) format: String,
    /// The version of the form.
    #[serde(default)]
    pub(super) version: u32,
}

/// The whole file.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct NativeFile {
    /// [`FORMAT`].
    pub(super) format: String,
    /// [`VERSION`].
    pub(super) version: u32,
    /// Where each mesh stands in the geometry file, in the order of `MeshId`.
    pub(super) mesh_accessors: Vec<MeshAccessors>,
    /// For each texture its size; the images of the geometry file have the same order.
    pub(super) texture_sizes: Vec<[u32; 2]>,
    /// All tables; `meshes` and `textures` are empty here.
    pub(super) house: HouseData,
}
