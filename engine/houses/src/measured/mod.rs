//! Measured rooms: a box or a mesh, with absorption and scattering of each surface.
//!
//! `docs/formats/measured-room.md` lists the fields. Sources, microphones and air of the same file belong to the measurement, not to
//! the room, and are read by who measures.

mod convert;
mod file;
mod unknown_names;

use crate::data_root::{DataRoot, is_json_containing};
use crate::error::HousesError;
use crate::json;
use crate::limits::MAX_TEXT_BYTES;
use crate::report::{FileLocation, LoadReport};
use dwell_scene::House;
use file::MeasuredRoomFile;
use std::path::Path;

/// A word of each list stands in every measured room.
const WORDS: [&[&str]; 2] = [
    &["\"materials\""],
    &["\"shoebox\"", "\"mesh\"", "\"absorption\""],
];

/// Returns whether `path` is a measured room: a JSON file with materials and a shape, or with absorption.
pub(crate) fn recognizes(path: &Path) -> bool {
    is_json_containing(path, &WORDS)
}

/// Opens a measured room. Z is up in the file, Y in the house: (x, y, z) becomes (x, z, -y).
///
/// # Errors
/// [`HousesError::Io`] when the file cannot be read, [`HousesError::Syntax`] when it is no JSON of that form, [`HousesError::Field`]
/// for a name that is a few letters from a field's, for a wall or face without a material, for tables of another length than the
/// bands, and for a mesh that cannot be read or lies outside of the file's folder, [`HousesError::Empty`] without a triangle,
/// [`HousesError::Scene`] when a number is out of range.
pub fn open(path: &Path) -> Result<(House, LoadReport), HousesError> {
    let folder = path.parent().unwrap_or_else(|| Path::new(""));
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    std::fs::metadata(path).map_err(HousesError::io(path))?;
    let root = DataRoot::new(folder)?;
    let bytes = root.read_user_named(&name, MAX_TEXT_BYTES)?;
    let at = FileLocation::file(&*name);
    let file: MeasuredRoomFile = json::from_slice(&bytes).map_err(json::syntax(&at))?;
    let stem = name.rsplit_once('.').map_or(&*name, |(stem, _)| stem);
    let mut report = LoadReport::new();
    let data = convert::convert(&file, stem, (&root, &at), &mut report)?;
    let house = House::new(data).map_err(HousesError::scene(&at))?;
    Ok((house, report))
}
