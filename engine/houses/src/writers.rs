//! Forms in which houses are written: the list of them.

use std::fs;
use std::path::{Path, PathBuf};

use dwell_scene::House;

use crate::error::HousesError;
use crate::export_loss::ExportLoss;

/// A form in which houses are written.
pub struct HouseWriter {
    /// The form's name.
    pub name: &'static str,
    /// Writes a house at a path and says what the form does not hold.
    pub write: fn(&House, &Path) -> WriteResult,
    /// Writes a house under a name below `house/` of a folder of many, which share what they can; returns where it is.
    pub write_into: fn(&House, &Path, &str) -> FolderWriteResult,
    /// Writes what stands once in a folder of many: after the last house, or again at any time.
    pub finish: fn(&Path) -> Result<(), HousesError>,
}

/// The losses of an export.
pub type WriteResult = Result<Vec<ExportLoss>, HousesError>;

/// The path of a written house, and the losses of the export.
pub type FolderWriteResult = Result<(PathBuf, Vec<ExportLoss>), HousesError>;

/// All forms. A new one is one entry here.
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
            finish: crate::suncg::finish,
        },
        HouseWriter {
            name: "glb",
            write: crate::gltf::write,
            write_into: |house, root, name| {
                let folder = root.join("house");
                fs::create_dir_all(&folder).map_err(HousesError::io(&folder))?;
                let path = folder.join(format!("{name}.glb"));
                crate::gltf::write(house, &path).map(|losses| (path, losses))
            },
            finish: |_| Ok(()),
        },
    ]
}

/// The form of a name.
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
