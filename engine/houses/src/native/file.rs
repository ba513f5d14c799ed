//! `house.json` of the native form.

use dwell_scene::HouseData;
use serde::{Deserialize, Serialize};

use crate::gltf::MeshAccessors;

/// Value of the field `format`.
pub const FORMAT: &str = "dwell-house";
/// The version that is written.
pub const VERSION: u32 = 3;
/// The versions that are read. 1 had no inertials, no joints without limits, and of motors only the position servo; 2 had no
/// sound files and no starts of agents.
pub(super) const VERSIONS: [u32; 3] = [1, 2, VERSION];

/// The head of the file, which every version has.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct FormatHeader {
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
    /// The accessors of each mesh in the geometry file, in the order of `MeshId`.
    pub(super) mesh_accessors: Vec<MeshAccessors>,
    /// For each texture its size; the images of the geometry file have the same order.
    pub(super) texture_sizes: Vec<[u32; 2]>,
    /// The name of each sound file; its bytes are in [`sound_path`].
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(super) sound_names: Vec<String>,
    /// All tables; `meshes`, `textures` and `sound_files` are empty here.
    pub(super) house: HouseData,
}

/// Returns the path of sound file `k` in the house's folder: never one that the tables spell.
pub(super) fn sound_path(k: usize, name: &str) -> String {
    let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending);
    let known = ["wav", "flac", "ogg", "oga"];
    let ending = known
        .iter()
        .find(|known| known.eq_ignore_ascii_case(ending));
    format!("sound_{k}.{}", ending.unwrap_or(&"sound"))
}

/// Returns whether a file's name is one that [`sound_path`] gives.
pub(super) fn is_sound(name: &str) -> bool {
    let number = name
        .strip_prefix("sound_")
        .and_then(|rest| rest.split_once('.'))
        .and_then(|(k, _)| k.parse().ok());
    number.is_some_and(|k| sound_path(k, name) == name)
}
