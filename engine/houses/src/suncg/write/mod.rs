//! Any house as a SUNCG data root.
//!
//! The format knows rooms, models, poses and colours, and little else: the list of losses says what is left behind.

mod losses;
mod models;
mod rooms;
mod tables;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use dwell_scene::file::StagedPath;
use dwell_scene::{Aabb, House, LevelId, Material, MaterialId, RoomId, State, TextureId, units};
use glam::Vec3;

use super::file::{SuncgBounds, SuncgHouse, SuncgLevel, SuncgNode};
use crate::atomic::write_folder;
use crate::data_root::DataRoot;
use crate::error::HousesError;
use crate::export_loss::ExportLoss;
use crate::import::{UniqueNames, encode_png};
use crate::obj::mtl_material;

/// Writes `house` as a new SUNCG data root at `path`, as it stands at the start, and returns what it does not hold.
///
/// # Errors
/// [`HousesError::NotRepresentable`] when something stands at `path` already or a texture cannot be written,
/// [`HousesError::Io`] when the system refuses.
pub fn write(house: &House, path: &Path) -> Result<Vec<ExportLoss>, HousesError> {
    let mut losses = losses::house_losses(house);
    write_folder(
        path,
        |_| false,
        |folder| {
            let mut writer = SuncgWriter::new(house, folder, plain_name(&house.name), false);
            writer.write_all_but_tables(&mut losses)?;
            tables::write_tables(folder, &writer.models.rows)
        },
    )?;
    Ok(losses.into_vec())
}

/// Writes `house` into the data root at `root` as `house/NAME/house.json`; models and textures are named by their content,
/// so that all houses of the root share them. [`write_shared_tables`] then writes the tables. Returns the house's file.
/// An old house of this name is replaced.
///
/// # Errors
/// [`HousesError::NotRepresentable`] when the name is not of ASCII letters, digits, `_`, `-` and `.`, begins with `.` or ends in
/// `.dwell`, and when a texture cannot be written; [`HousesError::Io`] when the system refuses.
pub fn write_into(
    house: &House,
    root: &Path,
    name: &str,
) -> Result<(PathBuf, Vec<ExportLoss>), HousesError> {
    check_folder_name(root, name)?;
    let mut losses = losses::house_losses(house);
    let draft = StagedPath::folder(&root.join(name)).map_err(HousesError::io(root))?;
    SuncgWriter::new(house, draft.path(), name.to_owned(), true)
        .write_all_but_tables(&mut losses)?;
    // Shared files come first and the house last: a house that exists is complete.
    for (folder, is_shared) in [
        ("texture", true),
        ("object", true),
        ("room", false),
        ("house", false),
    ] {
        move_all(&draft.path().join(folder), &root.join(folder), is_shared)?;
    }
    let file = root.join("house").join(name).join("house.json");
    Ok((file, losses.into_vec()))
}

/// Checks that a name can be that of a house's folder as it is: changed, it could be that of another house.
fn check_folder_name(root: &Path, name: &str) -> Result<(), HousesError> {
    let is_allowed = |c: char| is_plain(c) || c == '.';
    // A folder NAME.dwell is a house of the native form.
    let is_native = name.to_ascii_lowercase().ends_with(".dwell");
    if !name.is_empty() && name.chars().all(is_allowed) && !name.starts_with('.') && !is_native {
        return Ok(());
    }
    Err(HousesError::NotRepresentable {
        path: root.join("house").join(name),
        message: "allowed are names of ASCII letters, digits, _, - and ., without . in front and .dwell at the end".to_owned(),
    })
}

/// Moves everything in folder `from` into folder `to`; existing files stay if they are shared and whole, else they are replaced.
fn move_all(from: &Path, to: &Path, is_shared: bool) -> Result<(), HousesError> {
    if !from.exists() {
        return Ok(());
    }
    fs::create_dir_all(to).map_err(HousesError::io(to))?;
    for entry in fs::read_dir(from).map_err(HousesError::io(from))? {
        let entry = entry.map_err(HousesError::io(from))?;
        let target = to.join(entry.file_name());
        if target.exists() {
            if is_shared && is_complete_copy(&entry.path(), &target) {
                continue;
            }
            if target.is_dir() {
                fs::remove_dir_all(&target).map_err(HousesError::io(&target))?;
            }
        }
        let moved = fs::rename(entry.path(), &target);
        // Another process may have written the same model in between.
        if !(is_shared && target.exists()) {
            moved.map_err(HousesError::io(&target))?;
        }
    }
    Ok(())
}

/// Returns whether all that a file or folder has is there with as many bytes: its name is the content's.
fn is_complete_copy(made: &Path, there: &Path) -> bool {
    let Ok(entries) = fs::read_dir(made) else {
        let bytes = |path: &Path| fs::metadata(path).ok().map(|found| found.len());
        return there.is_file() && bytes(made) == bytes(there);
    };
    entries
        .flatten()
        .all(|entry| is_complete_copy(&entry.path(), &there.join(entry.file_name())))
}

/// Writes the tables of a data root that [`write_into`] filled: once, after the last house, or again at any time.
///
/// # Errors
/// [`HousesError::Syntax`] when something stands beside a model that is no row of a table, [`HousesError::Io`] when the
/// system refuses.
pub fn write_shared_tables(root: &Path) -> Result<(), HousesError> {
    let root_of = DataRoot::new(root)?;
    let mut rows = tables::read_rows(&root_of)?;
    loop {
        tables::write_tables(root, &rows)?;
        // Another process that fills the same root may have finished in between.
        let now = tables::read_rows(&root_of)?;
        if now.len() == rows.len() {
            return Ok(());
        }
        rows = now;
    }
}

/// A data root under construction.
struct SuncgWriter<'a> {
    house: &'a House,
    folder: PathBuf,
    scene_id: String,
    /// True if models and textures are named by their content.
    shared: bool,
    /// File name without ending of each texture.
    textures: BTreeMap<TextureId, String>,
    models: models::WrittenModels,
    /// The initial state of the house.
    start: State,
}

impl<'a> SuncgWriter<'a> {
    fn new(house: &'a House, folder: &Path, scene_id: String, shared: bool) -> Self {
        Self {
            house,
            folder: folder.to_owned(),
            scene_id,
            shared,
            textures: BTreeMap::new(),
            models: models::WrittenModels::default(),
            start: State::new(house),
        }
    }

    /// Writes everything but the tables.
    fn write_all_but_tables(
        &mut self,
        losses: &mut crate::export_loss::ExportLosses,
    ) -> Result<(), HousesError> {
        self.textures()?;
        let mut levels: Vec<SuncgLevel> = Vec::new();
        for (id, level) in self.house.levels.iter_ids() {
            let nodes = self.nodes(id, losses)?;
            let (id, bbox) = (Some(level.name.clone()), bounds(&level.bounds));
            levels.push(SuncgLevel {
                id,
                valid: None,
                bbox,
                nodes,
            });
        }
        self.house_file(levels)
    }

    /// Writes a file below the data root.
    fn file(&self, path: &str, bytes: &[u8]) -> Result<(), HousesError> {
        let full = self.folder.join(path);
        if let Some(folder) = full.parent() {
            fs::create_dir_all(folder).map_err(HousesError::io(folder))?;
        }
        fs::write(&full, bytes).map_err(HousesError::io(&full))
    }

    fn textures(&mut self) -> Result<(), HousesError> {
        let mut names = UniqueNames::default();
        for (id, texture) in self.house.textures.iter_ids() {
            let plain = plain_name(&texture.name);
            let bytes = encode_png(texture).map_err(|message| HousesError::NotRepresentable {
                path: self.folder.join(format!("texture/{plain}.png")),
                message,
            })?;
            let name = if self.shared {
                format!("{plain}-{}", short_name(&bytes))
            } else {
                names.unique(&plain)
            };
            self.file(&format!("texture/{name}.png"), &bytes)?;
            self.textures.insert(id, name);
        }
        Ok(())
    }

    /// The MTL text of materials, each under the name that `slot_name` gives its position.
    fn mtl(
        &self,
        materials: &[MaterialId],
        slot_name: impl Fn(usize, &Material) -> String,
    ) -> String {
        let entries = materials.iter().enumerate().map(|(k, id)| {
            let material = &self.house.materials[*id];
            let texture = material
                .texture
                .map(|id| format!("../../texture/{}.png", self.textures[&id]));
            mtl_material(&slot_name(k, material), material, texture.as_deref())
        });
        entries.collect::<Vec<_>>().join("\n")
    }

    /// The nodes of a storey: its rooms, then grounds, then objects.
    fn nodes(
        &mut self,
        level: LevelId,
        losses: &mut crate::export_loss::ExportLosses,
    ) -> Result<Vec<SuncgNode>, HousesError> {
        let mut nodes = Vec::new();
        let mut node_of_room: BTreeMap<RoomId, usize> = BTreeMap::new();
        for (id, room) in self
            .house
            .rooms
            .iter_ids()
            .filter(|(_, room)| room.level == level)
        {
            node_of_room.insert(id, nodes.len());
            nodes.push(self.room_node(level, nodes.len(), Some((id, room)))?);
        }
        if self
            .house
            .structure
            .iter()
            .any(|piece| rooms::needs_own_room(piece, level))
        {
            nodes.push(self.room_node(level, nodes.len(), None)?);
        }
        nodes.extend(self.ground_nodes(level, nodes.len())?);
        for (id, object) in self
            .house
            .objects
            .iter_ids()
            .filter(|(_, object)| object.level == level)
        {
            let index = nodes.len();
            nodes.push(self.object_node(id, format!("{}_{index}", level.0), losses)?);
            let room = object.room.and_then(|room| node_of_room.get(&room));
            if let Some(room) = room {
                nodes[*room]
                    .node_indices
                    .get_or_insert_default()
                    .push(index as f64);
            }
        }
        Ok(nodes)
    }

    fn house_file(&self, levels: Vec<SuncgLevel>) -> Result<(), HousesError> {
        let all = self
            .house
            .levels
            .iter()
            .fold(Aabb::EMPTY, |all, level| all.union(&level.bounds));
        let file = SuncgHouse {
            version: Some("suncg@1.0.0".to_owned()),
            id: Some(self.scene_id.clone()),
            up: Some(vec![0.0, 1.0, 0.0]),
            front: Some(vec![0.0, 0.0, 1.0]),
            scale_to_meters: Some(1.0),
            levels,
            bbox: bounds(&all),
            materials: Vec::new(),
        };
        let path = format!("house/{}/house.json", self.scene_id);
        let text =
            serde_json::to_vec_pretty(&file).map_err(|error| HousesError::NotRepresentable {
                path: self.folder.join(&path),
                message: error.to_string(),
            })?;
        self.file(&path, &text)
    }
}

/// A box of the file; `None` for an empty one.
fn bounds(bounds: &Aabb) -> Option<SuncgBounds> {
    let corner = |p: Vec3| Some(p.to_array().map(f64::from).to_vec());
    (!bounds.is_empty()).then(|| SuncgBounds {
        min: corner(bounds.min),
        max: corner(bounds.max),
    })
}

const fn is_plain(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_' || c == '-'
}

/// A name that can be a file's: letters, digits, `_`, `-`.
fn plain_name(name: &str) -> String {
    let plain = |c: char| if is_plain(c) { c } else { '-' };
    let mut plain: String = name.chars().map(plain).collect();
    if plain.is_empty() {
        "unnamed".clone_into(&mut plain);
    }
    plain
}

/// A name that can be a model's: a file's, and not that of a variant (`..._0`).
fn model_name(name: &str) -> String {
    let mut plain = plain_name(name);
    if super::metadata::base_model(&plain) != plain {
        plain.push('-');
    }
    plain
}

/// Returns a short name of content: 64 bits of its hash.
fn short_name(bytes: &[u8]) -> String {
    format!("{:016x}", xxhash_rust::xxh3::xxh3_64(bytes))
}

/// `#rrggbb` of a material's colour.
fn hex(material: &Material) -> String {
    let bytes = material
        .base_color
        .map(|c| (units::srgb_from_linear(c) * 255.0).round() as u8);
    bytes
        .iter()
        .fold("#".to_owned(), |text, byte| text + &format!("{byte:02x}"))
}
