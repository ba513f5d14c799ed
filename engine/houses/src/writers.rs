//! The list of export formats.

use std::fs;
use std::path::{Path, PathBuf};

use dwell_scene::House;

use crate::atomic::refuse_link;
use crate::error::HousesError;
use crate::export_loss::ExportLoss;

/// An export format.
pub struct HouseWriter {
    /// The format's name.
    pub name: &'static str,
    /// Writes a house at a path and returns the losses.
    pub write: fn(&House, &Path) -> WriteResult,
    /// Writes a house under a name below `house/` of a folder of many, which share files; returns its path.
    pub write_into: fn(&House, &Path, &str) -> FolderWriteResult,
    /// Writes the common files in a folder of many: after the last house, or again at any time.
    pub finish: fn(&Path) -> Result<(), HousesError>,
}

/// The losses of an export.
pub type WriteResult = Result<Vec<ExportLoss>, HousesError>;

/// The path of a written house, and the losses of the export.
pub type FolderWriteResult = Result<(PathBuf, Vec<ExportLoss>), HousesError>;

/// All export formats. A new one is one entry here.
pub fn writers() -> &'static [HouseWriter] {
    &[
        HouseWriter {
            name: "dwell",
            write: |house, path| crate::native::write(house, path).map(|()| Vec::new()),
            write_into: |house, root, name| {
                crate::native::write_into(house, root, name).map(|path| (path, Vec::new()))
            },
            finish: |_| Ok(()),
        },
        HouseWriter {
            name: "suncg",
            write: crate::suncg::write,
            write_into: crate::suncg::write_into,
            finish: crate::suncg::write_shared_tables,
        },
        HouseWriter {
            name: "glb",
            write: crate::gltf::write,
            write_into: |house, root, name| {
                let folder = root.join("house");
                fs::create_dir_all(&folder).map_err(HousesError::io(&folder))?;
                let path = folder.join(format!("{name}.glb"));
                refuse_link(&path)?;
                crate::gltf::write(house, &path).map(|losses| (path, losses))
            },
            finish: |_| Ok(()),
        },
    ]
}

/// The format of a name.
///
/// # Errors
/// [`HousesError::UnknownForm`] lists what there is.
pub fn writer(name: &str) -> Result<&'static HouseWriter, HousesError> {
    writers()
        .iter()
        .find(|writer| writer.name == name)
        .ok_or_else(|| HousesError::UnknownForm {
            name: name.to_owned(),
            known: writers().iter().map(|writer| writer.name).collect(),
        })
}
