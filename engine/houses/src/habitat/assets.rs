//! Mesh files of a data set, each read once, with their materials in the house's tables.

use std::collections::BTreeMap;
use std::sync::Arc;

use dwell_scene::parallel::Threads;
use dwell_scene::{Aabb, HouseData, MaterialId, Mesh, MeshId, TextureId};

use super::dataset::ResolvedTemplate;
use crate::data_root::{DataRoot, parent_folder};
use crate::gltf;
use crate::import::{HullPointSets, ImportedScene, UniqueNames, merge_meshes};
use crate::limits::MAX_BUFFER_BYTES;
use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;

/// A named piece of an asset, its transform baked into the mesh.
#[derive(Debug, Clone)]
pub(super) struct AssetMesh {
    pub(super) name: String,
    pub(super) mesh: Arc<Mesh>,
    pub(super) materials: Vec<MaterialId>,
}

/// An asset as one mesh.
#[derive(Debug, Clone)]
pub(super) struct MergedAsset {
    pub(super) mesh: MeshId,
    pub(super) bounds: Aabb,
    pub(super) materials: Vec<MaterialId>,
}

/// Assets that were read.
#[derive(Debug, Default)]
pub(super) struct AssetCache {
    pieces: BTreeMap<String, Option<Arc<Vec<AssetMesh>>>>,
    wholes: BTreeMap<String, Option<MergedAsset>>,
    shapes: BTreeMap<String, Option<Arc<HullPointSets>>>,
    whole_shapes: BTreeMap<String, Arc<HullPointSets>>,
    material_names: UniqueNames,
}

impl AssetCache {
    /// The path inside the root of an asset that a template names; `None`, reported, when it leaves the root.
    pub(super) fn path(
        template: &ResolvedTemplate,
        asset: &str,
        report: &mut LoadReport,
    ) -> Option<String> {
        let path = DataRoot::resolve(&template.folder, asset);
        if path.is_err() {
            let path = asset.to_owned();
            report.warn(template.at.clone(), WarningKind::PathRefused { path });
        }
        path.ok()
    }

    /// The pieces of the asset at `path`; `None`, reported once, when it cannot be read.
    pub(super) fn asset_meshes(
        &mut self,
        root: &DataRoot,
        path: &str,
        data: &mut HouseData,
        threads: Threads,
        report: &mut LoadReport,
    ) -> Option<Arc<Vec<AssetMesh>>> {
        if let Some(known) = self.pieces.get(path) {
            return known.clone();
        }
        let read = self.read(root, path, data, threads, report).map(Arc::new);
        self.pieces.insert(path.to_owned(), read.clone());
        read
    }

    fn read(
        &mut self,
        root: &DataRoot,
        path: &str,
        data: &mut HouseData,
        threads: Threads,
        report: &mut LoadReport,
    ) -> Option<Vec<AssetMesh>> {
        let at = FileLocation::file(path);
        let path_owned = || path.to_owned();
        if !root.exists(path) {
            report.warn(at, WarningKind::MissingMesh { path: path_owned() });
            return None;
        }
        let scene = match read_scene(root, path, threads, report) {
            Ok(scene) => scene,
            Err(reason) => {
                let path = path_owned();
                report.warn(at, WarningKind::UnreadableMesh { path, reason });
                return None;
            }
        };
        let first_texture = data.textures.len() as u32;
        for texture in scene.textures {
            data.textures.push(texture);
        }
        let mut ids = Vec::new();
        for mut material in scene.materials.finish_materials().iter().cloned() {
            material.texture = material.texture.map(|id| TextureId(id.0 + first_texture));
            material.name = self.material_names.unique(&material.name);
            ids.push(data.materials.push(material));
        }
        let mut pieces = Vec::new();
        for thing in scene.nodes {
            let mesh = thing.mesh.transformed(&thing.world_from_mesh);
            let own = thing
                .materials
                .iter()
                .filter_map(|id| ids.get(id.0 as usize));
            pieces.push(AssetMesh {
                name: thing.name,
                mesh: Arc::new(mesh),
                materials: own.copied().collect(),
            });
        }
        if pieces.iter().all(|piece| piece.mesh.triangles.is_empty()) {
            report.warn(at, WarningKind::EmptyMesh { path: path_owned() });
            return None;
        }
        Some(pieces)
    }

    /// The pieces of `whole`, the asset at `path`: its collision shape.
    pub(super) fn collision_shape_of_merged(
        &mut self,
        path: &str,
        whole: &MergedAsset,
        data: &HouseData,
    ) -> Arc<HullPointSets> {
        let shape = || Arc::new(HullPointSets::from_mesh(&data.meshes[whole.mesh]));
        let known = self.whole_shapes.entry(path.to_owned());
        known.or_insert_with(shape).clone()
    }

    /// The pieces of the asset at `path`, which the house does not hold: a collision shape. `None`, reported once, when
    /// it cannot be read.
    pub(super) fn collision_shape(
        &mut self,
        root: &DataRoot,
        path: &str,
        threads: Threads,
        report: &mut LoadReport,
    ) -> Option<Arc<HullPointSets>> {
        if let Some(known) = self.shapes.get(path) {
            return known.clone();
        }
        let shape = match read_scene(root, path, threads, report) {
            Ok(scene) => {
                let mut shape = Mesh::default();
                for thing in scene.nodes {
                    shape.append(&thing.mesh.transformed(&thing.world_from_mesh), 0);
                }
                Some(Arc::new(HullPointSets::from_mesh(&shape)))
            }
            Err(reason) => {
                let path = path.to_owned();
                report.warn(
                    FileLocation::file(&path),
                    WarningKind::UnreadableMesh { path, reason },
                );
                None
            }
        };
        self.shapes.insert(path.to_owned(), shape.clone());
        shape
    }

    /// The asset at `path` as one mesh of the house.
    pub(super) fn merged_asset(
        &mut self,
        root: &DataRoot,
        path: &str,
        data: &mut HouseData,
        threads: Threads,
        report: &mut LoadReport,
    ) -> Option<MergedAsset> {
        if let Some(known) = self.wholes.get(path) {
            return known.clone();
        }
        let pieces = self.asset_meshes(root, path, data, threads, report);
        let whole = pieces.map(|pieces| {
            let pieces = pieces
                .iter()
                .map(|piece| (piece.mesh.clone(), piece.materials.clone()));
            let (shape, materials) = merge_meshes(&pieces.collect::<Vec<_>>());
            MergedAsset {
                bounds: shape.bounds(),
                mesh: data.meshes.push(Arc::new(shape)),
                materials,
            }
        });
        self.wholes.insert(path.to_owned(), whole.clone());
        whole
    }
}

fn read_scene(
    root: &DataRoot,
    path: &str,
    threads: Threads,
    report: &mut LoadReport,
) -> Result<ImportedScene, String> {
    let ending = path.rsplit('.').next().unwrap_or("").to_ascii_lowercase();
    if ending != "glb" && ending != "gltf" {
        return Err(format!(
            "a mesh that ends in .{ending}; .glb and .gltf are read"
        ));
    }
    let bytes = root
        .read(path, MAX_BUFFER_BYTES)
        .map_err(|error| error.reason())?;
    let folder = DataRoot::new(root.folder().join(parent_folder(path)));
    let folder = folder.map_err(|error| error.reason())?;
    let name = path.rsplit('/').next().unwrap_or(path);
    gltf::read_scene(&bytes, &folder, name, threads, report).map_err(|error| error.reason())
}
