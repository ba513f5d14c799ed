//! Reads everything a house needs from a SUNCG data root; interprets nothing.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;

use dwell_scene::Texture;
use dwell_scene::parallel::Threads;
use tracing::debug_span;

use super::arch::{self, ArchFile};
use super::file::{SuncgHouse, SuncgNode};
use super::metadata::{CategoryTable, LightTable, SoundTable, read_table};
use super::parse;
use crate::data_root::{DataRoot, parent_folder};
use crate::error::HousesError;
use crate::import::read_images;
use crate::limits::MAX_TEXT_BYTES;
use crate::obj::{ParsedObj, read_mesh};
use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;

/// All files of one house, parsed.
#[derive(Debug)]
pub struct ParsedSuncgFiles {
    /// The folder's name below `house/` and `room/`.
    pub scene_id: String,
    /// `house.json`, relative to the root.
    pub house_path: String,
    /// Its content.
    pub house: SuncgHouse,
    /// OBJ files by path relative to the root, with their materials; those that do not exist are absent.
    pub meshes: BTreeMap<String, ParsedObj>,
    /// Paths of the OBJ files that are there and could not be read; the report says why.
    pub unreadable: BTreeSet<String>,
    /// `arch.json` with its path, when the house has no room meshes.
    pub arch: Option<(String, ArchFile)>,
    /// Images by path relative to the root; those that do not exist or cannot be read are absent.
    pub textures: BTreeMap<String, Arc<Texture>>,
    /// `ModelCategoryMapping.csv`.
    pub categories: CategoryTable,
    /// `suncgModelLights.json`.
    pub lights: LightTable,
    /// `sounds.json`.
    pub sounds: SoundTable,
}

/// Paths of the files of a house, relative to the root.
pub(super) mod paths {
    use super::SuncgNode;
    use crate::warning_kind::WarningKind;

    /// Returns whether an id can be the name of a file: it comes from the file and must not lead anywhere else.
    pub(in super::super) fn is_safe_file_name(id: &str) -> bool {
        invalid_id_reason(id).is_none()
    }

    /// Returns why an id is no name of a file, if it is none.
    pub(in super::super) fn invalid_id_reason(id: &str) -> Option<WarningKind> {
        if id == ".." || id.contains(['/', '\\', ':']) {
            let path = id.to_owned();
            return Some(WarningKind::PathRefused { path });
        }
        (id.is_empty() || id == "." || id.contains('\0')).then(|| WarningKind::BadField {
            found: format!("{id:?}"),
            expected: "the name of a file".to_owned(),
        })
    }

    /// The mesh of a model, or of its second state.
    pub(in super::super) fn model_mesh_path(id: &str, second: bool) -> String {
        format!("object/{id}/{id}{}.obj", if second { "_0" } else { "" })
    }

    /// The mesh of a room's ceiling (`c`), floor (`f`) or walls (`w`).
    pub(in super::super) fn room_mesh_path(scene_id: &str, model: &str, part: char) -> String {
        format!("room/{scene_id}/{model}{part}.obj")
    }

    /// The candidates for a texture that an override names, best first.
    pub(in super::super) fn texture_path_candidates(name: &str) -> Option<[String; 2]> {
        let inside =
            |ending: &str| crate::DataRoot::resolve("texture", &format!("{name}{ending}")).ok();
        let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending);
        if ending.eq_ignore_ascii_case("png") || ending.eq_ignore_ascii_case("jpg") {
            return Some([inside("")?, inside("")?]);
        }
        Some([inside(".png")?, inside(".jpg")?])
    }

    /// The meshes that a node may use.
    pub(in super::super) fn node_mesh_paths(scene_id: &str, node: &SuncgNode) -> Vec<String> {
        let Some(model) = node.model_id.as_deref().filter(|id| is_safe_file_name(id)) else {
            return Vec::new();
        };
        match node.kind.as_deref() {
            Some("Object") => vec![
                self::model_mesh_path(model, false),
                self::model_mesh_path(model, true),
            ],
            Some("Room") => ['c', 'f', 'w']
                .map(|part| room_mesh_path(scene_id, model, part))
                .to_vec(),
            Some("Ground") => vec![room_mesh_path(scene_id, model, 'f')],
            _ => Vec::new(),
        }
    }
}

impl ParsedSuncgFiles {
    /// Reads `house_path` of `root` and everything it names.
    ///
    /// # Errors
    /// Those of [`parse`], and [`HousesError::Io`] when `house.json` cannot be read. Everything else is reported.
    pub fn read(
        root: &DataRoot,
        house_path: &str,
        threads: Threads,
        report: &mut LoadReport,
    ) -> Result<Self, HousesError> {
        let house = {
            let _span = debug_span!("house.json").entered();
            let bytes = root.read_user_named(house_path, MAX_TEXT_BYTES)?;
            parse(&bytes, house_path, report)?
        };
        let folder = parent_folder(house_path).rsplit('/').next().unwrap_or("");
        let from_file = house
            .id
            .as_deref()
            .filter(|id| paths::is_safe_file_name(id));
        // The folder's name finds the rooms; the id inside may have been changed by a tool.
        let scene_id = if folder.is_empty() || !root.folder().join("room").join(folder).is_dir() {
            from_file.unwrap_or(folder).to_owned()
        } else {
            folder.to_owned()
        };
        let (meshes, unreadable) = {
            let _span = debug_span!("meshes").entered();
            read_meshes(root, &scene_id, &house, threads, report)
        };
        let arch = read_arch(root, &scene_id, &meshes, report);
        let textures = {
            let _span = debug_span!("textures").entered();
            let at = FileLocation::file(house_path);
            read_textures(root, &house, &meshes, arch.as_ref(), threads, &at, report)
        };
        let _span = debug_span!("tables").entered();
        let mut files = Self {
            scene_id,
            house_path: house_path.to_owned(),
            house,
            meshes,
            unreadable,
            arch,
            textures,
            categories: CategoryTable::default(),
            lights: LightTable::default(),
            sounds: SoundTable::default(),
        };
        files.read_tables(root, report);
        Ok(files)
    }

    fn read_tables(&mut self, root: &DataRoot, report: &mut LoadReport) {
        let path = ["metadata/ModelCategoryMapping.csv"];
        if let Some((file, text)) = read_table(root, &path, "no object has a category", report) {
            self.categories = CategoryTable::read(&text, file, report);
        }
        let path = ["metadata/suncgModelLights.json"];
        if let Some((file, text)) = read_table(root, &path, "no lamp shines", report) {
            self.lights = LightTable::read(&text, file, report);
        }
        // Not part of the data's own tables, so that nobody misses them.
        let unreported = &mut LoadReport::new();
        let paths = [
            "metadata/suncg.lights.json",
            "metadata/sstk/suncg.lights.json",
        ];
        if let Some((file, text)) = read_table(root, &paths, "", unreported) {
            self.lights
                .take_emissive(LightTable::read(&text, file, report));
        }
        let paths = ["metadata/sounds.json", "metadata/sstk/sounds.json"];
        if let Some((file, text)) = read_table(root, &paths, "", unreported) {
            self.sounds = SoundTable::read(&text, file, report);
        }
    }

    /// The texture that an override names, with its path.
    pub(super) fn override_texture_path(&self, name: &str) -> Option<&str> {
        let candidates = paths::texture_path_candidates(name)?;
        candidates
            .iter()
            .find_map(|path| self.textures.get_key_value(path))
            .map(|(path, _)| path.as_str())
    }
}

fn nodes(house: &SuncgHouse) -> impl Iterator<Item = &SuncgNode> {
    house
        .levels
        .iter()
        .flat_map(|level| &level.nodes)
        .filter(|node| node.is_valid())
}

fn read_meshes(
    root: &DataRoot,
    scene_id: &str,
    house: &SuncgHouse,
    threads: Threads,
    report: &mut LoadReport,
) -> (BTreeMap<String, ParsedObj>, BTreeSet<String>) {
    let wanted: BTreeSet<String> = nodes(house)
        .flat_map(|node| paths::node_mesh_paths(scene_id, node))
        .collect();
    let wanted: Vec<String> = wanted
        .into_iter()
        .filter(|path| root.exists(path))
        .collect();
    let read = threads.map(wanted.len(), |k| {
        let mut report = LoadReport::new();
        let files = read_mesh(root, &wanted[k], &mut report);
        (files, report)
    });
    let (mut meshes, mut unreadable) = (BTreeMap::new(), BTreeSet::new());
    for (path, (files, own)) in wanted.into_iter().zip(read) {
        report.append(own);
        if let Some(files) = files {
            meshes.insert(path, files);
        } else {
            unreadable.insert(path);
        }
    }
    (meshes, unreadable)
}

/// The walls of the second release, where no room mesh is there.
fn read_arch(
    root: &DataRoot,
    scene_id: &str,
    meshes: &BTreeMap<String, ParsedObj>,
    report: &mut LoadReport,
) -> Option<(String, ArchFile)> {
    let path = format!("wall/{scene_id}/{scene_id}.arch.json");
    if meshes.keys().any(|path| path.starts_with("room/")) || !root.exists(&path) {
        return None;
    }
    let read = root.read(&path, MAX_TEXT_BYTES);
    match read.and_then(|text| arch::parse(&text, &path, report)) {
        Ok(file) => Some((path, file)),
        Err(error) => {
            let damage = WarningKind::UnreadableMesh {
                path: path.clone(),
                reason: error.reason(),
            };
            report.warn(FileLocation::file(path), damage);
            None
        }
    }
}

fn read_textures(
    root: &DataRoot,
    house: &SuncgHouse,
    meshes: &BTreeMap<String, ParsedObj>,
    arch: Option<&(String, ArchFile)>,
    threads: Threads,
    at: &FileLocation,
    report: &mut LoadReport,
) -> BTreeMap<String, Arc<Texture>> {
    let of_meshes = meshes
        .values()
        .flat_map(|files| files.textures.iter().flatten().cloned());
    let mut wanted: BTreeSet<String> = of_meshes.collect();
    let own = nodes(house).flat_map(|node| node.materials.iter().flatten());
    let of_arch = arch
        .iter()
        .flat_map(|(_, arch)| &arch.elements)
        .flat_map(|element| &element.materials);
    let named = own.chain(&house.materials).chain(of_arch);
    for name in named.filter_map(|material| material.texture.as_deref()) {
        let Some(candidates) = paths::texture_path_candidates(name) else {
            report.warn(
                at.clone(),
                WarningKind::PathRefused {
                    path: name.to_owned(),
                },
            );
            continue;
        };
        match candidates.iter().find(|path| root.exists(path)) {
            Some(path) => {
                wanted.insert(path.clone());
            }
            None => report.warn(
                at.clone(),
                WarningKind::MissingTexture {
                    path: format!("texture/{name}"),
                },
            ),
        }
    }
    read_images(root, wanted, threads, report)
}

/// The data root and the path inside it of a `house.json`: the folder above `house/<id>/` where it lies in one, else the
/// file's own folder.
///
/// # Errors
/// [`HousesError::Io`] when the folder does not exist.
pub fn locate(house_json: &Path) -> Result<(DataRoot, String), HousesError> {
    let name = house_json.file_name().map_or_else(
        || "house.json".into(),
        |name| name.to_string_lossy().into_owned(),
    );
    let folder = house_json.parent().unwrap_or_else(|| Path::new(""));
    let real = folder.canonicalize();
    let real = real.as_deref().unwrap_or(folder);
    let id = real.file_name().map(|id| id.to_string_lossy().into_owned());
    let above = real.parent();
    match (id, above, above.and_then(Path::parent)) {
        (Some(id), Some(above), Some(root))
            if above.file_name().is_some_and(|name| name == "house") =>
        {
            Ok((DataRoot::new(root)?, format!("house/{id}/{name}")))
        }
        _ => Ok((DataRoot::new(folder)?, name)),
    }
}
