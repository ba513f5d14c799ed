//! A folder that bounds every path: nothing a file names can lead out of it.

use std::path::{Path, PathBuf};

use dwell_scene::file::{self, ReadError};

use crate::error::HousesError;
use crate::limits::MAX_FOLDER_ENTRIES;
use crate::report::FileLocation;

/// A folder and the only way to read files below it.
///
/// Paths inside are written with `/`, relative to the root, without `.` or `..`.
#[derive(Debug, Clone)]
pub struct DataRoot {
    folder: PathBuf,
    /// The same with symbolic links resolved, to compare with.
    real: PathBuf,
}

/// A path could not be opened because it leads out of the root.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PathEscape;

impl DataRoot {
    /// A root at `folder`.
    ///
    /// # Errors
    /// [`HousesError::Io`] when the folder does not exist.
    pub fn new(folder: impl Into<PathBuf>) -> Result<Self, HousesError> {
        let mut folder = folder.into();
        if folder.as_os_str().is_empty() {
            folder.push(".");
        }
        let real = folder.canonicalize().map_err(HousesError::io(&folder))?;
        Ok(Self { folder, real })
    }

    /// The folder as it was given.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The path `name` means inside folder `inside` of this root, relative to the root.
    ///
    /// `name` may hold `..`, double slashes and backslashes (all occur in SUNCG and in OBJ files from Windows).
    ///
    /// # Errors
    /// `PathEscape` when the path is absolute or climbs out of the root.
    pub fn resolve(inside: &str, name: &str) -> Result<String, PathEscape> {
        if name.starts_with(['/', '\\'])
            || name.as_bytes().get(1) == Some(&b':')
            || name.contains('\0')
        {
            return Err(PathEscape);
        }
        let mut parts: Vec<&str> = Vec::new();
        for part in inside.split('/').chain(name.split(['/', '\\'])) {
            match part {
                "" | "." => {}
                ".." => {
                    parts.pop().ok_or(PathEscape)?;
                }
                part => parts.push(part),
            }
        }
        Ok(parts.join("/"))
    }

    /// Returns whether something exists at `path`, inside the root. Anything but a regular file is refused when it is read, with a
    /// message that says so.
    pub fn exists(&self, path: &str) -> bool {
        self.folder.join(path).exists()
    }

    /// The names in the folder at `path`, in order; the first 100,000 that the system gives.
    ///
    /// # Errors
    /// [`HousesError::PathLeavesRoot`] when a link leads out of the root, [`HousesError::Io`] when it is no folder.
    pub(crate) fn list_folder(&self, path: &str) -> Result<Vec<String>, HousesError> {
        let full = self.folder.join(path);
        self.check_inside(&full, path)?;
        let entries = std::fs::read_dir(&full).map_err(HousesError::io(&full))?;
        let mut names: Vec<String> = entries
            .take(MAX_FOLDER_ENTRIES)
            .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
            .collect();
        names.sort_unstable();
        Ok(names)
    }

    /// Returns whether a link leads from `full`, which stands for `path` inside, out of the root.
    ///
    /// # Errors
    /// [`HousesError::PathLeavesRoot`], and [`HousesError::Io`] when it does not exist.
    pub(crate) fn check_inside(&self, full: &Path, path: &str) -> Result<(), HousesError> {
        let real = full.canonicalize().map_err(HousesError::io(full))?;
        if real.starts_with(&self.real) {
            return Ok(());
        }
        Err(HousesError::PathLeavesRoot {
            at: FileLocation::file(path),
            path: path.to_owned(),
            root: self.folder.clone(),
        })
    }

    /// Reads the file at `path`, at most `max_bytes` long.
    ///
    /// # Errors
    /// [`HousesError::PathLeavesRoot`] when a link leads out of the root, [`HousesError::TooLarge`] above `max_bytes`,
    /// [`HousesError::Io`] when the system refuses.
    pub fn read(&self, path: &str, max_bytes: u64) -> Result<Vec<u8>, HousesError> {
        let full = self.folder.join(path);
        self.check_inside(&full, path)?;
        read_up_to(&full, path, max_bytes)
    }

    /// Reads the file that the user named, which may be a link to anywhere; files that it refers to are bounded by [`Self::read`].
    ///
    /// # Errors
    /// [`HousesError::TooLarge`] above `max_bytes`, [`HousesError::Io`] when the system refuses.
    pub fn read_user_named(&self, path: &str, max_bytes: u64) -> Result<Vec<u8>, HousesError> {
        read_up_to(&self.folder.join(path), path, max_bytes)
    }
}

/// A file that the user named, and the folder that bounds its references.
pub(crate) struct UserFile {
    pub(crate) root: DataRoot,
    /// The file's name in that folder.
    pub(crate) name: String,
    pub(crate) bytes: Vec<u8>,
}

impl UserFile {
    /// Reads a file of at most `max_bytes`.
    ///
    /// # Errors
    /// [`HousesError::TooLarge`] above `max_bytes`, [`HousesError::Io`] when the system refuses.
    pub(crate) fn read(path: &Path, max_bytes: u64) -> Result<Self, HousesError> {
        // A missing file is reported with its whole path, not with a missing folder.
        std::fs::metadata(path).map_err(HousesError::io(path))?;
        let root = DataRoot::new(path.parent().unwrap_or_else(|| Path::new("")))?;
        let name = path.file_name().unwrap_or_default();
        let name = name.to_string_lossy().into_owned();
        let bytes = read_up_to(path, &name, max_bytes)?;
        Ok(Self { root, name, bytes })
    }
}

/// Returns whether a file is JSON by its name and holds one word of each list: enough to tell formats apart, before anything is parsed.
pub(crate) fn is_json_containing(path: &Path, lists: &[&[&str]]) -> bool {
    let is_json = path
        .extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("json"));
    if !is_json {
        return false;
    }
    let Ok(bytes) = read_up_to(path, "", crate::limits::MAX_TEXT_BYTES) else {
        return false;
    };
    let holds = |word: &&str| {
        let mut windows = bytes.windows(word.len());
        windows.any(|window| window == word.as_bytes())
    };
    lists.iter().all(|words| words.iter().any(holds))
}

/// Reads a regular file of at most `max_bytes`; `name` is its name in errors.
///
/// # Errors
/// [`HousesError::TooLarge`] and [`HousesError::Io`].
pub(crate) fn read_up_to(path: &Path, name: &str, max_bytes: u64) -> Result<Vec<u8>, HousesError> {
    file::read(path, max_bytes).map_err(|error| match error {
        ReadError::Io(source) => HousesError::io(path)(source),
        ReadError::TooLarge { found, allowed } => HousesError::TooLarge {
            at: FileLocation::file(name),
            what: "file size in bytes",
            found,
            allowed,
        },
    })
}

/// The folder part of a path inside a root: `object/83` of `object/83/83.obj`.
pub(crate) fn parent_folder(path: &str) -> &str {
    path.rsplit_once('/').map_or("", |(folder, _)| folder)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn double_slashes_and_parents_resolve_inside_the_root() {
        assert_eq!(
            DataRoot::resolve("object/83", "../../texture//wood_8.jpg").as_deref(),
            Ok("texture/wood_8.jpg")
        );
        assert_eq!(
            DataRoot::resolve("", "./a\\b.png").as_deref(),
            Ok("a/b.png")
        );
    }

    #[test]
    fn paths_out_of_the_root_are_refused() {
        for name in [
            "../../../etc/passwd",
            "/etc/passwd",
            "C:\\secret",
            "\\\\host\\share",
            "a/../../../..",
            "a\0b",
        ] {
            assert_eq!(
                DataRoot::resolve("object/83", name),
                Err(PathEscape),
                "{name}"
            );
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_link_out_of_the_root_is_refused() {
        let outside = tempfile::tempdir().unwrap();
        let inside = tempfile::tempdir().unwrap();
        std::fs::write(outside.path().join("secret"), "x").unwrap();
        std::os::unix::fs::symlink(outside.path().join("secret"), inside.path().join("link"))
            .unwrap();
        let root = DataRoot::new(inside.path()).unwrap();
        assert!(matches!(
            root.read("link", 10),
            Err(HousesError::PathLeavesRoot { .. })
        ));
    }

    #[cfg(unix)]
    #[test]
    fn a_named_pipe_is_refused_without_waiting() {
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("p.obj");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        assert!(made.unwrap().success());
        let error = DataRoot::new(folder.path()).unwrap().read("p.obj", 10);
        assert!(
            error
                .unwrap_err()
                .to_string()
                .contains("not a regular file")
        );
    }

    #[cfg(unix)]
    #[test]
    fn the_file_that_is_named_may_be_a_link_out_of_the_root() {
        let (outside, inside) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        std::fs::write(outside.path().join("blob"), "x").unwrap();
        std::os::unix::fs::symlink(outside.path().join("blob"), inside.path().join("m.glb"))
            .unwrap();
        let root = DataRoot::new(inside.path()).unwrap();
        assert_eq!(root.read_user_named("m.glb", 10).unwrap(), b"x");
    }

    #[test]
    fn a_file_above_the_cap_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("a"), "12345").unwrap();
        let root = DataRoot::new(folder.path()).unwrap();
        assert_eq!(root.read("a", 5).unwrap().len(), 5);
        let error = root.read("a", 4).unwrap_err().to_string();
        assert_eq!(
            error,
            "a: file size in bytes 5 is more than the 4 that are read"
        );
    }
}
