//! Annotations of objects in a file of our own, beyond shapes and names.

use std::collections::BTreeMap;
use std::sync::Arc;

use dwell_scene::{
    Aabb, Category, Collider, HouseData, Id, Inertial, Joint, JointId, JointKind, LevelId, Light,
    LightShape, MaterialId, Mesh, Mimic, Mobility, Object, ObjectId, Part, PartId, Pose,
    Receptacle, ReceptacleKind, RoomId, Servo, SoundEmitter, space,
};
use glam::{Affine3A, Mat3A, Vec3};
use serde::Deserialize;

/// Largest remainder of a part's transform beside rotation and translation, per number: editors round.
const ROUNDING: f32 = 1e-3;

/// An object with all annotations of its node.
#[derive(Debug, Deserialize)]
pub(crate) struct AnnotatedObject {
    #[serde(rename = "object")]
    pub(crate) name: String,
    /// Its position among the objects of the house that was written.
    #[serde(default)]
    pub(crate) index: u32,
    model: String,
    category: Category,
    mobility: Mobility,
    pickable: bool,
    #[serde(default)]
    switch: Option<bool>,
    #[serde(default)]
    joints: Vec<AnnotatedJoint>,
    #[serde(default)]
    receptacles: Vec<AnnotatedReceptacle>,
    #[serde(default)]
    sounds: Vec<AnnotatedEmitter>,
    /// The parts of nodes below its own.
    #[serde(skip)]
    pub(crate) lights: Vec<AnnotatedLight>,
    #[serde(skip)]
    pub(crate) parts: Vec<AnnotatedPart>,
    /// The storey and the room in which its node stands, as positions in [`super::ImportedScene`].
    #[serde(skip)]
    pub(crate) level: Option<usize>,
    #[serde(skip)]
    pub(crate) room: Option<usize>,
}

/// A part with all annotations of its node.
#[derive(Debug, Deserialize)]
pub(crate) struct AnnotatedPart {
    #[serde(rename = "part")]
    name: String,
    fixed: bool,
    mass_kg: Option<f32>,
    density_kg_m3: f32,
    #[serde(default)]
    inertial: Option<Inertial>,
    /// Its pose in the house that was written.
    world_from_part: Pose,
    #[serde(default)]
    part_from_mesh: Option<Affine3A>,
    colliders: Vec<Collider>,
    /// The node's transform in the file as it is.
    #[serde(skip)]
    pub(crate) world_from_node: Affine3A,
    /// True if it shows a mesh.
    #[serde(skip)]
    pub(crate) is_visible: bool,
}

#[derive(Debug, Deserialize)]
struct AnnotatedJoint {
    name: String,
    kind: JointKind,
    parent: Option<String>,
    child: String,
    axis: Vec3,
    parent_from_joint: Pose,
    child_from_joint: Pose,
    limits: Option<[f32; 2]>,
    closed: f32,
    open: f32,
    initial: f32,
    #[serde(default)]
    friction: f32,
    #[serde(default)]
    damping: f32,
    #[serde(default)]
    armature: f32,
    #[serde(default)]
    servo: Option<Servo>,
    #[serde(default)]
    mimic: Option<AnnotatedMimic>,
    #[serde(default)]
    switches: bool,
}

#[derive(Debug, Deserialize)]
struct AnnotatedMimic {
    leader: String,
    multiplier: f32,
    offset: f32,
}

#[derive(Debug, Deserialize)]
struct AnnotatedReceptacle {
    name: String,
    part: String,
    holding: ReceptacleKind,
    space_in_part: Aabb,
}

#[derive(Debug, Deserialize)]
struct AnnotatedEmitter {
    signal: String,
    part: String,
    position: Vec3,
    level_db: f32,
    #[serde(default = "default_looping")]
    loops: bool,
    #[serde(default)]
    start_s: f32,
}

/// Sounds loop by default.
const fn default_looping() -> bool {
    true
}

/// A lamp's light as its object has it.
#[derive(Clone, Debug, Deserialize)]
pub(crate) struct AnnotatedLight {
    part: String,
    position: Vec3,
    shape: LightShape,
    color: [f32; 3],
    power_w: f32,
    attenuation: [f32; 3],
}

/// A part with its pose.
struct PlacedPart {
    part: AnnotatedPart,
    world_from_part: Pose,
    part_from_mesh: Affine3A,
    /// Its mesh and the materials of its slots.
    look: Option<(Arc<Mesh>, Vec<MaterialId>)>,
}

/// An object that can be put into a house.
pub(super) struct ImportedObject {
    object: AnnotatedObject,
    parts: Vec<PlacedPart>,
}

impl AnnotatedPart {
    /// Returns its pose, and its mesh on it. A node that an editor moved or rotated takes the part along; `None` when it was
    /// scaled, which joints, masses and collision shapes do not follow.
    fn part_transforms(&self) -> Option<(Pose, Affine3A)> {
        let was = self.world_from_part;
        if !was.is_valid() || !self.world_from_node.is_finite() {
            return None;
        }
        let part_from_mesh = match (self.part_from_mesh, self.is_visible) {
            (Some(map), _) => map,
            (None, true) => was.to_affine().inverse() * self.world_from_node,
            (None, false) => Affine3A::IDENTITY,
        };
        let (before, now) = if self.is_visible {
            (was.to_affine() * part_from_mesh, self.world_from_node)
        } else {
            (Affine3A::IDENTITY, self.world_from_node)
        };
        if is_near(&before, &now) {
            return Some((was, part_from_mesh));
        }
        let moved = now * before.inverse();
        let (pose, rest) = space::split_affine(&(moved * was.to_affine()))?;
        is_near(&rest, &Affine3A::IDENTITY).then_some((pose, part_from_mesh))
    }
}

fn is_near(a: &Affine3A, b: &Affine3A) -> bool {
    let turn = (a.matrix3 - b.matrix3).abs();
    let shift = (a.translation - b.translation).abs().max_element();
    let Mat3A {
        x_axis,
        y_axis,
        z_axis,
    } = turn;
    let turn = x_axis.max(y_axis).max(z_axis).max_element();
    let size = b.matrix3.x_axis.length().max(b.matrix3.y_axis.length());
    turn <= ROUNDING * size.max(1e-6) && shift <= ROUNDING * (1.0 + 0.01 * b.translation.length())
}

impl ImportedObject {
    /// The object with the looks of its parts, in order.
    ///
    /// # Errors
    /// Returns its name as the error when its annotations cannot be kept: see [`AnnotatedPart::place`].
    pub(super) fn new(
        mut object: AnnotatedObject,
        looks: Vec<Option<(Arc<Mesh>, Vec<MaterialId>)>>,
    ) -> Result<Self, String> {
        let places: Option<Vec<_>> = object
            .parts
            .iter()
            .map(AnnotatedPart::part_transforms)
            .collect();
        let Some(places) = places.filter(|places| !places.is_empty()) else {
            return Err(object.name);
        };
        let parts = std::mem::take(&mut object.parts)
            .into_iter()
            .zip(places)
            .zip(looks);
        let parts = parts
            .map(
                |((part, (world_from_part, part_from_mesh)), look)| PlacedPart {
                    part,
                    world_from_part,
                    part_from_mesh,
                    look,
                },
            )
            .collect();
        Ok(Self { object, parts })
    }

    /// Its name in the file.
    pub(super) fn name(&self) -> &str {
        &self.object.name
    }

    /// Returns its position among the objects.
    pub(super) fn order(&self) -> u32 {
        self.object.index
    }

    /// The box around its meshes, m.
    pub(super) fn bounds(&self) -> Aabb {
        let mut bounds = Aabb::EMPTY;
        for part in &self.parts {
            let world_from_mesh = part.world_from_part.to_affine() * part.part_from_mesh;
            let points = part.look.iter().flat_map(|(mesh, _)| &mesh.positions);
            points.for_each(|p| bounds.add_point(world_from_mesh.transform_point3(*p)));
        }
        bounds
    }

    /// The storey and the room in the file.
    pub(super) fn level_and_room(&self) -> (Option<usize>, Option<usize>) {
        (self.object.level, self.object.room)
    }

    /// Writes it into the tables under `name`. `mesh`: gives the id of a mesh.
    pub(super) fn add_to_house(
        self,
        data: &mut HouseData,
        name: String,
        level: LevelId,
        mut mesh: impl FnMut(&mut HouseData, Arc<Mesh>) -> dwell_scene::MeshId,
    ) {
        let id = ObjectId::from_index(data.objects.len());
        let first_part = PartId::from_index(data.parts.len());
        let Self { object, parts } = self;
        let part_count = parts.len() as u32;
        let mut names: BTreeMap<String, usize> = BTreeMap::new();
        // The movements of parts by an editor: from the old pose to the new one.
        let mut moved: Vec<Option<Pose>> = Vec::new();
        for placed in parts {
            let (shape, materials) = placed.look.unwrap_or_default();
            let part = placed.part;
            let mesh = mesh(data, shape);
            let stays = placed.world_from_part == part.world_from_part;
            moved.push((!stays).then(|| placed.world_from_part * part.world_from_part.inverse()));
            names.entry(part.name.clone()).or_insert(moved.len() - 1);
            data.parts.push(Part {
                object: id,
                name: part.name,
                fixed: part.fixed,
                world_from_part: placed.world_from_part,
                mesh,
                part_from_mesh: placed.part_from_mesh,
                materials,
                colliders: part.colliders,
                mass_kg: part.mass_kg,
                density_kg_m3: part.density_kg_m3,
                inertial: part.inertial,
            });
        }
        let part_named = |wanted: &str| names.get(wanted).copied();
        let part = |k: usize| PartId::from_index(first_part.index() + k);
        let mut leaders: BTreeMap<String, JointId> = BTreeMap::new();
        for joint in object.joints {
            let Some(child) = part_named(&joint.child) else {
                continue;
            };
            let parent = joint.parent.as_deref().and_then(part_named);
            // Without a parent the joint frame is in the world, and moves with the child.
            let parent_from_joint = match (parent, moved[child]) {
                (None, Some(new_from_old)) => new_from_old * joint.parent_from_joint,
                _ => joint.parent_from_joint,
            };
            let mimic = joint.mimic.as_ref().and_then(|mimic| {
                Some(Mimic {
                    leader: *leaders.get(&mimic.leader)?,
                    multiplier: mimic.multiplier,
                    offset: mimic.offset,
                })
            });
            let added = data.joints.push(Joint {
                parent: parent.map(part),
                parent_from_joint,
                child_from_joint: joint.child_from_joint,
                limits: joint.limits,
                closed: joint.closed,
                open: joint.open,
                initial: joint.initial,
                friction: joint.friction,
                damping: joint.damping,
                armature: joint.armature,
                servo: joint.servo,
                mimic,
                toggles_switch: joint.switches,
                ..Joint::new(&joint.name, id, part(child), joint.kind, joint.axis)
            });
            leaders.entry(joint.name).or_insert(added);
        }
        for place in object.receptacles {
            let Some(of) = part_named(&place.part) else {
                continue;
            };
            data.receptacles.push(Receptacle {
                object: id,
                part: part(of),
                name: place.name,
                holding: place.holding,
                space_in_part: place.space_in_part,
            });
        }
        for sound in object.sounds {
            let Some(of) = part_named(&sound.part) else {
                continue;
            };
            data.emitters.push(SoundEmitter {
                loops: sound.loops,
                start_s: sound.start_s,
                ..SoundEmitter::looping(id, part(of), sound.position, sound.signal, sound.level_db)
            });
        }
        for light in object.lights {
            let Some(of) = part_named(&light.part) else {
                continue;
            };
            data.lights.push(Light {
                object: id,
                part: part(of),
                position: light.position,
                shape: light.shape,
                color: light.color,
                power_w: light.power_w,
                attenuation: light.attenuation,
            });
        }
        data.objects.push(Object {
            name,
            source_id: object.name,
            model: object.model,
            category: object.category,
            level,
            room: object.room.map(RoomId::from_index),
            mobility: object.mobility,
            pickable: object.pickable,
            switch: object.switch,
            first_part,
            part_count,
        });
    }
}
