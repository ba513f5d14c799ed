//! Conversion of an OBJ file into a house: an object, or a scene of named ones.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;

use dwell_scene::material::library;
use dwell_scene::parallel::Threads;
use dwell_scene::{House, MaterialId, Mesh, TextureId};
use glam::Affine3A;

use super::file::FaceGroup;
use super::load::{ParsedObj, parse_obj_with_mtl};
use super::read_obj;
use super::shape::{MAX_SLOTS, MaterialSlots, ObjGroupSelection, build_mesh};
use crate::data_root::DataRoot;
use crate::error::HousesError;
use crate::import::{
    ImportedMaterial, ImportedScene, MaterialTableBuilder, NodeRole, SceneNode, read_images,
    substance_of, texture_name,
};
use crate::limits::{MAX_MESH_BYTES, MAX_NODES};
use crate::report::{FileLocation, LoadReport};

/// Returns whether `path` names an OBJ file.
pub(crate) fn recognizes(path: &Path) -> bool {
    path.extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("obj"))
}

/// Opens an OBJ file with its materials and textures. Every `o` is an object; without one the file is.
///
/// Units are metres and +Y is up, as in SUNCG; the format says neither.
///
/// # Errors
/// [`HousesError::Io`] when the file cannot be read, [`HousesError::Empty`] when it holds no triangle,
/// [`HousesError::Scene`] when the result breaks a rule of the scene. Everything else is reported.
pub fn open(path: &Path, threads: Threads) -> Result<(House, LoadReport), HousesError> {
    let mut report = LoadReport::new();
    let (scene, at) = read_scene(path, threads, &mut report)?;
    let house = scene.into_house(&at, &mut report)?;
    Ok((house, report))
}

/// The named meshes of a file with their materials and images, and the file's place in its root.
///
/// # Errors
/// Those of [`open`] up to what the scene's own rules say.
pub(crate) fn read_scene(
    path: &Path,
    threads: Threads,
    report: &mut LoadReport,
) -> Result<(ImportedScene, FileLocation), HousesError> {
    std::fs::metadata(path).map_err(HousesError::io(path))?;
    let (root, inside) = locate(path)?;
    let at = FileLocation::file(&inside);
    let bytes = root.read_user_named(&inside, MAX_MESH_BYTES)?;
    let files = parse_obj_with_mtl(&bytes, &root, &inside, report);
    let wanted: BTreeSet<String> = files.textures.iter().flatten().cloned().collect();
    let images = read_images(&root, wanted, threads, report);
    let slots = MaterialSlots::from_obj_and_mtl(&files.obj, &files.mtl, &at, report);
    if slots.left_out > 0 {
        return Err(HousesError::TooLarge {
            at: at.field("mtllib"),
            what: "count of materials",
            found: (slots.entries.len() + slots.left_out) as u64,
            allowed: MAX_SLOTS as u64,
        });
    }
    let texture_ids: BTreeMap<&str, TextureId> = images
        .keys()
        .enumerate()
        .map(|(k, path)| (path.as_str(), TextureId(k as u32)))
        .collect();
    let mut looks = MaterialTableBuilder::default();
    let materials: Vec<MaterialId> = slots
        .entries
        .iter()
        .map(|(name, in_file)| looks.add(&imported_material(&files, name, *in_file, &texture_ids)))
        .collect();
    let name = texture_name(&inside);
    let mut things: Vec<(String, Vec<(u16, &FaceGroup)>)> = Vec::new();
    let mut places: BTreeMap<&str, usize> = BTreeMap::new();
    for run in &files.obj.face_groups {
        let thing = if run.object.is_empty() {
            &name
        } else {
            &run.object
        };
        let run = (slots.slot_of_group(run), run);
        let place = *places.entry(thing).or_insert(things.len());
        match things.get_mut(place) {
            Some((_, runs)) => runs.push(run),
            None => things.push((thing.clone(), vec![run])),
        }
    }
    if things.len() > MAX_NODES {
        return Err(HousesError::TooLarge {
            at: at.field("o"),
            what: "count of things",
            found: things.len() as u64,
            allowed: MAX_NODES as u64,
        });
    }
    let box_mapping = !texture_ids.is_empty();
    let things = things
        .into_iter()
        .map(|(name, runs)| {
            let mesh = build_mesh(
                &ObjGroupSelection {
                    obj: &files.obj,
                    face_groups: runs,
                    box_mapping,
                },
                &at,
                report,
            );
            SceneNode {
                name,
                mesh: Arc::new(mesh),
                world_from_mesh: Affine3A::IDENTITY,
                materials: materials.clone(),
                level: None,
                room: None,
                role: NodeRole::Unspecified,
                part_of: None,
            }
        })
        .collect();
    let textures = images.into_values().collect();
    let scene = ImportedScene {
        name,
        source: "obj",
        nodes: things,
        materials: looks,
        textures,
        levels: Vec::new(),
        rooms: Vec::new(),
        sky: None,
        lamps: Vec::new(),
        objects: Vec::new(),
    };
    Ok((scene, at))
}

/// All faces of an OBJ file as one mesh, without materials.
pub(crate) fn mesh_without_materials(bytes: &[u8], path: &str, report: &mut LoadReport) -> Mesh {
    let obj = read_obj(bytes, path, report);
    let shape = ObjGroupSelection {
        face_groups: obj.face_groups.iter().map(|run| (0, run)).collect(),
        obj: &obj,
        box_mapping: false,
    };
    build_mesh(&shape, &FileLocation::file(path), report)
}

/// The folder that bounds the file's paths, and the file in it: the data root if the file is a SUNCG model, whose
/// textures lie outside of its own folder.
fn locate(path: &Path) -> Result<(DataRoot, String), HousesError> {
    let name = path
        .file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    let folder = path.parent().unwrap_or_else(|| Path::new(""));
    let real = DataRoot::new(folder)?
        .folder()
        .canonicalize()
        .map_err(HousesError::io(folder))?;
    let part = |steps: usize| {
        Some(
            real.ancestors()
                .nth(steps)?
                .file_name()?
                .to_string_lossy()
                .into_owned(),
        )
    };
    match (part(1), part(0), real.ancestors().nth(2)) {
        (Some(kind), Some(id), Some(root))
            if (kind == "object" || kind == "room") && root.join("texture").is_dir() =>
        {
            Ok((DataRoot::new(root)?, format!("{kind}/{id}/{name}")))
        }
        _ => Ok((DataRoot::new(folder)?, name)),
    }
}

fn imported_material(
    files: &ParsedObj,
    name: &str,
    in_file: Option<usize>,
    textures: &BTreeMap<&str, TextureId>,
) -> ImportedMaterial {
    let Some(k) = in_file else {
        let substance = substance_of(name).unwrap_or_else(|| library().default_substance());
        return ImportedMaterial::plain(if name.is_empty() { "default" } else { name }, substance);
    };
    let material = &files.mtl.materials[k];
    let path = files.textures[k]
        .as_deref()
        .filter(|path| textures.contains_key(path));
    let named = path.and_then(substance_of).or_else(|| substance_of(name));
    let opacity = material.opacity.unwrap_or(1.0);
    let usual = || {
        if opacity < 1.0 {
            library().get_or_default("glass")
        } else {
            library().default_substance()
        }
    };
    ImportedMaterial {
        srgb: material.diffuse.unwrap_or([1.0; 3]),
        texture: path.map(|path| textures[path]),
        opacity,
        emission: material.emission.unwrap_or([0.0; 3]),
        roughness: material.roughness(),
        ..ImportedMaterial::plain(name, named.unwrap_or_else(usual))
    }
}
