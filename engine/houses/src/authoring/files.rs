//! Access of edits to files.

use std::path::{Path, PathBuf};

use super::edit_errors::invalid_field;
use crate::data_root::DataRoot;
use crate::error::HousesError;
use crate::report::FileLocation;

/// The files that an edit may name.
#[derive(Clone, Debug)]
pub enum FileAccess {
    /// Any: the edits come from the user.
    Anywhere,
    /// Those below a folder: the edits come from a file in it.
    Below(DataRoot),
}

impl FileAccess {
    /// The path of a name.
    ///
    /// # Errors
    /// [`HousesError::PathLeavesRoot`].
    pub(super) fn resolve_path(&self, field: &str, name: &str) -> Result<PathBuf, HousesError> {
        if name.is_empty() {
            return Err(invalid_field(field, "nothing", "the path of a file"));
        }
        let Self::Below(root) = self else {
            return Ok(PathBuf::from(name));
        };
        let leaves = || HousesError::PathLeavesRoot {
            at: FileLocation::file("plan").field(field),
            path: name.to_owned(),
            root: root.folder().to_owned(),
        };
        let inside = DataRoot::resolve("", name).map_err(|_| leaves())?;
        let full = root.folder().join(&inside);
        if full.exists() {
            root.check_inside(&full, &inside)?;
        }
        Ok(full)
    }

    /// The HOUSE of a string: paths as of [`FileAccess::resolve_path`]; no plan rests on another plan.
    ///
    /// # Errors
    /// [`HousesError::PathLeavesRoot`], and [`HousesError::Spec`] for a plan.
    pub(super) fn resolve_house(&self, field: &str, house: &str) -> Result<String, HousesError> {
        if super::open::recognizes(Path::new(house)) || house.contains("?map=") {
            let possible = "a HOUSE that is no plan and has no map";
            return Err(invalid_field(field, format_args!("{house:?}"), possible));
        }
        if house.starts_with("builtin:") || house.starts_with("seed:") {
            return Ok(house.to_owned());
        }
        Ok(self
            .resolve_path(field, house)?
            .to_string_lossy()
            .into_owned())
    }
}
