//! glTF 2.0 and GLB: an object or a scene of named ones as a house.

mod accessor;
mod buffers;
mod container;
mod convert;
mod extras;
mod faults;
mod geometry;
mod glb;
mod indices;
mod lights;
mod nodes;
mod surface;
mod write;

pub(crate) use convert::VertexBudget;
pub(crate) use geometry::ParsedGlb;
pub use write::write;
pub(crate) use write::{AssetStorage, MeshAccessors, encode};

use std::path::Path;

use dwell_scene::House;
use dwell_scene::parallel::Threads;

use crate::data_root::DataRoot;
use crate::error::HousesError;
use crate::import::ImportedScene;
use crate::limits::MAX_BUFFER_BYTES;
use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;

/// Returns whether `path` names a glTF file.
pub(crate) fn recognizes(path: &Path) -> bool {
    path.extension().is_some_and(|ending| {
        ending.eq_ignore_ascii_case("glb") || ending.eq_ignore_ascii_case("gltf")
    })
}

/// Opens a `.glb` or `.gltf` file. Every node with a mesh is a thing; names mean structure or a category.
///
/// Points and spots of light are attached to the nearest object. Animations, skins, cameras and directional lights are not read and
/// reported. What `extras.dwell` says is read, so that a file of [`write`](write()) is the house that was written; where it breaks a
/// rule of the scene it is reported, and objects and materials are read as in a file of anybody.
///
/// # Errors
/// [`HousesError::Io`] when the file cannot be read, [`HousesError::Syntax`] when it is no valid glTF 2.0,
/// [`HousesError::TooLarge`] for buffers beyond 2 GiB, [`HousesError::Empty`] when no triangle is left,
/// [`HousesError::Scene`] when the result breaks a rule of the scene. Everything else is reported.
pub fn open(path: &Path, threads: Threads) -> Result<(House, LoadReport), HousesError> {
    let folder = path.parent().unwrap_or_else(|| Path::new(""));
    let name = path
        .file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    std::fs::metadata(path).map_err(HousesError::io(path))?;
    let root = DataRoot::new(folder)?;
    let bytes = root.read_user_named(&name, MAX_BUFFER_BYTES)?;
    open_bytes(&bytes, &root, &name, threads)
}

/// The same from bytes; files beside it are read from `root`.
///
/// # Errors
/// Those of [`open`].
pub fn open_bytes(
    bytes: &[u8],
    root: &DataRoot,
    name: &str,
    threads: Threads,
) -> Result<(House, LoadReport), HousesError> {
    let at = FileLocation::file(name);
    let mut report = LoadReport::new();
    let scene = read(bytes, root, name, true, threads, &mut report)?;
    match scene.into_house(&at, &mut report) {
        Err(HousesError::Scene { source, .. }) => {
            let mut report = LoadReport::new();
            let what = format!("what extras say of objects and materials is not read: {source}");
            report.warn(at.field("extras.dwell"), WarningKind::Simplified { what });
            let scene = read(bytes, root, name, false, threads, &mut report)?;
            Ok((scene.into_house(&at, &mut report)?, report))
        }
        house => Ok((house?, report)),
    }
}

/// The named meshes of a file with their materials and images; files beside it are read from `root`.
///
/// # Errors
/// Those of [`open`] up to what the scene's own rules say.
pub(crate) fn read_scene(
    bytes: &[u8],
    root: &DataRoot,
    name: &str,
    threads: Threads,
    report: &mut LoadReport,
) -> Result<ImportedScene, HousesError> {
    read(bytes, root, name, true, threads, report)
}

/// Extensions that compress meshes; none is read.
const MESH_COMPRESSIONS: [&str; 2] = ["KHR_draco_mesh_compression", "EXT_meshopt_compression"];

/// `trusted`: whether `extras` of objects and materials count.
fn read(
    bytes: &[u8],
    root: &DataRoot,
    name: &str,
    trusted: bool,
    threads: Threads,
    report: &mut LoadReport,
) -> Result<ImportedScene, HousesError> {
    let at = FileLocation::file(name);
    let syntax = |message: String| HousesError::Syntax {
        at: at.clone(),
        message,
    };
    let (json, blob) = container::split_glb(bytes).map_err(syntax)?;
    check_version(&json.asset, &at)?;
    check_positions(&json, &at)?;
    let compression = mesh_compression(&json);
    // The crate's document checks every index and required field.
    let document = ::gltf::Document::from_json(json).map_err(|error| match &compression {
        Some(name) => syntax(format!(
            "its meshes are compressed ({name}), which is not read; decompress them, for example with gltf-transform"
        )),
        None => syntax(format!(
            "no valid glTF 2.0: {}",
            faults::error_sentence(&error, bytes)
        )),
    })?;
    let json = document.into_json();
    let buffers = buffers::Buffers::load(&json, blob, root, &at, report)?;
    convert::convert(&json, &buffers, root, name, trusted, threads, report)
}

/// The extension that compresses meshes of the file, if one does.
fn mesh_compression(json: &::gltf::json::Root) -> Option<String> {
    let mut used = json.extensions_required.iter().chain(&json.extensions_used);
    used.find(|name| MESH_COMPRESSIONS.contains(&name.as_str()))
        .cloned()
}

/// Checks that the asset is one of glTF 2: by the version that it requires of readers, else by its own.
fn check_version(asset: &::gltf::json::Asset, at: &FileLocation) -> Result<(), HousesError> {
    let (field, found) = match &asset.min_version {
        Some(needed) => ("asset.minVersion", needed),
        None => ("asset.version", &asset.version),
    };
    let numbers = found.split_once('.').and_then(|(major, minor)| {
        let minor: u32 = minor.parse().ok()?;
        Some((major.parse::<u32>().ok()?, minor))
    });
    // Files of a later minor version can be read, unless they forbid it.
    let is_read = match numbers {
        Some((major, minor)) => major == 2 && (asset.min_version.is_none() || minor == 0),
        None => false,
    };
    if is_read {
        return Ok(());
    }
    Err(HousesError::Version {
        at: at.field(field),
        found: found.clone(),
        allowed: vec!["2.0".to_owned()],
    })
}

/// Checks that the positions of all primitives are accessors that exist: the `gltf` crate (1.4) looks them up before it checks
/// them, which panics.
fn check_positions(json: &::gltf::json::Root, at: &FileLocation) -> Result<(), HousesError> {
    use ::gltf::json::mesh::Semantic;
    use ::gltf::json::validation::Checked;
    let positions = Checked::Valid(Semantic::Positions);
    for (k, mesh) in json.meshes.iter().enumerate() {
        for (p, primitive) in mesh.primitives.iter().enumerate() {
            let index = primitive.attributes.get(&positions);
            if let Some(index) = index.filter(|index| index.value() >= json.accessors.len()) {
                let field = format!("meshes[{k}].primitives[{p}].attributes.POSITION");
                return Err(HousesError::Field {
                    at: at.field(field),
                    expected: "an accessor of the file",
                    found: format!("{} of {}", index.value(), json.accessors.len()),
                });
            }
        }
    }
    Ok(())
}
