//! Reading of `NAME.dwell/`.

use std::collections::BTreeMap;
use std::io;
use std::path::Path;
use std::sync::Arc;

use dwell_scene::parallel::Threads;
use dwell_scene::{House, HouseData, Id, Mesh, MeshId, SoundFile, interrupt};
use glam::{Vec2, Vec3};

use super::file::{FORMAT, FormatHeader, NativeFile, VERSIONS, sound_path};
use super::{GEOMETRY, TABLES};
use crate::data_root::DataRoot;
use crate::error::HousesError;
use crate::gltf::{MeshAccessors, ParsedGlb, VertexBudget};
use crate::import::PixelBudget;
use crate::json;
use crate::limits::{MAX_ALL_SOUND_BYTES, MAX_BUFFER_BYTES, MAX_TEXT_BYTES};
use crate::report::{FileLocation, LoadReport};

/// Opens a native house.
///
/// # Errors
/// [`HousesError::Io`] when a file is missing, [`HousesError::Version`] for another version, [`HousesError::Syntax`]
/// with the line or field for content that is not of this form or not what its name says, [`HousesError::Scene`] when the tables
/// break a rule of the scene. The form is exact, so nothing is survived and the report stays empty.
pub fn open(path: &Path, threads: Threads) -> Result<(House, LoadReport), HousesError> {
    let meta = std::fs::metadata(path).map_err(HousesError::io(path))?;
    if !meta.is_dir() {
        let what = format!("is no folder; a .dwell is one, with {TABLES} and {GEOMETRY}");
        let source = io::Error::new(io::ErrorKind::NotADirectory, what);
        return Err(HousesError::io(path)(source));
    }
    let house = read(path, threads).map_err(|error| {
        let name = path.file_name().unwrap_or(path.as_os_str());
        error.in_folder(&name.to_string_lossy())
    })?;
    Ok((house, LoadReport::new()))
}

/// Reads the house; places in errors are relative to its folder.
fn read(path: &Path, threads: Threads) -> Result<House, HousesError> {
    let root = DataRoot::new(path)?;
    let text = root.read(TABLES, MAX_TEXT_BYTES)?;
    let at = FileLocation::file(TABLES);
    let syntax = json::syntax(&at);
    let head: FormatHeader = json::from_slice(&text).map_err(&syntax)?;
    if head.format != FORMAT {
        let found = format!("{:?}", head.format);
        return Err(HousesError::Field {
            at: at.field("format"),
            expected: "\"dwell-house\"",
            found,
        });
    }
    if !VERSIONS.contains(&head.version) {
        let allowed = VERSIONS.map(|version| version.to_string()).to_vec();
        let found = head.version.to_string();
        return Err(HousesError::Version {
            at: at.field("version"),
            found,
            allowed,
        });
    }
    let file: NativeFile = json::from_slice(&text).map_err(&syntax)?;
    let bytes = root.read(GEOMETRY, MAX_BUFFER_BYTES)?;
    // Houses that were written together share the files beside them.
    let library = DataRoot::new(path.join("../.."))?;
    let geometry = ParsedGlb::read(&bytes, GEOMETRY, &library)?;
    let mut data = file.house;
    for mesh in read_meshes(&geometry, &file.mesh_accessors, threads)? {
        data.meshes.push(mesh);
    }
    check_shown(&data)?;
    let sizes = &file.texture_sizes;
    let mut budget = PixelBudget::default();
    for (k, [width, height]) in sizes.iter().enumerate() {
        let at = FileLocation::file(TABLES).field(format_args!("texture_sizes[{k}]"));
        budget
            .reserve(u64::from(*width) * u64::from(*height))
            .map_err(|message| HousesError::Syntax { at, message })?;
    }
    let textures = threads.map(sizes.len(), |k| geometry.texture(k, sizes[k]));
    for (k, texture) in textures.into_iter().enumerate() {
        let at = FileLocation::file(GEOMETRY).field(format_args!("images[{k}]"));
        data.textures.push(Arc::new(
            texture.map_err(|message| HousesError::Syntax { at, message })?,
        ));
    }
    let mut left = MAX_ALL_SOUND_BYTES;
    for (k, name) in file.sound_names.into_iter().enumerate() {
        let path = sound_path(k, &name);
        let bytes = root.read(&path, left.min(SoundFile::MAX_BYTES))?;
        left -= bytes.len() as u64;
        data.sound_files.push(Arc::new(SoundFile { name, bytes }));
    }
    House::new(data).map_err(HousesError::scene(&at))
}

/// Reads the mesh of each row; rows that are the same share one.
///
/// # Errors
/// [`HousesError::Syntax`] with the row that cannot be read, or with which there are more vertices and indices than are read.
fn read_meshes(
    geometry: &ParsedGlb<'_>,
    rows: &[MeshAccessors],
    threads: Threads,
) -> Result<Vec<Arc<Mesh>>, HousesError> {
    let fault = |k: usize, message: String| HousesError::Syntax {
        at: FileLocation::file(TABLES).field(format_args!("mesh_accessors[{k}]")),
        message,
    };
    let mut budget = VertexBudget::default();
    // The first row of each mesh, and the mesh of each row.
    let (mut firsts, mut meshes) = (Vec::new(), Vec::with_capacity(rows.len()));
    let mut known: BTreeMap<&MeshAccessors, usize> = BTreeMap::new();
    for (k, row) in rows.iter().enumerate() {
        interrupt::unwind_if_cancelled();
        let count = |accessor: Option<usize>| accessor.map_or(0, |k| geometry.count(k));
        let vertices = [row.positions, row.normals, row.uvs].map(count);
        let vertices = vertices.into_iter().max().unwrap_or(0);
        let indices = count(row.triangles).max(count(row.slots));
        let reserved = budget.reserve(vertices, indices);
        reserved.map_err(|message| fault(k, message))?;
        meshes.push(*known.entry(row).or_insert_with(|| {
            firsts.push(k);
            firsts.len() - 1
        }));
    }
    let read = threads.map(firsts.len(), |k| read_mesh(geometry, &rows[firsts[k]]));
    let read = read.into_iter().zip(&firsts).map(|(mesh, first)| {
        let mesh = mesh.map_err(|message| fault(*first, message));
        mesh.map(Arc::new)
    });
    let read = read.collect::<Result<Vec<_>, _>>()?;
    Ok(meshes.into_iter().map(|k| read[k].clone()).collect())
}

/// Refuses tables that show more vertices and indices than are read: all pieces may show the same mesh.
fn check_shown(data: &HouseData) -> Result<(), HousesError> {
    let mut budget = VertexBudget::default();
    let mut show = |table: &str, k: usize, mesh: MeshId| {
        interrupt::unwind_if_cancelled();
        // A mesh that does not exist is a fault of the scene.
        let Some(mesh) = data.meshes.as_slice().get(mesh.index()) else {
            return Ok(());
        };
        let reserved = budget.reserve(mesh.positions.len(), 3 * mesh.triangles.len());
        reserved.map_err(|message| HousesError::Syntax {
            at: FileLocation::file(TABLES).field(format_args!("house.{table}[{k}].mesh")),
            message,
        })
    };
    for (k, piece) in data.structure.iter().enumerate() {
        show("structure", k, piece.mesh)?;
    }
    for (k, part) in data.parts.iter().enumerate() {
        show("parts", k, part.mesh)?;
    }
    Ok(())
}

fn read_mesh(geometry: &ParsedGlb<'_>, accessors: &MeshAccessors) -> Result<Mesh, String> {
    let triples =
        |accessor: Option<usize>| accessor.map_or(Ok(Vec::new()), |k| geometry.floats::<3>(k));
    let whole = |accessor: Option<usize>| accessor.map_or(Ok(Vec::new()), |k| geometry.indices(k));
    let indices = whole(accessors.triangles)?;
    if indices.len() % 3 != 0 {
        return Err(format!("{} indices make no triangles", indices.len()));
    }
    let slots = whole(accessors.slots)?
        .into_iter()
        .map(u16::try_from)
        .collect::<Result<_, _>>();
    Ok(Mesh {
        positions: triples(accessors.positions)?
            .into_iter()
            .map(Vec3::from)
            .collect(),
        normals: triples(accessors.normals)?
            .into_iter()
            .map(Vec3::from)
            .collect(),
        uvs: accessors
            .uvs
            .map_or(Ok(Vec::new()), |k| geometry.floats::<2>(k))?
            .into_iter()
            .map(Vec2::from)
            .collect(),
        triangles: indices
            .chunks_exact(3)
            .map(|t| [t[0], t[1], t[2]])
            .collect(),
        slots: slots.map_err(|_| "a slot above 65535".to_owned())?,
    })
}
