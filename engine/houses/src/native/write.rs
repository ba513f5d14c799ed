//! Writing of `NAME.dwell/`.

use std::fs::{self, File};
use std::path::{Path, PathBuf};

use dwell_scene::file::{CancellableStream, write_in_pieces};
use dwell_scene::{House, HouseData, IdVec, interrupt};

use super::file::{FORMAT, NativeFile, VERSION, is_sound, sound_path};
use super::{GEOMETRY, TABLES};
use crate::atomic::{refuse_link, write_folder};
use crate::error::HousesError;
use crate::gltf::{AssetStorage, encode};
use crate::limits::MAX_TEXT_BYTES;

/// Returns whether a house may be written to `path`: by its name it is what [`open`](super::open) takes.
fn check_name(path: &Path) -> Result<(), HousesError> {
    if super::recognizes(path) {
        return Ok(());
    }
    Err(HousesError::NotRepresentable {
        path: path.to_owned(),
        message: "its name does not end in .dwell, by which it is known again".to_owned(),
    })
}

/// Returns whether a folder holds nothing but a house, or what is left of one: what else is in it is its owner's.
fn is_house(folder: &Path) -> bool {
    let is_part = |entry: std::io::Result<fs::DirEntry>| {
        entry.is_ok_and(|entry| {
            let name = entry.file_name();
            let is_named =
                name == TABLES || name == GEOMETRY || name.to_str().is_some_and(is_sound);
            is_named && entry.path().is_file()
        })
    };
    fs::read_dir(folder).is_ok_and(|mut entries| entries.all(is_part))
}

/// Writes a house so that [`open`](super::open) gives it back bit for bit. An old native house at `path`, or what is
/// left of one, is replaced.
///
/// # Errors
/// [`HousesError::NotRepresentable`] when the name is not that of a `.dwell`, when the house holds a number that is not finite outside of its meshes, when its geometry
/// exceeds 4 GiB, when its tables exceed what is read again, or when something else stands at `path`; [`HousesError::Io`] when the system refuses.
pub fn write(house: &House, path: &Path) -> Result<(), HousesError> {
    check_name(path)?;
    write_as(house, path, AssetStorage::Inside)
}

/// Writes a house as `root/house/NAME.dwell`; meshes of objects and images go into `root/object` and `root/texture`, where
/// all houses of `root` share them. Returns the house's folder.
///
/// # Errors
/// Those of [`write()`], and [`HousesError::NotRepresentable`] where a link stands in the house's place: what it leads to is not of this
/// folder.
pub fn write_into(house: &House, root: &Path, name: &str) -> Result<PathBuf, HousesError> {
    let path = root.join("house").join(format!("{name}.dwell"));
    refuse_link(&path)?;
    for folder in ["house", "object", "texture"] {
        let folder = root.join(folder);
        fs::create_dir_all(&folder).map_err(HousesError::io(&folder))?;
    }
    write_as(house, &path, AssetStorage::Shared)?;
    Ok(path)
}

fn write_as(house: &House, path: &Path, storage: AssetStorage) -> Result<(), HousesError> {
    let unwritable = |message: String| HousesError::NotRepresentable {
        path: path.to_owned(),
        message,
    };
    let written = encode(house, storage).map_err(unwritable)?;
    let file = NativeFile {
        format: FORMAT.to_owned(),
        version: VERSION,
        mesh_accessors: written.meshes,
        texture_sizes: house
            .textures
            .iter()
            .map(|texture| [texture.width, texture.height])
            .collect(),
        sound_names: house
            .sound_files
            .iter()
            .map(|sound| sound.name.clone())
            .collect(),
        house: HouseData {
            sound_files: IdVec::new(),
            meshes: IdVec::new(),
            textures: IdVec::new(),
            ..house.data().clone()
        },
    };
    let mut text = CancellableStream::new(Vec::new());
    serde_json::to_writer(&mut text, &file).map_err(|error| unwritable(error.to_string()))?;
    let text = text.into_inner();
    if text.len() as u64 > MAX_TEXT_BYTES {
        let bytes = text.len();
        return Err(unwritable(format!(
            "its tables take {bytes} bytes, and at most {MAX_TEXT_BYTES} are read again; leave some of its things out"
        )));
    }
    // JSON has no infinity and no NaN: such a number would come back as something else, so it is refused here.
    let again = CancellableStream::new(text.as_slice());
    if let Err(error) = serde_json::from_reader::<_, NativeFile>(again) {
        return Err(unwritable(format!(
            "a table holds a number that is not finite ({error})"
        )));
    }
    // Shared files come first: a house that exists is complete.
    if let Some(root) = path.parent().and_then(Path::parent) {
        for beside in &written.sidecars {
            interrupt::unwind_if_cancelled();
            let path = root.join(&beside.path);
            // The name is the content's, so an existing file is the same, unless it was cut.
            let is_whole = |found: fs::Metadata| found.len() == beside.bytes.len() as u64;
            if !fs::metadata(&path).is_ok_and(is_whole) {
                crate::atomic::write_file(&path, &beside.bytes)?;
            }
        }
    }
    write_folder(path, is_house, |folder| {
        for (name, bytes) in [(TABLES, &text), (GEOMETRY, &written.file)] {
            let path = folder.join(name);
            let written =
                File::create(&path).and_then(|mut file| write_in_pieces(&mut file, bytes));
            written.map_err(HousesError::io(&path))?;
        }
        for (k, sound) in house.sound_files.iter().enumerate() {
            let path = folder.join(sound_path(k, &sound.name));
            interrupt::unwind_if_cancelled();
            fs::write(&path, &sound.bytes).map_err(HousesError::io(&path))?;
        }
        Ok(())
    })
}
