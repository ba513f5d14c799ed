//! A robot as an object of a house, and a house of a robot alone.

use std::collections::BTreeMap;
use std::sync::Arc;

use dwell_scene::material::library;
use dwell_scene::{
    Aabb, Category, House, HouseData, Joint, JointId, JointKind, Level, LevelId, Material,
    MaterialId, Mesh, Mimic, Mobility, Object, ObjectId, Part, PartId, Pose, Structure,
    StructureKind, Texture, TextureId, interrupt, units,
};
use glam::{Affine3A, Mat3, Quat, Vec2, Vec3};

use super::masses::{FixedJointTree, combined_inertia};
use super::material_names::MaterialNames;
use super::model::{LinkShape, Robot, RobotJointKind};
use super::shape::colliders;
use crate::error::HousesError;
use crate::import::substance_of;
use crate::report::FileLocation;

/// Half of the edge of the ground under a robot without a house, m.
const GROUND_M: f32 = 5.0;
/// Thickness of the ground, m.
const GROUND_DEPTH_M: f32 = 0.1;

/// The transform from a robot's axes (+X forward, +Z up) to dwell's (-Z forward, +Y up).
pub(crate) fn dwell_from_robot() -> Pose {
    let axes = Mat3::from_cols(Vec3::NEG_Z, Vec3::NEG_X, Vec3::Y);
    Pose::new(Vec3::ZERO, Quat::from_mat3(&axes))
}

/// Adds a robot to the tables of a house, the frame of its root link, as the file has it, at `world_from_root`. `material_names`:
/// those of the house; one for all robots that are added to it, or an empty one.
pub(crate) fn add(
    data: &mut HouseData,
    robot: &Robot,
    name: &str,
    world_from_root: Pose,
    fixed_base: bool,
    material_names: &mut MaterialNames,
) {
    let object = ObjectId(data.objects.len() as u32);
    let first_part = PartId(data.parts.len() as u32);
    // The links that begin a rigid group: the root, and the child of each moving joint.
    let moving = || {
        robot
            .joints
            .iter()
            .filter(|joint| joint.kind != RobotJointKind::Fixed)
    };
    let heads: Vec<usize> = std::iter::once(0)
        .chain(moving().map(|joint| joint.child))
        .collect();
    let rigid = FixedJointTree::new(robot);
    let groups: Vec<Vec<(usize, Pose)>> =
        heads.iter().map(|head| rigid.rigid_group(*head)).collect();
    let mut homes: Vec<Option<(usize, Pose)>> = vec![None; robot.links.len()];
    for (k, group) in groups.iter().enumerate() {
        for (link, place) in group {
            homes[*link] = Some((k, *place));
        }
    }
    material_names.add_new(&data.materials);
    let mut looks = RobotMaterials {
        names: material_names,
        known: BTreeMap::new(),
    };
    let mut world_from: Vec<Pose> = vec![world_from_root];
    let mut joints: Vec<Joint> = Vec::new();
    let mut by_name: BTreeMap<&str, usize> = BTreeMap::new();
    for joint in moving() {
        let (Some((parent, place)), Some((child, _))) = (homes[joint.parent], homes[joint.child])
        else {
            continue;
        };
        let kind = if joint.kind == RobotJointKind::Slide {
            JointKind::Slide
        } else {
            JointKind::Hinge
        };
        let [low, high] = joint.limits.unwrap_or([f32::MIN, f32::MAX]);
        let leader = joint.mimic.as_ref().and_then(|(name, multiplier, offset)| {
            let leader = *by_name.get(name.as_str())?;
            Some(Mimic {
                leader: JointId((data.joints.len() + leader) as u32),
                multiplier: *multiplier,
                offset: *offset,
            })
        });
        let start = match &leader {
            Some(mimic) => {
                let leader = &joints[mimic.leader.0 as usize - data.joints.len()];
                mimic.multiplier * leader.initial + mimic.offset
            }
            None => joint.initial,
        };
        let start = start.clamp(low, high);
        let child_part = PartId(first_part.0 + child as u32);
        let articulation = Joint {
            parent: Some(PartId(first_part.0 + parent as u32)),
            parent_from_joint: place * joint.parent_from_joint,
            child_from_joint: joint.child_from_joint,
            limits: joint.limits,
            closed: start,
            open: start,
            initial: start,
            friction: joint.friction,
            damping: joint.damping,
            armature: joint.armature,
            servo: joint.servo,
            mimic: leader,
            ..Joint::new(&joint.name, object, child_part, kind, joint.axis)
        };
        let above = world_from[parent];
        world_from.push(articulation.world_from_child(&above, start));
        by_name.insert(&joint.name, joints.len());
        joints.push(articulation);
    }
    for (k, group) in groups.iter().enumerate() {
        interrupt::unwind_if_cancelled();
        let fixed = k == 0 && fixed_base;
        let shapes = |of: fn(&super::RobotLink) -> &Vec<LinkShape>| {
            group.iter().flat_map(move |(link, place)| {
                let shapes = of(&robot.links[*link]).iter();
                shapes.map(move |shape| (shape, *place * shape.link_from_shape))
            })
        };
        let mut mesh = Mesh::default();
        let mut materials: Vec<MaterialId> = Vec::new();
        let mut slots: BTreeMap<MaterialId, usize> = BTreeMap::new();
        let visible = shapes(|link| &link.visuals).count() > 0;
        let seen: Vec<(&LinkShape, Pose)> = if visible {
            shapes(|link| &link.visuals).collect()
        } else {
            shapes(|link| &link.collisions).collect()
        };
        let with_images = seen.iter().any(|(shape, _)| shape.image.is_some());
        for (shape, place) in seen {
            interrupt::unwind_if_cancelled();
            let material = looks.material(data, shape, name);
            let slot = *slots.entry(material).or_insert_with(|| {
                materials.push(material);
                materials.len() - 1
            });
            let mut surface = shape.geometry.surface();
            surface
                .positions
                .iter_mut()
                .for_each(|p| *p = place.transform_point(*p));
            if with_images {
                surface.uvs.resize(surface.positions.len(), Vec2::ZERO);
            } else {
                surface.uvs.clear();
            }
            surface.slots = vec![0; surface.triangles.len()];
            mesh.append(&surface, slot as u16);
        }
        let weight = combined_inertia(robot, group);
        let pieces =
            shapes(|link| &link.collisions).flat_map(|(shape, place)| colliders(shape, &place));
        let mesh = data.meshes.push(Arc::new(mesh));
        data.parts.push(Part {
            object,
            name: robot.links[heads[k]].name.clone(),
            fixed,
            world_from_part: world_from[k],
            mesh,
            part_from_mesh: Affine3A::IDENTITY,
            materials,
            colliders: pieces.collect(),
            mass_kg: weight.map(|weight| weight.mass as f32),
            density_kg_m3: 1000.0,
            inertial: weight.map(|weight| weight.inertial()),
        });
    }
    let base = world_from_root.position;
    let room = data.rooms.iter_ids().find(|(_, room)| {
        room.contains_xz(Vec2::new(base.x, base.z))
            && base.y >= room.floor_y - 0.3
            && base.y <= room.ceiling_y
    });
    data.objects.push(Object {
        name: name.to_owned(),
        source_id: robot.name.clone(),
        model: robot.name.clone(),
        category: Category {
            fine: "robot".to_owned(),
            coarse: "robot".to_owned(),
            nyu40: String::new(),
        },
        level: room.map_or(LevelId(0), |(_, room)| room.level),
        room: room.map(|(id, _)| id),
        mobility: if fixed_base {
            Mobility::Articulated
        } else {
            Mobility::Movable
        },
        pickable: false,
        switch: None,
        first_part,
        part_count: groups.len() as u32,
    });
    for joint in joints {
        data.joints.push(joint);
    }
}

/// What tells the materials of one robot apart: colour, name in the file, image.
type MaterialKey = ([u32; 4], String, Option<TextureId>);

/// Materials that the robot has already added.
struct RobotMaterials<'n> {
    names: &'n mut MaterialNames,
    known: BTreeMap<MaterialKey, MaterialId>,
}

impl RobotMaterials<'_> {
    fn material(&mut self, data: &mut HouseData, shape: &LinkShape, robot: &str) -> MaterialId {
        let texture = shape.image.as_ref().map(|image| texture(data, image));
        let usual = match texture {
            Some(_) => [1.0; 4],
            None => [0.6, 0.6, 0.62, 1.0],
        };
        let rgba = shape.rgba.unwrap_or(usual);
        let rgba = rgba.map(|value| {
            if value.is_finite() {
                value.clamp(0.0, 1.0)
            } else {
                0.0
            }
        });
        let key = (rgba.map(f32::to_bits), shape.material.clone(), texture);
        if let Some(known) = self.known.get(&key) {
            return *known;
        }
        let substance =
            substance_of(&shape.material).unwrap_or_else(|| library().get_or_default("steel"));
        let [r, g, b, opacity] = rgba;
        let word = if shape.material.is_empty() {
            "surface".to_owned()
        } else {
            shape.material.replace(['/', '\\'], "-")
        };
        let name = self.names.unique(&format!("{robot}:{word}"));
        let id = data.materials.push(Material {
            base_color: [r, g, b].map(units::linear_from_srgb),
            opacity,
            texture,
            metallic: 0.0,
            ..Material::from_substance(name, substance)
        });
        self.known.insert(key, id);
        id
    }
}

/// The id of an image among the house's; a shared one is added once.
pub(crate) fn texture(data: &mut HouseData, image: &Arc<Texture>) -> TextureId {
    let same = |(id, other): (TextureId, &Arc<Texture>)| Arc::ptr_eq(other, image).then_some(id);
    let known = data.textures.iter_ids().find_map(same);
    known.unwrap_or_else(|| data.textures.push(image.clone()))
}

/// A house that holds nothing but a robot on a ground.
///
/// # Errors
/// [`HousesError::Scene`] when the robot breaks a rule of the scene.
pub(crate) fn house_with_robot_only(robot: &Robot) -> Result<House, HousesError> {
    let mut data = HouseData {
        name: robot.name.clone(),
        source: robot.format.to_owned(),
        ..HouseData::default()
    };
    let corner = Vec3::new(GROUND_M, 0.0, GROUND_M);
    let bounds = Aabb::new(-corner - Vec3::Y * GROUND_DEPTH_M, corner);
    data.levels.push(Level {
        name: "0".to_owned(),
        bounds,
    });
    let concrete = library().get_or_default("concrete");
    let material = data
        .materials
        .push(Material::from_substance("ground", concrete));
    let mesh = data
        .meshes
        .push(Arc::new(Mesh::cuboid(bounds.min, bounds.max)));
    data.structure.push(Structure {
        name: "ground".to_owned(),
        kind: StructureKind::Ground,
        room: None,
        level: LevelId(0),
        mesh,
        materials: vec![material],
    });
    add(
        &mut data,
        robot,
        &robot.name,
        dwell_from_robot(),
        robot.fixed_base,
        &mut MaterialNames::default(),
    );
    // It stands on the ground with its lowest point.
    let lowest = data
        .parts
        .iter()
        .map(|part| {
            let map = part.world_from_part.to_affine();
            let mesh = &data.meshes[part.mesh];
            let heights = mesh.positions.iter().map(|p| map.transform_point3(*p).y);
            heights.fold(f32::INFINITY, f32::min)
        })
        .fold(f32::INFINITY, f32::min);
    if lowest.is_finite() && lowest < 0.0 {
        for part in data.parts.as_mut_slice() {
            part.world_from_part.position.y -= lowest;
        }
    }
    House::new(data).map_err(HousesError::scene(&FileLocation::file(&robot.source)))
}
