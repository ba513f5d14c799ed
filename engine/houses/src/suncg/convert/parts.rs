//! Parts of objects: bodies, joints, colliders, mass.

use std::collections::BTreeMap;

use dwell_scene::parallel::Threads;
use dwell_scene::{
    Aabb, Category, Collider, Joint, JointKind, MaterialId, MeshId, Mobility, Object, ObjectId,
    Part, PartId, Pose, RoomId,
};
use glam::{Affine3A, Vec3};

use super::hinge::MeshHinge;
use super::{Converter, NodeKey, mobility};
use crate::import::{CategoryRow, convex_pieces};
use crate::report::FileLocation;

/// Friction of a door's hinge, N·m, and its damping, N·m·s/rad: a leaf that stays where it is left and needs a few
/// newtons at the handle. Estimates of ours; SUNCG says nothing.
const HINGE_FRICTION: f32 = 0.6;
const HINGE_DAMPING: f32 = 1.5;
/// Smallest swing of a door, rad: the files' open doors stand ajar (the commonest at 49 degrees, which lets nobody
/// through), but their hinges would go on. An estimate of ours.
const LEAST_SWING_RAD: f32 = 1.6;

/// The properties of an object that its node states, before its parts are made.
pub(super) struct ObjectDraft<'a> {
    pub(super) key: NodeKey,
    pub(super) at: FileLocation,
    pub(super) model: &'a str,
    pub(super) category: Category,
    pub(super) row: Option<&'static CategoryRow>,
    pub(super) moves: bool,
    pub(super) room: Option<RoomId>,
    pub(super) pose: Pose,
    pub(super) part_from_mesh: Affine3A,
}

/// A part without its position in the tables.
pub(super) struct PartMesh {
    pub(super) name: &'static str,
    pub(super) mesh: MeshId,
    pub(super) materials: Vec<MaterialId>,
}

impl Converter<'_> {
    pub(super) fn push_object(
        &mut self,
        plan: &ObjectDraft<'_>,
        shapes: Vec<PartMesh>,
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
        let name = self.object_names.numbered(coarse);
        let center = Vec3::new(bounds.center().x, bounds.center().y, bounds.center().z);
        let room = plan.room.or_else(|| self.room_around(center));
        let lit = self.add_lights(plan.model, id, first_part, &plan.at);
        let categories = [plan.category.fine.as_str(), plan.category.coarse.as_str()];
        let sounds = self.sounds(plan.model, &categories, id, first_part, &plan.at);
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
            pickable: plan.moves && hinge.is_none() && mobility::is_hand_sized(&bounds),
            switch,
            first_part,
            part_count,
        });
        self.stands.push((first_part, bounds));
    }

    fn part(
        &mut self,
        plan: &ObjectDraft<'_>,
        object: ObjectId,
        shape: PartMesh,
        swings: bool,
    ) -> Part {
        let fixed = !swings && !plan.moves;
        let mesh = self.data.meshes[shape.mesh].clone();
        // A moving part gets its convex pieces at the end, several at once.
        let colliders = if fixed {
            vec![Collider::ExactMesh]
        } else {
            Vec::new()
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
            inertial: None,
        }
    }

    /// Makes movable things fixed that stand on nothing: they would only fall.
    pub(super) fn fix_floating_objects(&mut self) {
        for (k, object) in self.data.objects.iter_mut().enumerate() {
            let (first_part, bounds) = self.stands[k];
            let others = self.stands.iter().filter(|(part, _)| *part != first_part);
            let others = others.map(|(_, bounds)| *bounds);
            if object.mobility != Mobility::Movable
                || mobility::is_supported(&bounds, self.data.rooms.as_slice(), others)
            {
                continue;
            }
            object.mobility = Mobility::Fixed;
            object.pickable = false;
            for part in object.parts() {
                let part = &mut self.data.parts[part];
                part.fixed = true;
                part.colliders = vec![Collider::ExactMesh];
                part.mass_kg = None;
            }
        }
    }

    /// Gives every moving part its convex pieces; instances of a model at one scale share the work.
    pub(super) fn add_convex_colliders(&mut self, threads: Threads) {
        let key = |part: &Part| {
            (
                part.mesh,
                part.part_from_mesh.to_cols_array().map(f32::to_bits),
            )
        };
        let mut wanted: BTreeMap<_, Vec<PartId>> = BTreeMap::new();
        for (id, part) in self.data.parts.iter_ids().filter(|(_, part)| !part.fixed) {
            wanted.entry(key(part)).or_default().push(id);
        }
        let wanted: Vec<Vec<PartId>> = wanted.into_values().collect();
        let made = threads.map(wanted.len(), |k| {
            let part = &self.data.parts[wanted[k][0]];
            convex_pieces(&self.data.meshes[part.mesh], &part.part_from_mesh)
        });
        for (parts, pieces) in wanted.iter().zip(made) {
            for part in parts {
                self.data.parts[*part].colliders.clone_from(&pieces);
            }
        }
    }
}

/// A hinge in part space.
#[derive(Clone, Copy)]
pub(super) struct HingeOnPart {
    point: Vec3,
    turn_rad: f32,
}

/// Transforms a hinge from mesh space onto the part; `None` when the scale would distort the rotation.
pub(super) fn hinge_on_part(hinge: &MeshHinge, part_from_mesh: &Affine3A) -> Option<HingeOnPart> {
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
) -> Joint {
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
    Joint {
        parent,
        parent_from_joint,
        child_from_joint: part_from_joint,
        limits: Some([closed.min(open), closed.max(open)]),
        closed,
        open,
        friction: HINGE_FRICTION,
        damping: HINGE_DAMPING,
        ..Joint::new("hinge", object, child, JointKind::Hinge, Vec3::Y)
    }
}
