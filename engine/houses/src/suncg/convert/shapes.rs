//! Meshes of the models, each made once and shared by all instances.

use std::collections::BTreeMap;
use std::sync::Arc;

use dwell_scene::parallel::Threads;
use dwell_scene::{IdVec, Mesh, MeshId};

use super::super::file::SuncgNode;
use super::super::read::{ParsedSuncgFiles, paths};
use super::hinge::{self, MeshHinge};
use crate::import::{components, submesh};
use crate::obj::ParsedObj;
use crate::obj::{MaterialSlots, ObjGroupSelection, build_mesh};
use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;

/// The mesh of one OBJ file of a model.
pub(super) struct ModelShape {
    pub(super) slots: MaterialSlots,
    pub(super) full_mesh: DeferredMesh,
    /// Its leaf and hinge, when a hinge explains its two states.
    pub(super) hinged: Option<HingedModel>,
}

/// A mesh that becomes part of the house at its first use.
pub(super) struct DeferredMesh {
    pub(super) mesh: Arc<Mesh>,
    id: Option<MeshId>,
}

/// A model that is split at its hinge.
pub(super) struct HingedModel {
    /// The fixed part, if there is one.
    pub(super) frame: Option<DeferredMesh>,
    /// The part that turns.
    pub(super) leaf: DeferredMesh,
    /// The hinge, and the turn to the model's other state.
    pub(super) hinge: MeshHinge,
}

impl DeferredMesh {
    fn new(mesh: Mesh) -> Self {
        Self {
            mesh: Arc::new(mesh),
            id: None,
        }
    }

    /// Its id in the house.
    pub(super) fn id(&mut self, meshes: &mut IdVec<MeshId, Arc<Mesh>>) -> MeshId {
        *self
            .id
            .get_or_insert_with(|| meshes.push(self.mesh.clone()))
    }
}

/// The shapes of all models in use, by path of their OBJ file.
pub(super) struct ModelShapes {
    shapes: BTreeMap<String, ModelShape>,
}

impl ModelShapes {
    /// Makes the shapes, several at once.
    pub(super) fn build(
        files: &ParsedSuncgFiles,
        threads: Threads,
        report: &mut LoadReport,
    ) -> Self {
        // Model ids in use, and whether some instance puts a texture on it.
        let mut models: BTreeMap<&str, bool> = BTreeMap::new();
        for node in files.house.levels.iter().flat_map(|level| &level.nodes) {
            if let (true, Some("Object"), Some(model)) = (
                node.is_valid(),
                node.kind.as_deref(),
                node.model_id.as_deref(),
            ) {
                *models.entry(model).or_default() |= overrides_texture(files, node);
            }
        }
        let models: Vec<_> = models
            .into_iter()
            .filter(|(model, _)| paths::is_safe_file_name(model))
            .collect();
        let built = threads.map(models.len(), |k| {
            let (model, textured) = models[k];
            let mut report = LoadReport::new();
            let shapes = shapes_of_states(files, model, textured, &mut report);
            (shapes, report)
        });
        let mut shapes = BTreeMap::new();
        for (of_model, own) in built {
            report.append(own);
            shapes.extend(of_model);
        }
        Self { shapes }
    }

    /// The shape of an OBJ file; `None` when it does not exist or is empty.
    pub(super) fn get_mut(&mut self, path: &str) -> Option<&mut ModelShape> {
        self.shapes.get_mut(path)
    }
}

fn overrides_texture(files: &ParsedSuncgFiles, node: &SuncgNode) -> bool {
    let table = node
        .material_indices
        .as_ref()
        .map_or(&[][..], |_| files.house.materials.as_slice());
    node.materials
        .iter()
        .flatten()
        .chain(table)
        .any(|material| material.texture.is_some())
}

/// The shapes of a model's one or two states.
fn shapes_of_states(
    files: &ParsedSuncgFiles,
    model: &str,
    textured: bool,
    report: &mut LoadReport,
) -> Vec<(String, ModelShape)> {
    let mut shapes = Vec::new();
    for second in [false, true] {
        let path = paths::model_mesh_path(model, second);
        let Some(mesh_files) = files.meshes.get(&path) else {
            continue;
        };
        let at = FileLocation::file(&path);
        let slots = MaterialSlots::from_obj_and_mtl(&mesh_files.obj, &mesh_files.mtl, &at, report);
        let mesh = model_mesh(mesh_files, &slots, textured, &at, report);
        if mesh.triangles.is_empty() {
            report.warn(at, WarningKind::EmptyMesh { path });
            continue;
        }
        shapes.push((
            path,
            ModelShape {
                slots,
                full_mesh: DeferredMesh::new(mesh),
                hinged: None,
            },
        ));
    }
    if let [(_, first), (_, second)] = shapes.as_mut_slice() {
        split_at_hinge(first, second);
    }
    shapes
}

fn model_mesh(
    files: &ParsedObj,
    slots: &MaterialSlots,
    textured: bool,
    at: &FileLocation,
    report: &mut LoadReport,
) -> Mesh {
    let box_mapping = textured || files.textures.iter().any(Option::is_some);
    let runs = files
        .obj
        .face_groups
        .iter()
        .map(|run| (slots.slot_of_group(run), run))
        .collect();
    build_mesh(
        &ObjGroupSelection {
            obj: &files.obj,
            face_groups: runs,
            box_mapping,
        },
        at,
        report,
    )
}

/// Finds the hinge between the two states of a model and splits both meshes at it.
fn split_at_hinge(first: &mut ModelShape, second: &mut ModelShape) {
    let pieces = [
        components(&first.full_mesh.mesh),
        components(&second.full_mesh.mesh),
    ];
    let Some(found) = hinge::fit([&first.full_mesh.mesh, &second.full_mesh.mesh], &pieces) else {
        return;
    };
    for ((shape, moving), hinge) in [first, second]
        .into_iter()
        .zip(found.moving)
        .zip([found.hinge, found.hinge.reversed()])
    {
        let mesh = &shape.full_mesh.mesh;
        let mut is_moving = vec![false; mesh.triangles.len()];
        for k in &moving {
            is_moving[*k as usize] = true;
        }
        let still: Vec<u32> = (0..mesh.triangles.len() as u32)
            .filter(|k| !is_moving[*k as usize])
            .collect();
        let frame = (!still.is_empty()).then(|| DeferredMesh::new(submesh(mesh, &still)));
        shape.hinged = Some(HingedModel {
            frame,
            leaf: DeferredMesh::new(submesh(mesh, &moving)),
            hinge,
        });
    }
}
