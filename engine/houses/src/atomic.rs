//! Files and folders that are either there whole or not at all.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use crate::error::HousesError;
use dwell_scene::interrupt;

/// A name beside `path` that nobody else uses: no other process, no other thread.
fn beside(path: &Path, what: &str) -> PathBuf {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(format!(".{what}-{}-{count}", std::process::id()));
    path.with_file_name(name)
}

/// Writes a file under another name and moves it into place.
///
/// # Errors
/// [`HousesError::Io`] when the system refuses.
pub(crate) fn write_file(path: &Path, bytes: &[u8]) -> Result<(), HousesError> {
    let partial = beside(path, "partial");
    let result = fs::write(&partial, bytes).and_then(|()| fs::rename(&partial, path));
    result.map_err(|source| {
        // The error that matters is the first one.
        let _ = fs::remove_file(&partial);
        HousesError::Io {
            path: path.to_owned(),
            source,
        }
    })
}

/// Fills a folder under another name and moves it into place. An old folder there is replaced when `is_ours` says so.
///
/// # Errors
/// [`HousesError::Unwritable`] when something else stands there, [`HousesError::Io`] when the system refuses, and what
/// `fill` says.
pub(crate) fn write_folder(
    path: &Path,
    is_ours: impl Fn(&Path) -> bool,
    fill: impl FnOnce(&Path) -> Result<(), HousesError>,
) -> Result<(), HousesError> {
    if path.exists() && !is_ours(path) {
        let message = "something else stands there already; it is not replaced".to_owned();
        return Err(HousesError::Unwritable {
            path: path.to_owned(),
            message,
        });
    }
    let (partial, old) = (beside(path, "partial"), beside(path, "old"));
    let moved = |from: &Path, to: &Path| fs::rename(from, to).map_err(HousesError::io(to));
    let write = || {
        fs::create_dir_all(&partial).map_err(HousesError::io(&partial))?;
        fill(&partial)?;
        if path.exists() {
            moved(path, &old)?;
        }
        moved(&partial, path)
    };
    let result = interrupt::attempt(write);
    if !matches!(result, Ok(Ok(()))) {
        let _ = fs::remove_dir_all(&partial);
        if old.exists() && !path.exists() {
            let _ = fs::rename(&old, path);
        }
    }
    let _ = fs::remove_dir_all(&old);
    result.unwrap_or_else(|interrupted| interrupted.resume())
}
