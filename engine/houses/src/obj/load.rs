//! An OBJ file together with its materials.

use std::collections::BTreeSet;

use super::file::{MtlFile, ObjFile};
use super::{read_mtl, read_obj};
use crate::data_root::{DataRoot, parent_folder};
use crate::limits::{MAX_LIBRARIES, MAX_MESH_BYTES};
use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;

/// An OBJ file and the materials of its MTL files, one after another.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ParsedObj {
    /// The OBJ file.
    pub obj: ObjFile,
    /// The materials.
    pub mtl: MtlFile,
    /// For each material its texture, relative to the root, when it names one that stays inside.
    pub textures: Vec<Option<String>>,
}

/// Reads an OBJ file with its MTL files.
pub(crate) fn read_mesh(root: &DataRoot, path: &str, report: &mut LoadReport) -> Option<ParsedObj> {
    match root.read(path, MAX_MESH_BYTES) {
        Ok(bytes) => Some(parse_obj_with_mtl(&bytes, root, path, report)),
        Err(error) => {
            let damage = WarningKind::UnreadableMesh {
                path: path.to_owned(),
                reason: error.reason(),
            };
            report.warn(FileLocation::file(path), damage);
            None
        }
    }
}

/// The same from the bytes of an OBJ file; its MTL files are read from `root`.
pub(crate) fn parse_obj_with_mtl(
    bytes: &[u8],
    root: &DataRoot,
    path: &str,
    report: &mut LoadReport,
) -> ParsedObj {
    let mut files = ParsedObj {
        obj: read_obj(bytes, path, report),
        ..ParsedObj::default()
    };
    let folder = parent_folder(path);
    let mut known = BTreeSet::new();
    let named = files.obj.material_libraries.iter();
    // A library that is named again adds nothing.
    let named = named.filter(|library| known.insert(library.as_str()));
    for library in named.take(MAX_LIBRARIES) {
        let Ok(mtl_path) = DataRoot::resolve(folder, library) else {
            report.warn(
                FileLocation::file(path),
                WarningKind::PathRefused {
                    path: library.clone(),
                },
            );
            continue;
        };
        let bytes = match root.read(&mtl_path, MAX_MESH_BYTES) {
            Ok(bytes) => bytes,
            Err(error) => {
                let reason = error.reason();
                let damage = if root.exists(&mtl_path) {
                    WarningKind::UnreadableMaterialFile {
                        path: mtl_path,
                        reason,
                    }
                } else {
                    WarningKind::MissingMaterialFile { path: mtl_path }
                };
                report.warn(FileLocation::file(path), damage);
                continue;
            }
        };
        let mtl = read_mtl(&bytes, &mtl_path, report);
        for material in &mtl.materials {
            let texture = material
                .diffuse_map
                .as_deref()
                .map(|map| (map, DataRoot::resolve(parent_folder(&mtl_path), map)));
            if let Some((map, Err(_))) = &texture {
                report.warn(
                    FileLocation::file(&mtl_path),
                    WarningKind::PathRefused {
                        path: (*map).to_owned(),
                    },
                );
            }
            files
                .textures
                .push(texture.and_then(|(_, resolved)| resolved.ok()));
        }
        files.mtl.materials.extend(mtl.materials);
    }
    files
}
