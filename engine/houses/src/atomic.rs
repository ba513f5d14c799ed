//! Atomic writes: files and folders that are either there whole or not at all.

use std::fs;
use std::path::Path;

use crate::error::HousesError;
use dwell_scene::file::{self, StagedPath};

/// Writes a file under another name and moves it into place.
///
/// # Errors
/// [`HousesError::Io`] when the system refuses, and where something stands that is no regular file.
pub(crate) fn write_file(path: &Path, bytes: &[u8]) -> Result<(), HousesError> {
    file::write(path, bytes).map_err(HousesError::io(path))
}

/// Refuses a link, for what is written below a folder of many houses: it may lead to somebody else's house.
///
/// # Errors
/// [`HousesError::NotRepresentable`].
pub(crate) fn refuse_link(path: &Path) -> Result<(), HousesError> {
    if !path.is_symlink() {
        return Ok(());
    }
    let message = "a link stands there; what it leads to is not replaced".to_owned();
    Err(HousesError::NotRepresentable {
        path: path.to_owned(),
        message,
    })
}

/// Fills a folder under another name and moves it into place. An old folder there is replaced if `is_ours` is true for it. A
/// link is followed to the folder it leads to.
///
/// # Errors
/// [`HousesError::NotRepresentable`] when something else stands there, [`HousesError::Io`] when the system refuses, and what
/// `fill` says.
pub(crate) fn write_folder(
    path: &Path,
    is_ours: impl Fn(&Path) -> bool,
    fill: impl FnOnce(&Path) -> Result<(), HousesError>,
) -> Result<(), HousesError> {
    let place = if path.is_symlink() {
        fs::canonicalize(path).map_err(HousesError::io(path))?
    } else {
        path.to_owned()
    };
    if place.exists() && !is_ours(&place) {
        let message = "something else stands there already; it is not replaced".to_owned();
        return Err(HousesError::NotRepresentable {
            path: path.to_owned(),
            message,
        });
    }
    let refused = |source| HousesError::io(&place)(source);
    let draft = StagedPath::folder(&place).map_err(refused)?;
    fill(draft.path())?;
    if !place.exists() {
        return fs::rename(draft.path(), &place).map_err(refused);
    }
    let aside = StagedPath::folder(&place).map_err(refused)?;
    let old = aside.path().join("old");
    fs::rename(&place, &old).map_err(refused)?;
    fs::rename(draft.path(), &place).map_err(|source| {
        // The first error is the one that matters.
        let _ = fs::rename(&old, &place);
        refused(source)
    })
}
