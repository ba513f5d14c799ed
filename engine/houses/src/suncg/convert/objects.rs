//! Objects and boxes: parts, joints, colliders, mass.

use std::sync::Arc;

use dwell_scene::{
    Aabb, Articulation, Category, Collider, JointKind, MaterialId, MeshId, Mobility, Object,
    ObjectId, Part, PartId, Pose, RoomId, space,
};
use glam::{Affine3A, DAffine3, Vec3};

use super::super::file::{Flag, MaterialFile, NodeFile};
use super::super::read::paths;
use super::hinge::Hinge;
use super::{Converter, NodeKey, boxes, mobility, place};
use crate::build::{CategoryRow, convex_pieces};
use crate::report::{At, Damage, Unmapped};

/// Friction of a door's hinge, N·m, and its damping, N·m·s/rad: a leaf that stays where it is left and needs a few
/// newtons at the handle. Estimates of ours; SUNCG says nothing.
const HINGE_FRICTION: f32 = 0.6;
const HINGE_DAMPING: f32 = 1.5;
/// How far a door swings at least, rad: the files' open doors stand ajar (the commonest at 49 degrees, which lets nobody
/// through), but their hinges would go on. An estimate of ours.
const LEAST_SWING_RAD: f32 = 1.6;

/// What a node says about an object, before its parts are made.
struct Plan<'a> {
    key: NodeKey,
    at: At,
    model: &'a str,
    category: Category,
    row: Option<&'static CategoryRow>,
    moves: bool,
    room: Option<RoomId>,
    pose: Pose,
    part_from_mesh: Affine3A,
}

/// A part without its place in the tables.
struct Shape {
    name: &'static str,
    mesh: MeshId,
    materials: Vec<MaterialId>,
}

impl<'a> Converter<'a> {
    pub(super) fn objects(&mut self) {
        let rooms = self.membership();
        for (k, level) in self.files.house.levels.iter().enumerate() {
            if level.valid == Some(Flag(false)) {
                continue;
            }
            for (i, node) in level
                .nodes
                .iter()
                .enumerate()
                .filter(|(_, node)| node.is_valid())
            {
                let room = rooms.get(&(k, i)).copied();
                match node.kind.as_deref() {
                    Some("Object") => self.object((k, i), node, room),
                    Some("Box") => self.box_object((k, i), node, room),
                    Some("Room" | "Ground") => {}
                    kind => {
                        let found = kind.unwrap_or("").to_owned();
                        self.report.warn(
                            self.node_at((k, i)).field("type"),
                            Damage::UnknownNodeType { found },
                        );
                    }
                }
            }
        }
        self.settle();
    }

    fn object(&mut self, key: NodeKey, node: &'a NodeFile, room: Option<RoomId>) {
        let at = self.node_at(key);
        let Some(model) = node.model_id.as_deref() else {
            let damage = Damage::MissingField {
                consequence: "the object is left out".to_owned(),
            };
            return self.report.warn(at.field("modelId"), damage);
        };
        if !paths::is_plain(model) {
            return self.report.warn(
                at.field("modelId"),
                Damage::PathRefused {
                    path: model.to_owned(),
                },
            );
        }
        let Some((pose, part_from_mesh)) = self.placement(node, &at) else {
            return;
        };
        let Some(path) = self.mesh_of_state(model, node, &at) else {
            return;
        };
        let entry = self.files.categories.get(model);
        if entry.is_none() && !self.files.categories.is_empty() {
            self.report.warn(
                at.field("modelId"),
                Damage::Unmapped {
                    what: Unmapped::Category,
                    name: model.to_owned(),
                },
            );
        }
        let category = entry.map(|e| Category {
            fine: e.fine.clone(),
            coarse: e.coarse.clone(),
            nyu40: e.nyu40.clone(),
        });
        let category = category.unwrap_or_default();
        let row = crate::build::category([category.fine.as_str(), category.coarse.as_str()]);
        let moves = mobility::kind_moves(row, entry);
        let plan = Plan {
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

    /// Where a node stands: a rigid pose, and the scale and mirror that its mesh keeps.
    fn placement(&mut self, node: &NodeFile, at: &At) -> Option<(Pose, Affine3A)> {
        let at = at.field("transform");
        let matrix = match place::transform(node.transform.as_deref()) {
            Ok(matrix) => matrix,
            Err(reason) => {
                self.report.warn(at, Damage::BadTransform { reason });
                return None;
            }
        };
        let mirrors = matrix.determinant() < 0.0;
        if let Some(Flag(stated)) = node.is_mirrored.filter(|flag| flag.0 != mirrors) {
            let (found, expected) = (
                u8::from(stated).to_string(),
                format!("{}, as the transform has it", u8::from(mirrors)),
            );
            self.report
                .warn(at.clone(), Damage::BadField { found, expected });
        }
        let world_from_mesh = self.world_from_file * DAffine3::from_mat4(matrix).as_affine3a();
        let split = space::split_affine(&world_from_mesh);
        if split.is_none() {
            self.report.warn(
                at,
                Damage::BadTransform {
                    reason: "it flattens space".to_owned(),
                },
            );
        }
        split
    }

    /// The OBJ file of a node's state: `_0` for state 1 where it exists.
    fn mesh_of_state(&mut self, model: &str, node: &NodeFile, at: &At) -> Option<String> {
        let second = node.state.is_some_and(|state| (state - 1.0).abs() < 1e-9);
        let path = paths::model(model, second);
        if self.shapes.get_mut(&path).is_some() {
            return Some(path);
        }
        let base = paths::model(model, false);
        if second && self.shapes.get_mut(&base).is_some() {
            self.report
                .warn(at.field("state"), Damage::MissingVariant { state: 1, path });
            return Some(base);
        }
        // An empty or unreadable file was reported when it was read.
        if !self.files.meshes.contains_key(&path) {
            self.report.warn(at.clone(), Damage::MissingMesh { path });
        }
        None
    }

    fn model_object(&mut self, plan: &Plan<'a>, path: &str, node: &'a NodeFile) {
        let overrides = self.overrides(node, &plan.at);
        let Some(files) = self.files.meshes.get(path) else {
            return;
        };
        let Some(shape) = self.shapes.get_mut(path) else {
            return;
        };
        let slots = shape.slots.clone();
        let hinge = shape
            .swing
            .as_ref()
            .and_then(|swing| hinge_on_part(&swing.hinge, &plan.part_from_mesh));
        let meshes = match (&mut shape.swing, hinge) {
            (Some(swing), Some(_)) => {
                let frame = swing
                    .frame
                    .as_mut()
                    .map(|frame| ("frame", frame.id(&mut self.data.meshes)));
                let leaf = ("leaf", swing.leaf.id(&mut self.data.meshes));
                frame.into_iter().chain([leaf]).collect()
            }
            _ => vec![("body", shape.whole.id(&mut self.data.meshes))],
        };
        let two_states = self
            .files
            .meshes
            .contains_key(&paths::model(plan.model, true));
        if two_states && hinge.is_none() {
            let what = format!(
                "the two states of model {:?} are not one upright hinge; it does not move",
                plan.model
            );
            self.report
                .warn(plan.at.clone(), Damage::Simplified { what });
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
            .map(|(name, mesh)| Shape {
                name,
                mesh,
                materials: materials.clone(),
            })
            .collect();
        let is_open = path == paths::model(plan.model, false);
        self.push_object(plan, shapes, hinge.map(|hinge| (hinge, is_open)));
    }

    /// A node's overrides, spelled out or as indices into the house's table.
    fn overrides(&mut self, node: &'a NodeFile, at: &At) -> Vec<&'a MaterialFile> {
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
                let damage = Damage::BadIndex {
                    found: index.to_string(),
                    reason,
                };
                self.report.warn(at.field("materialIndices"), damage);
            }
            found.push(entry.unwrap_or(&NO_OVERRIDE));
        }
        found
    }

    fn box_object(&mut self, key: NodeKey, node: &'a NodeFile, room: Option<RoomId>) {
        let at = self.node_at(key);
        let size = match node.dimensions.as_deref() {
            Some(&[x, y, z]) => Vec3::new(x as f32, y as f32, z as f32),
            _ => Vec3::ZERO,
        };
        if !size.is_finite() || size.min_element() <= 0.0 || size.max_element() > 1e4 {
            let found = format!("{:?}", node.dimensions.as_deref().unwrap_or_default());
            let expected = "three lengths above 0; the box is left out".to_owned();
            return self
                .report
                .warn(at.field("dimensions"), Damage::BadField { found, expected });
        }
        let Some((pose, part_from_mesh)) = self.placement(node, &at) else {
            return;
        };
        let overrides = self.overrides(node, &at);
        if overrides.len() > 6 {
            self.report.warn(
                at.field("materials"),
                Damage::ExtraOverrides {
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
        let row = crate::build::category(["box"]);
        let plan = Plan {
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
            vec![Shape {
                name: "body",
                mesh,
                materials,
            }],
            None,
        );
    }

    fn push_object(
        &mut self,
        plan: &Plan<'_>,
        shapes: Vec<Shape>,
        hinge: Option<(HingeOnPart, bool)>,
    ) {
        let id = ObjectId(self.data.objects.len() as u32);
        let first_part = PartId(self.data.parts.len() as u32);
        let part_count = shapes.len() as u32;
        let mut bounds = Aabb::EMPTY;
        for (k, shape) in shapes.into_iter().enumerate() {
            let swings = hinge.is_some() && k + 1 == part_count as usize;
            let part = self.part(plan, id, shape, swings);
            let mesh = &self.data.meshes[part.mesh];
            let world_from_mesh = plan.pose.to_affine() * part.part_from_mesh;
            let of_part = Aabb::from_points(
                mesh.positions
                    .iter()
                    .map(|p| world_from_mesh.transform_point3(*p)),
            );
            bounds = bounds.union(&of_part);
            self.data.parts.push(part);
        }
        if let Some((hinge, is_open)) = hinge {
            let child = PartId(first_part.0 + part_count - 1);
            self.data
                .joints
                .push(joint(&hinge, is_open, id, first_part, child, plan.pose));
        }
        let level = Self::level_id(plan.key.0);
        self.data.levels[level].bounds = self.data.levels[level].bounds.union(&bounds);
        let coarse = [plan.category.coarse.as_str(), plan.model]
            .into_iter()
            .find(|name| !name.is_empty())
            .unwrap_or("thing");
        let name = self.object_names.counted(coarse);
        let center = Vec3::new(bounds.center().x, bounds.center().y, bounds.center().z);
        let room = plan.room.or_else(|| self.room_around(center));
        let lit = self.lights(plan.model, id, first_part, &plan.at);
        let categories = [plan.category.fine.as_str(), plan.category.coarse.as_str()];
        let sounds = self.sounds(plan.model, &categories, id, first_part);
        let switch = if lit {
            Some(true)
        } else {
            (sounds || plan.row.is_some_and(CategoryRow::is_switchable)).then_some(false)
        };
        let mobility = if hinge.is_some() {
            Mobility::Articulated
        } else if plan.moves {
            Mobility::Movable
        } else {
            Mobility::Fixed
        };
        self.data.objects.push(Object {
            name,
            source_id: self.node_names[plan.key.0][plan.key.1].clone(),
            model: plan.model.to_owned(),
            category: plan.category.clone(),
            level,
            room,
            mobility,
            pickable: plan.moves && hinge.is_none() && mobility::is_handy(&bounds),
            switch,
            first_part,
            part_count,
        });
        self.stands.push((first_part, bounds));
    }

    fn part(&mut self, plan: &Plan<'_>, object: ObjectId, shape: Shape, swings: bool) -> Part {
        let fixed = !swings && !plan.moves;
        let mesh = self.data.meshes[shape.mesh].clone();
        let colliders = if fixed {
            vec![Collider::ExactMesh]
        } else {
            let rest = plan
                .part_from_mesh
                .matrix3
                .to_cols_array()
                .map(f32::to_bits);
            self.pieces
                .entry((shape.mesh, rest))
                .or_insert_with(|| convex_pieces(&mesh, &plan.part_from_mesh))
                .clone()
        };
        let density_kg_m3 = if swings {
            dwell_scene::material::library()
                .get_or_default("hollow_door")
                .density_kg_m3
        } else {
            plan.row.map_or(100.0, CategoryRow::box_density_kg_m3)
        };
        let density_kg_m3 = density_kg_m3.clamp(0.1, 30_000.0);
        // Models have no inside: a thing has its kind's usual mass by volume of its box, a leaf that of its pieces.
        let box_m3 = mesh.bounds().size() * plan.part_from_mesh.matrix3.determinant().abs().cbrt();
        let mass_kg = (!fixed && !swings)
            .then(|| (box_m3.element_product() * density_kg_m3).clamp(0.02, 2000.0));
        Part {
            object,
            name: shape.name.to_owned(),
            fixed,
            world_from_part: plan.pose,
            mesh: shape.mesh,
            part_from_mesh: plan.part_from_mesh,
            materials: shape.materials,
            colliders,
            mass_kg,
            density_kg_m3,
        }
    }

    /// Fixes what hangs: a movable thing that stands on nothing would only fall.
    fn settle(&mut self) {
        for (id, object) in self
            .data
            .objects
            .iter_ids()
            .map(|(id, o)| (id, o.clone()))
            .collect::<Vec<_>>()
        {
            if object.mobility != Mobility::Movable {
                continue;
            }
            let bounds = self.stands[id.0 as usize].1;
            let others = self
                .stands
                .iter()
                .filter(|(part, _)| *part != object.first_part)
                .map(|(_, bounds)| *bounds);
            if mobility::is_supported(&bounds, self.data.rooms.as_slice(), others) {
                continue;
            }
            self.data.objects[id].mobility = Mobility::Fixed;
            self.data.objects[id].pickable = false;
            for part in object.parts() {
                let part = &mut self.data.parts[part];
                part.fixed = true;
                part.colliders = vec![Collider::ExactMesh];
                part.mass_kg = None;
            }
        }
    }
}

static NO_OVERRIDE: MaterialFile = MaterialFile {
    name: None,
    diffuse: None,
    texture: None,
};

/// A hinge in part space.
#[derive(Clone, Copy)]
struct HingeOnPart {
    point: Vec3,
    turn_rad: f32,
}

/// Takes a hinge from mesh space onto the part; `None` when the scale would make the turn something else.
fn hinge_on_part(hinge: &Hinge, part_from_mesh: &Affine3A) -> Option<HingeOnPart> {
    let m = part_from_mesh.matrix3;
    let upright = m
        .y_axis
        .x
        .abs()
        .max(m.y_axis.z.abs())
        .max(m.x_axis.y.abs())
        .max(m.z_axis.y.abs())
        < 1e-3;
    let (a, b) = (m.x_axis, m.z_axis);
    let even = (a.length() - b.length()).abs() < 0.01 * a.length()
        && a.dot(b).abs() < 0.01 * a.length_squared();
    let point =
        part_from_mesh.transform_point3(Vec3::new(hinge.point.x as f32, 0.0, hinge.point.y as f32));
    let mirror = if a.x * b.z - a.z * b.x < 0.0 {
        -1.0
    } else {
        1.0
    };
    (upright && even).then_some(HingeOnPart {
        point,
        turn_rad: hinge.turn_rad as f32 * mirror,
    })
}

/// The joint of a leaf that stands as its file has it: position 0 is the state of the file, the turn leads to the other.
fn joint(
    hinge: &HingeOnPart,
    is_open: bool,
    object: ObjectId,
    first: PartId,
    child: PartId,
    world_from_part: Pose,
) -> Articulation {
    let part_from_joint = Pose::from_position(hinge.point);
    let (closed, open) = if is_open {
        (hinge.turn_rad, 0.0)
    } else {
        (0.0, hinge.turn_rad)
    };
    let swing = open - closed;
    let open = closed + swing.signum() * swing.abs().max(LEAST_SWING_RAD);
    let (parent, parent_from_joint) = if first == child {
        (None, world_from_part * part_from_joint)
    } else {
        (Some(first), part_from_joint)
    };
    Articulation {
        name: "hinge".to_owned(),
        object,
        parent,
        child,
        kind: JointKind::Hinge,
        axis: Vec3::Y,
        parent_from_joint,
        child_from_joint: part_from_joint,
        limits: [closed.min(open), closed.max(open)],
        closed,
        open,
        initial: 0.0,
        friction: HINGE_FRICTION,
        damping: HINGE_DAMPING,
        servo: None,
    }
}
