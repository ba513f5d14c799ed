//! The files beside a robot's own: the folder that bounds them, and its meshes.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use dwell_scene::parallel::Threads;
use dwell_scene::{House, Mesh, Texture};

use super::stl;
use crate::data_root::{DataRoot, parent_folder};
use crate::error::HousesError;
use crate::import::{PixelBudget, decode, header_pixel_count, is_truncated_jpeg, texture_name};
use crate::limits::{MAX_IMAGE_BYTES, MAX_MESH_BYTES, MAX_TEXT_BYTES};
use crate::obj;
use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;

/// Largest number of folders from the file up to the package.
const MOST_STEPS: usize = 3;

/// The folder that bounds a robot's files.
pub(crate) struct RobotFileLoader {
    pub(crate) root: DataRoot,
    /// The robot's file, relative to the root.
    pub(crate) file: String,
    meshes: BTreeMap<String, Arc<Mesh>>,
    /// Images; `None` for those that cannot be read, which is reported once.
    images: BTreeMap<String, Option<Arc<Texture>>>,
    pixels: PixelBudget,
}

impl RobotFileLoader {
    /// The root of the file at `path`: its package's folder, else its own.
    ///
    /// # Errors
    /// [`HousesError::Io`] when it does not exist.
    pub(crate) fn of_file(path: &Path) -> Result<Self, HousesError> {
        let real = path.canonicalize().map_err(HousesError::io(path))?;
        let folder = real.parent().unwrap_or_else(|| Path::new("/"));
        let package = folder
            .ancestors()
            .take(1 + MOST_STEPS)
            .find(|folder| folder.join("package.xml").is_file());
        let root: PathBuf = package.unwrap_or(folder).to_owned();
        let inside = real.strip_prefix(&root).unwrap_or(&real);
        let words: Vec<_> = inside
            .components()
            .map(|word| word.as_os_str().to_string_lossy().into_owned())
            .collect();
        Ok(Self {
            root: DataRoot::new(root)?,
            file: words.join("/"),
            meshes: BTreeMap::new(),
            images: BTreeMap::new(),
            pixels: PixelBudget::default(),
        })
    }

    /// The text of the robot's file.
    ///
    /// # Errors
    /// [`HousesError::Io`], [`HousesError::TooLarge`], [`HousesError::Syntax`] for bytes that are no text.
    pub(crate) fn text(&self) -> Result<String, HousesError> {
        let bytes = self.root.read(&self.file, MAX_TEXT_BYTES)?;
        String::from_utf8(bytes).map_err(|error| HousesError::Syntax {
            at: FileLocation::file(&self.file),
            message: format!("no UTF-8 text: {}; save it as UTF-8", error.utf8_error()),
        })
    }

    /// The path inside the root of `name`: relative to `folder`, or `package://NAME/...`, where NAME is the root's own
    /// name or a folder in it; a package that is neither is taken for the root.
    ///
    /// # Errors
    /// [`HousesError::PathLeavesRoot`].
    pub(crate) fn resolve(
        &self,
        folder: &str,
        name: &str,
        at: &FileLocation,
    ) -> Result<String, HousesError> {
        let leaves = |_| HousesError::PathLeavesRoot {
            at: at.clone(),
            path: name.to_owned(),
            root: self.root.folder().to_owned(),
        };
        let Some(rest) = name.strip_prefix("package://") else {
            let plain = name.strip_prefix("file://").unwrap_or(name);
            return DataRoot::resolve(folder, plain).map_err(leaves);
        };
        let (package, inside) = rest.split_once('/').unwrap_or(("", rest));
        let folder = self.root.folder().join(package);
        let start = if DataRoot::resolve("", package).is_ok() && folder.is_dir() {
            package
        } else {
            ""
        };
        DataRoot::resolve(start, inside).map_err(leaves)
    }

    /// The image at a path inside the root; one that cannot be read is reported and absent.
    pub(crate) fn image(
        &mut self,
        path: &str,
        at: &FileLocation,
        report: &mut LoadReport,
    ) -> Option<Arc<Texture>> {
        if let Some(known) = self.images.get(path) {
            return known.clone();
        }
        let bytes = self.root.read(path, MAX_IMAGE_BYTES);
        let bytes = bytes.map_err(|error| error.reason());
        let image = bytes.and_then(|bytes| {
            self.pixels.reserve(header_pixel_count(&bytes)?)?;
            let texture = decode(&texture_name(path), &bytes)?;
            if is_truncated_jpeg(&bytes) {
                let path = path.to_owned();
                report.warn(at.clone(), WarningKind::TruncatedTexture { path });
            }
            Ok(texture)
        });
        let image = match image {
            Ok(image) => Some(Arc::new(image)),
            Err(reason) => {
                let path = path.to_owned();
                report.warn(at.clone(), WarningKind::UnreadableTexture { path, reason });
                None
            }
        };
        self.images.insert(path.to_owned(), image.clone());
        image
    }

    /// The mesh at a path inside the root, without its materials.
    ///
    /// # Errors
    /// [`HousesError::Field`] when it is missing, unreadable or of a form that is not read.
    pub(crate) fn mesh(
        &mut self,
        path: &str,
        at: &FileLocation,
        report: &mut LoadReport,
    ) -> Result<Arc<Mesh>, HousesError> {
        if let Some(mesh) = self.meshes.get(path) {
            return Ok(mesh.clone());
        }
        let fault = |expected, found: String| HousesError::Field {
            at: at.clone(),
            expected,
            found,
        };
        let bytes = self
            .root
            .read(path, MAX_MESH_BYTES)
            .map_err(|error| match error {
                HousesError::PathLeavesRoot { path, root, .. } => HousesError::PathLeavesRoot {
                    at: at.clone(),
                    path,
                    root,
                },
                error => fault(
                    "a mesh file that can be read",
                    format!("{path:?}: {}", error.reason()),
                ),
            })?;
        let ending = path.rsplit('.').next().unwrap_or("").to_ascii_lowercase();
        let expected = "a mesh of the form its name says";
        let broken = |reason: String| fault(expected, format!("{path:?}: {reason}"));
        let mesh = match ending.as_str() {
            "stl" => stl::read(&bytes).map_err(broken)?,
            "obj" => obj::mesh_without_materials(&bytes, path, report),
            "glb" | "gltf" => {
                let root = DataRoot::new(self.root.folder().join(parent_folder(path)))?;
                let name = path.rsplit('/').next().unwrap_or(path);
                let (house, _) = crate::gltf::open_bytes(&bytes, &root, name, Threads::default())
                    .map_err(|error| broken(error.to_string()))?;
                gathered(&house)
            }
            _ => {
                let expected = "a mesh that ends in .stl, .obj, .glb or .gltf";
                return Err(fault(expected, format!("{path:?}")));
            }
        };
        if mesh.triangles.is_empty() {
            return Err(fault(
                "a mesh with triangles",
                format!("{path:?} without one"),
            ));
        }
        let mesh = Arc::new(strip_normals_and_slots(mesh));
        self.meshes.insert(path.to_owned(), mesh.clone());
        Ok(mesh)
    }
}

/// Positions, triangles and texture coordinates alone.
fn strip_normals_and_slots(mesh: Mesh) -> Mesh {
    Mesh {
        positions: mesh.positions,
        uvs: mesh.uvs,
        triangles: mesh.triangles,
        ..Mesh::default()
    }
}

/// All meshes of a file as one.
fn gathered(house: &House) -> Mesh {
    let mut all = Mesh::default();
    for piece in &house.structure {
        all.append(
            &strip_normals_and_slots(Mesh::clone(&house.meshes[piece.mesh])),
            0,
        );
    }
    for part in &house.parts {
        let map = part.world_from_part.to_affine() * part.part_from_mesh;
        let mesh = strip_normals_and_slots(Mesh::clone(&house.meshes[part.mesh])).transformed(&map);
        all.append(&mesh, 0);
    }
    all
}
