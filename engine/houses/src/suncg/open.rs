//! Opening of a SUNCG path.

use std::path::{Path, PathBuf};

use dwell_scene::House;
use dwell_scene::parallel::Threads;

use super::{ParsedSuncgFiles, convert, locate};
use crate::error::HousesError;
use crate::report::LoadReport;

/// Returns whether `path` is a SUNCG house: a JSON file, a house's folder, or a data root.
pub(crate) fn recognizes(path: &Path) -> bool {
    let is_json = path
        .extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("json"));
    is_json || path.join("house.json").is_file() || path.join("house").is_dir()
}

/// Opens a `house.json`, the folder that holds it, or a data root with one house.
///
/// # Errors
/// [`HousesError::NotOneHouse`] for a data root with no house or several, else those of [`ParsedSuncgFiles::read`] and
/// [`convert`].
pub fn open(path: &Path, threads: Threads) -> Result<(House, LoadReport), HousesError> {
    let house_json = house_json(path)?;
    let (root, inside) = locate(&house_json)?;
    let mut report = LoadReport::new();
    let files = ParsedSuncgFiles::read(&root, &inside, threads, &mut report)?;
    let house = convert(&files, threads, &mut report)?;
    Ok((house, report))
}

fn house_json(path: &Path) -> Result<PathBuf, HousesError> {
    if !path.is_dir() {
        return Ok(path.to_owned());
    }
    let direct = path.join("house.json");
    if direct.is_file() {
        return Ok(direct);
    }
    let folder = path.join("house");
    let mut found = Vec::new();
    for entry in std::fs::read_dir(&folder).map_err(HousesError::io(&folder))? {
        let entry = entry.map_err(HousesError::io(&folder))?;
        if entry.path().join("house.json").is_file() {
            found.push(entry.file_name().to_string_lossy().into_owned());
        }
    }
    found.sort();
    if let [id] = found.as_slice() {
        return Ok(folder.join(id).join("house.json"));
    }
    found.truncate(5);
    Err(HousesError::NotOneHouse {
        path: path.to_owned(),
        found,
    })
}
