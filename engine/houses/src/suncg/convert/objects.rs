//! Conversion of object and box nodes: their names, poses and looks.

use std::sync::Arc;

use dwell_scene::{Category, Pose, RoomId, space};
use glam::{Affine3A, DAffine3, Vec3};

use super::super::file::{BinaryFlag, SuncgMaterial, SuncgNode};
use super::super::read::paths;
use super::parts::{ObjectDraft, PartMesh, hinge_on_part};
use super::{Converter, NodeKey, boxes, mobility, place};
use crate::import::CategoryRow;
use crate::report::FileLocation;
use crate::warning_kind::{UnmappedKind, WarningKind};

impl<'a> Converter<'a> {
    pub(super) fn objects(&mut self) {
        let rooms = self.node_rooms();
        for (key, node) in self.files.house.valid_nodes() {
            let room = rooms.get(&key).copied();
            match node.kind.as_deref() {
                Some("Object") => self.object(key, node, room),
                Some("Box") => self.box_object(key, node, room),
                Some("Room" | "Ground") => {}
                kind => {
                    let found = kind.unwrap_or("").to_owned();
                    self.report.warn(
                        self.node_at(key).field("type"),
                        WarningKind::UnknownNodeType { found },
                    );
                }
            }
        }
        self.fix_floating_objects();
    }

    fn object(&mut self, key: NodeKey, node: &'a SuncgNode, room: Option<RoomId>) {
        let at = self.node_at(key);
        let Some(model) = node.model_id.as_deref() else {
            let damage = WarningKind::MissingField {
                consequence: "the object is left out".to_owned(),
            };
            return self.report.warn(at.field("modelId"), damage);
        };
        if let Some(damage) = paths::invalid_id_reason(model) {
            return self.report.warn(at.field("modelId"), damage);
        }
        let Some((pose, part_from_mesh)) = self.placement(node, &at) else {
            return;
        };
        let Some(path) = self.mesh_of_state(model, node, &at) else {
            return;
        };
        let entry = self.files.categories.get(model);
        let category = entry.map(|e| Category {
            fine: e.fine.clone(),
            coarse: e.coarse.clone(),
            nyu40: e.nyu40.clone(),
        });
        let category = category.unwrap_or_default();
        let row = crate::import::category([category.fine.as_str(), category.coarse.as_str()]);
        // A table without the model, or an unknown class.
        if row.is_none() && !self.files.categories.is_empty() {
            self.report.warn(
                at.field("modelId"),
                WarningKind::Unmapped {
                    what: UnmappedKind::Category,
                    name: model.to_owned(),
                },
            );
        }
        let moves = mobility::is_movable_kind(row, entry);
        let plan = ObjectDraft {
            key,
            at,
            model,
            category,
            row,
            moves,
            room,
            pose,
            part_from_mesh,
        };
        self.model_object(&plan, &path, node);
    }

    /// Returns a node's rigid pose, and the scale and mirror that its mesh keeps.
    fn placement(&mut self, node: &SuncgNode, at: &FileLocation) -> Option<(Pose, Affine3A)> {
        let at = at.field("transform");
        let matrix = match place::transform(node.transform.as_deref()) {
            Ok(matrix) => matrix,
            Err(reason) => {
                self.report.warn(at, WarningKind::BadTransform { reason });
                return None;
            }
        };
        let mirrors = matrix.determinant() < 0.0;
        if let Some(BinaryFlag(stated)) = node.is_mirrored.filter(|flag| flag.0 != mirrors) {
            let (found, expected) = (
                u8::from(stated).to_string(),
                format!("{}, as the transform has it", u8::from(mirrors)),
            );
            self.report
                .warn(at.clone(), WarningKind::BadField { found, expected });
        }
        let world_from_mesh = self.world_from_file * DAffine3::from_mat4(matrix).as_affine3a();
        let split = space::split_affine(&world_from_mesh);
        if split.is_none() {
            let reason = "it flattens space".to_owned();
            self.report.warn(at, WarningKind::BadTransform { reason });
        }
        split.map(|(pose, rest)| (pose, place::snap_to_integers(rest)))
    }

    /// The OBJ file of a node's state: `_0` for state 1 where it exists.
    fn mesh_of_state(
        &mut self,
        model: &str,
        node: &SuncgNode,
        at: &FileLocation,
    ) -> Option<String> {
        let second = node.state.is_some_and(|state| (state - 1.0).abs() < 1e-9);
        let path = paths::model_mesh_path(model, second);
        if self.shapes.get_mut(&path).is_some() {
            return Some(path);
        }
        let base = paths::model_mesh_path(model, false);
        if second && self.shapes.get_mut(&base).is_some() {
            self.report.warn(
                at.field("state"),
                WarningKind::MissingVariant { state: 1, path },
            );
            return Some(base);
        }
        // An empty or unreadable file was reported when it was read.
        if !self.files.meshes.contains_key(&path) && !self.files.unreadable.contains(&path) {
            self.report
                .warn(at.clone(), WarningKind::MissingMesh { path });
        }
        None
    }

    fn model_object(&mut self, plan: &ObjectDraft<'a>, path: &str, node: &'a SuncgNode) {
        let overrides = self.overrides(node, &plan.at);
        let Some(files) = self.files.meshes.get(path) else {
            return;
        };
        let Some(shape) = self.shapes.get_mut(path) else {
            return;
        };
        let slots = shape.slots.clone();
        let hinge = shape
            .hinged
            .as_ref()
            .and_then(|swing| hinge_on_part(&swing.hinge, &plan.part_from_mesh));
        let meshes = match (&mut shape.hinged, hinge) {
            (Some(swing), Some(_)) => {
                let frame = swing
                    .frame
                    .as_mut()
                    .map(|frame| ("frame", frame.id(&mut self.data.meshes)));
                let leaf = ("leaf", swing.leaf.id(&mut self.data.meshes));
                frame.into_iter().chain([leaf]).collect()
            }
            _ => vec![("body", shape.full_mesh.id(&mut self.data.meshes))],
        };
        let two_states = self
            .files
            .meshes
            .contains_key(&paths::model_mesh_path(plan.model, true));
        if two_states && hinge.is_none() {
            let what = format!(
                "the two states of model {:?} are not one upright hinge; it does not move",
                plan.model
            );
            self.report
                .warn(plan.at.clone(), WarningKind::Simplified { what });
        }
        if !two_states && plan.category.coarse == "door" {
            let what = format!(
                "door model {:?} has one state only; it does not move",
                plan.model
            );
            self.report
                .warn(plan.at.clone(), WarningKind::Simplified { what });
        }
        let usual = plan.row.map_or_else(
            || dwell_scene::material::library().default_substance(),
            CategoryRow::substance,
        );
        let emissive = self.files.lights.emissive_slots(plan.model).to_vec();
        let materials =
            self.object_materials(files, &slots, &overrides, usual, &emissive, &plan.at);
        let shapes = meshes
            .into_iter()
            .map(|(name, mesh)| PartMesh {
                name,
                mesh,
                materials: materials.clone(),
            })
            .collect();
        let is_open = path == paths::model_mesh_path(plan.model, false);
        self.push_object(plan, shapes, hinge.map(|hinge| (hinge, is_open)));
    }

    /// A node's overrides, spelled out or as indices into the house's table.
    fn overrides(&mut self, node: &'a SuncgNode, at: &FileLocation) -> Vec<&'a SuncgMaterial> {
        if let Some(materials) = &node.materials {
            return materials.iter().collect();
        }
        let table = &self.files.house.materials;
        let mut found = Vec::new();
        for &index in node.material_indices.iter().flatten() {
            let entry = table
                .get(index as usize)
                .filter(|_| index >= 0.0 && index.fract() == 0.0);
            if entry.is_none() {
                let reason = format!("the house's table has {} materials", table.len());
                let damage = WarningKind::BadIndex {
                    found: index.to_string(),
                    reason,
                };
                self.report.warn(at.field("materialIndices"), damage);
            }
            found.push(entry.unwrap_or(&NO_OVERRIDE));
        }
        found
    }

    fn box_object(&mut self, key: NodeKey, node: &'a SuncgNode, room: Option<RoomId>) {
        let at = self.node_at(key);
        let size = match node.dimensions.as_deref() {
            Some(&[x, y, z]) => Vec3::new(x as f32, y as f32, z as f32),
            _ => Vec3::ZERO,
        };
        if !size.is_finite() || size.min_element() <= 0.0 || size.max_element() > 1e4 {
            let found = format!("{:?}", node.dimensions.as_deref().unwrap_or_default());
            let expected = "three lengths above 0; the box is left out".to_owned();
            return self.report.warn(
                at.field("dimensions"),
                WarningKind::BadField { found, expected },
            );
        }
        let Some((pose, part_from_mesh)) = self.placement(node, &at) else {
            return;
        };
        let overrides = self.overrides(node, &at);
        if overrides.len() > 6 {
            self.report.warn(
                at.field("materials"),
                WarningKind::ExtraOverrides {
                    found: overrides.len(),
                    allowed: 6,
                },
            );
        }
        let materials = (0..6).map(|slot| {
            self.box_material(
                overrides.get(slot).copied(),
                &at.field(format_args!("materials[{slot}]")),
            )
        });
        let materials = materials.collect();
        let mesh = self.data.meshes.push(Arc::new(boxes::mesh(size)));
        let category = Category {
            fine: "box".into(),
            coarse: "box".into(),
            nyu40: "box".into(),
        };
        // Designers build steps, boards and counters from boxes, so they stay where they are.
        let row = crate::import::category(["box"]);
        let plan = ObjectDraft {
            key,
            at,
            model: "box",
            category,
            row,
            moves: false,
            room,
            pose,
            part_from_mesh,
        };
        self.push_object(
            &plan,
            vec![PartMesh {
                name: "body",
                mesh,
                materials,
            }],
            None,
        );
    }
}

static NO_OVERRIDE: SuncgMaterial = SuncgMaterial {
    name: None,
    diffuse: None,
    texture: None,
};
