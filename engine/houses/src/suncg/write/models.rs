//! Conversion of objects into models and nodes.

use std::collections::BTreeMap;

use dwell_scene::{
    House, Joint, JointId, JointKind, MaterialId, Mobility, Object, ObjectId, Part, PartId, Pose,
};
use glam::{Affine3A, Mat4, Vec3};

use super::super::file::{BinaryFlag, SuncgMaterial, SuncgNode};
use super::tables::{ModelRow, light_in_model_space};
use super::{SuncgWriter, bounds, hex, model_name, short_name};
use crate::error::HousesError;
use crate::export_loss::ExportLosses;
use crate::import::UniqueNames;
use crate::obj::ObjWriter;

/// Models written so far.
#[derive(Default)]
pub(super) struct WrittenModels {
    by_key: BTreeMap<String, String>,
    names: UniqueNames,
    /// The rows of each model in the tables.
    pub(super) rows: Vec<ModelRow>,
    /// The materials of the MTL file of each.
    materials: Vec<Vec<MaterialId>>,
}

impl WrittenModels {
    /// An id that no model has yet.
    fn unused_name(&mut self, base: &str) -> String {
        let id = self.names.unique(&model_name(base));
        // The name may have become a variant's by its number.
        if super::super::metadata::base_model(&id) == id {
            id
        } else {
            self.names.unique(&format!("{id}-"))
        }
    }
}

/// The hinge that a model's two states can show: the positions of the joint in them.
struct TwoStateHinge {
    joint: JointId,
    /// The initial position of the door, or fully open when it starts closed.
    open: f32,
    closed: f32,
    starts_closed: bool,
}

/// A part with its pose in the model.
struct ModelPiece<'a> {
    part: &'a Part,
    model_from_mesh: Affine3A,
    first_slot: usize,
}

impl SuncgWriter<'_> {
    /// The node of an object, its model written when it is new.
    pub(super) fn object_node(
        &mut self,
        object_id: ObjectId,
        id: String,
        losses: &mut ExportLosses,
    ) -> Result<SuncgNode, HousesError> {
        let house = self.house;
        let object = &house.objects[object_id];
        let root = &house.parts[object.first_part];
        let states = two_state_hinge(house, object_id);
        let joints = house.joints_of(object_id).count();
        if object.mobility == Mobility::Articulated || joints > 0 {
            losses.add(
                "joints other than one upright hinge of a leaf on a frame",
                joints - usize::from(states.is_some()),
            );
        }
        // A single part keeps its mesh as it is; its scale goes into the transform.
        let single = object.part_count == 1;
        let world_from_model = if single {
            root.world_from_part.to_affine() * root.part_from_mesh
        } else {
            root.world_from_part.to_affine()
        };
        let materials: Vec<MaterialId> = object
            .parts()
            .flat_map(|part| house.parts[part].materials.iter().copied())
            .collect();
        let row = self.model_row(object_id, &world_from_model, &materials);
        let model = self.model(object_id, row, &materials, states.as_ref(), losses)?;
        let known = self.models.rows.iter().position(|row| row.id == model);
        let as_written = known.is_some_and(|k| self.models.materials[k] == materials);
        let overrides = (!as_written).then(|| self.overrides(&materials, losses));
        let matrix = Mat4::from(world_from_model).to_cols_array().map(f64::from);
        let mirrored = world_from_model.matrix3.determinant() < 0.0;
        Ok(SuncgNode {
            id: Some(id),
            kind: Some("Object".to_owned()),
            valid: Some(BinaryFlag(true)),
            model_id: Some(model),
            transform: Some(matrix.to_vec()),
            bbox: bounds(&house.object_bounds(&self.start, object_id)),
            is_mirrored: mirrored.then_some(BinaryFlag(true)),
            state: states.filter(|states| states.starts_closed).map(|_| 1.0),
            materials: overrides,
            ..SuncgNode::default()
        })
    }

    /// Returns the row of the model of `object` in the tables.
    fn model_row(
        &self,
        id: ObjectId,
        world_from_model: &Affine3A,
        materials: &[MaterialId],
    ) -> ModelRow {
        let house = self.house;
        let lights = house.lights.iter().filter(|light| light.object == id);
        let model_from_part = |part: PartId| {
            world_from_model.inverse() * house.parts[part].world_from_part.to_affine()
        };
        ModelRow {
            id: String::new(),
            category: house.objects[id].category.clone(),
            slots: materials.len(),
            bounds: dwell_scene::Aabb::EMPTY,
            lights: lights
                .map(|light| light_in_model_space(light, &model_from_part(light.part)))
                .collect(),
            signals: house
                .emitters
                .iter()
                .filter(|emitter| emitter.object == id && emitter.sound_file.is_none())
                .map(|e| e.signal.clone())
                .collect(),
        }
    }

    /// The id of the object's model, written when it is new.
    fn model(
        &mut self,
        object_id: ObjectId,
        mut row: ModelRow,
        materials: &[MaterialId],
        states: Option<&TwoStateHinge>,
        losses: &mut ExportLosses,
    ) -> Result<String, HousesError> {
        let house = self.house;
        let object = &house.objects[object_id];
        let key = model_key(house, object_id, &row, materials);
        if let Some(known) = self.models.by_key.get(&key) {
            return Ok(known.clone());
        }
        let base = if object.model.is_empty() {
            &object.name
        } else {
            &object.model
        };
        let positions = match states {
            Some(states) => vec![(Some(states.open), ""), (Some(states.closed), "_0")],
            None => vec![(None, "")],
        };
        let mut shapes = Vec::new();
        for (position, suffix) in positions {
            let joint = states.map(|states| &house.joints[states.joint]);
            let mut obj = ObjWriter::default();
            for piece in pieces(house, object, joint.zip(position)) {
                let mesh = &house.meshes[piece.part.mesh];
                let slot_name =
                    |slot: u16| slot_name(house, materials, piece.first_slot + usize::from(slot));
                obj.mesh(None, mesh, &piece.model_from_mesh, slot_name);
                let of_piece = mesh
                    .positions
                    .iter()
                    .map(|p| piece.model_from_mesh.transform_point3(*p));
                row.bounds = row.bounds.union(&dwell_scene::Aabb::from_points(of_piece));
            }
            shapes.push((suffix, obj));
        }
        let mtl = self.mtl(materials, |k, _| slot_name(house, materials, k));
        let id = if self.shared {
            let texts = shapes.iter().map(|(_, obj)| obj.text());
            let content: String = texts.chain([mtl.as_str(), &key_of_row(&row)]).collect();
            format!("{}-{}", model_name(base), short_name(content.as_bytes()))
        } else {
            self.models.unused_name(base)
        };
        let folder = format!("object/{id}");
        for (suffix, obj) in shapes {
            let text = obj.into_text(&format!("{id}.mtl"));
            self.file(&format!("{folder}/{id}{suffix}.obj"), text.as_bytes())?;
        }
        self.file(&format!("{folder}/{id}.mtl"), mtl.as_bytes())?;
        if row.category.fine.is_empty() && row.category.coarse.is_empty() {
            losses.add("objects without a category stay without one", 1);
        }
        row.id.clone_from(&id);
        if self.shared {
            self.write_row_file(&row)?;
        }
        if !self.models.rows.iter().any(|known| known.id == id) {
            self.models.rows.push(row);
            self.models.materials.push(materials.to_vec());
        }
        self.models.by_key.insert(key, id.clone());
        Ok(id)
    }

    /// Overrides by position that show `materials`.
    fn overrides(&self, materials: &[MaterialId], losses: &mut ExportLosses) -> Vec<SuncgMaterial> {
        let rounded = |c: f32| {
            let encoded = dwell_scene::units::srgb_from_linear(c) * 255.0;
            (encoded - encoded.round()).abs() > 1e-3
        };
        let to_file = |id: &MaterialId| {
            let material = &self.house.materials[*id];
            if material.base_color.into_iter().any(rounded) {
                losses.add("colours between the 256 steps of an override", 1);
            }
            SuncgMaterial {
                name: Some(material.substance.clone()),
                diffuse: Some(hex(material)),
                texture: material.texture.map(|id| self.textures[&id].clone()),
            }
        };
        materials.iter().map(to_file).collect()
    }
}

/// The name of a slot gives its substance; the position makes it unique.
fn slot_name(house: &House, materials: &[MaterialId], slot: usize) -> String {
    let substance = materials
        .get(slot)
        .map_or("material", |id| house.materials[*id].substance.as_str());
    format!("{substance}_{slot}")
}

/// The key of equal models: shape, table row, and looks that an override cannot change.
fn model_key(house: &House, id: ObjectId, row: &ModelRow, materials: &[MaterialId]) -> String {
    let object = &house.objects[id];
    let root = house.parts[object.first_part].world_from_part;
    let shape: Vec<_> = object
        .parts()
        .map(|part| {
            let part = &house.parts[part];
            let place = if object.part_count == 1 {
                [0; 19]
            } else {
                let pose = root.inverse() * part.world_from_part;
                let mut bits = [0; 19];
                let numbers = pose
                    .position
                    .to_array()
                    .into_iter()
                    .chain(pose.rotation.to_array());
                let numbers = numbers.chain(part.part_from_mesh.to_cols_array());
                bits.iter_mut()
                    .zip(numbers)
                    .for_each(|(slot, number)| *slot = number.to_bits());
                bits
            };
            (part.mesh, place)
        })
        .collect();
    let ends =
        |joint: JointId| [house.joints[joint].open, house.joints[joint].closed].map(f32::to_bits);
    let joints: Vec<_> = house.joints_of(id).map(ends).collect();
    let fixed: Vec<_> = materials
        .iter()
        .map(|id| {
            let m = &house.materials[*id];
            (
                m.opacity.to_bits(),
                m.roughness.to_bits(),
                m.emission.map(f32::to_bits),
                &m.substance,
            )
        })
        .collect();
    format!(
        "{shape:?}{joints:?}{fixed:?}{}{}",
        key_of_row(row),
        object.model
    )
}

/// Returns the part of a table row that does not follow from the shape.
fn key_of_row(row: &ModelRow) -> String {
    format!("{:?}{:?}{:?}", row.category, row.lights, row.signals)
}

/// The parts of an object in the space of its model, with its joint at a position when one is given.
fn pieces<'a>(
    house: &'a House,
    object: &Object,
    joint: Option<(&Joint, f32)>,
) -> Vec<ModelPiece<'a>> {
    let root = &house.parts[object.first_part];
    let mut first_slot = 0;
    object
        .parts()
        .map(|id| {
            let part = &house.parts[id];
            let world_from_part = match joint {
                Some((joint, position)) if joint.child == id => {
                    let parent = joint
                        .parent
                        .map_or(Pose::IDENTITY, |parent| house.parts[parent].world_from_part);
                    joint.world_from_child(&parent, position)
                }
                _ => part.world_from_part,
            };
            let model_from_mesh = if object.part_count == 1 {
                Affine3A::IDENTITY
            } else {
                (root.world_from_part.inverse() * world_from_part).to_affine() * part.part_from_mesh
            };
            let piece = ModelPiece {
                part,
                model_from_mesh,
                first_slot,
            };
            first_slot += part.materials.len();
            piece
        })
        .collect()
}

/// The two states of an object, when its only joint is an upright hinge of a leaf on a frame.
fn two_state_hinge(house: &House, id: ObjectId) -> Option<TwoStateHinge> {
    let object = &house.objects[id];
    let mut joints = house.joints_of(id);
    let (joint_id, None) = (joints.next()?, joints.next()) else {
        return None;
    };
    let joint = &house.joints[joint_id];
    let axis = joint.parent_from_joint.rotation * joint.axis;
    let upright = axis.cross(Vec3::Y).length() < 1e-3;
    let starts_closed = (joint.initial - joint.closed).abs() < 1e-4;
    let open = if starts_closed {
        joint.open
    } else {
        joint.initial
    };
    let fits = joint.kind == JointKind::Hinge
        && upright
        && object.part_count > 1
        && joint.parent == Some(object.first_part);
    let turns = (open - joint.closed).abs() > 0.06;
    (fits && turns).then_some(TwoStateHinge {
        joint: joint_id,
        open,
        closed: joint.closed,
        starts_closed,
    })
}
