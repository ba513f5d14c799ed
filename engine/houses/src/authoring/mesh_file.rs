//! A mesh file as one thing: the user's own GLB or OBJ.

use std::path::Path;
use std::sync::Arc;

use dwell_scene::{HouseData, MaterialId, Mesh};
use glam::{Affine3A, Quat, Vec3};

use super::apply::EditSession;
use super::edit_errors::{check_range, invalid_field};
use super::edits::UpAxis;
use crate::data_root::UserFile;
use crate::error::HousesError;
use crate::import::{ImportedScene, merge_meshes};
use crate::limits::MAX_BUFFER_BYTES;
use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;

/// The content of a mesh file, as the first mesh of tables that hold its materials and images too.
pub(super) struct LoadedMesh {
    /// One mesh, and the file's materials and textures.
    pub(super) data: HouseData,
    /// The material of each slot of the mesh.
    pub(super) materials: Vec<MaterialId>,
}

/// Reads a file; one that was read already is shared.
///
/// # Errors
/// Those of the format's reader; [`HousesError::Empty`] without a triangle.
pub(super) fn load(
    session: &mut EditSession<'_>,
    name: &str,
    scale: f32,
    up: UpAxis,
) -> Result<Arc<LoadedMesh>, HousesError> {
    let scale = check_range(
        "scale",
        scale,
        [1e-6, 1e6],
        "metres for one unit of the file",
    )?;
    let key = format!("{name}\n{scale}\n{up:?}");
    if let Some(known) = session.meshes.get(&key) {
        return Ok(known.clone());
    }
    let path = session.files.resolve_path("path", name)?;
    let mut report = LoadReport::new();
    let scene = read(&path, session.threads, &mut report)?;
    let turn = match up {
        UpAxis::Y => Quat::IDENTITY,
        UpAxis::Z => Quat::from_xyzw(
            -std::f32::consts::FRAC_1_SQRT_2,
            0.0,
            0.0,
            std::f32::consts::FRAC_1_SQRT_2,
        ),
    };
    let ours_from_file =
        Affine3A::from_scale_rotation_translation(Vec3::splat(scale), turn, Vec3::ZERO);
    let pieces: Vec<(Arc<Mesh>, Vec<MaterialId>)> = scene
        .nodes
        .into_iter()
        .map(|thing| {
            let map = ours_from_file * thing.world_from_mesh;
            let whole = map.is_finite() && map.matrix3.determinant().abs() > 1e-30;
            let mesh = if whole {
                thing.mesh.transformed(&map)
            } else {
                Mesh::default()
            };
            (Arc::new(mesh), thing.materials)
        })
        .collect();
    let (mut mesh, materials) = merge_meshes(&pieces);
    if mesh.triangles.is_empty() {
        let at = FileLocation::file(path.display().to_string());
        return Err(HousesError::empty(&at, &report));
    }
    if mesh.bounds().size().max_element() > 1_000.0 {
        let found = format!("{:?} m", mesh.bounds().size().to_array());
        return Err(invalid_field("scale", found, "a thing of at most 1000 m"));
    }
    mesh.shrink_to_fit();
    let mut data = HouseData {
        materials: scene.materials.finish_materials(),
        textures: scene.textures.into(),
        ..HouseData::default()
    };
    data.meshes.push(Arc::new(mesh));
    session.report.append(report);
    let loaded = Arc::new(LoadedMesh { data, materials });
    session.meshes.insert(key, loaded.clone());
    Ok(loaded)
}

fn read(
    path: &Path,
    threads: dwell_scene::parallel::Threads,
    report: &mut LoadReport,
) -> Result<ImportedScene, HousesError> {
    std::fs::metadata(path).map_err(HousesError::io(path))?;
    if crate::obj::recognizes(path) {
        let (scene, at) = crate::obj::read_scene(path, threads, report)?;
        let unread = report
            .warnings()
            .iter()
            .find(|w| matches!(w.kind, WarningKind::UnreadableMesh { .. }));
        return match unread {
            Some(warning) => Err(HousesError::Syntax {
                at,
                message: warning.kind.to_string(),
            }),
            None => Ok(scene),
        };
    }
    if crate::gltf::recognizes(path) {
        let UserFile { root, name, bytes } = UserFile::read(path, MAX_BUFFER_BYTES)?;
        return crate::gltf::read_scene(&bytes, &root, &name, threads, report);
    }
    let found = format!("{:?}", path.display().to_string());
    Err(invalid_field("path", found, "a .glb, .gltf or .obj"))
}
