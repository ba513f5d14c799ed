//! Houses of very many things: what grows with their number.

use dwell_scene::{
    Category, Collider, House, HouseData, Id, Joint, JointKind, LevelId, MaterialId, Mesh, MeshId,
    Mobility, Object, ObjectId, Part, PartId, Pose, RoomId, ShoeboxMaterials,
};
use glam::{Affine3A, Vec3};
use std::fmt;
use std::sync::Arc;

/// Half the edge of a thing, m.
const HALF_M: f32 = 0.1;
/// From one thing to the next on a floor, m.
const APART_M: f32 = 0.5;
/// From one thing to the next in a pile, m: each is 5 mm in each of its six neighbours.
const PILED_M: f32 = 2.0 * HALF_M - 0.005;
/// From one joint to the next in a chain, m.
const LINK_M: f32 = 0.05;

/// The arrangement of things.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crowd {
    /// Apart, on one floor.
    Spread,
    /// In one cube, each a little in its neighbours.
    Piled,
    /// All at one place.
    AtOnePlace,
    /// Links of one object, each on the one before.
    Chained,
    /// Doors of one object, each on the wall.
    Doors,
}

impl fmt::Display for Crowd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Spread => "spread",
            Self::Piled => "piled",
            Self::AtOnePlace => "at one place",
            Self::Chained => "chained",
            Self::Doors => "doors",
        })
    }
}

impl Crowd {
    /// A house of one room with `count` cubes of 20 cm.
    ///
    /// # Panics
    /// When the room would be longer than 1,000 m.
    pub fn house(self, count: usize) -> House {
        let rows = |root: f64| (count as f64).powf(1.0 / root).ceil() as usize;
        let (square, cube) = (rows(2.0), rows(3.0));
        let long_m = |rows: usize, apart_m: f32| rows as f32 * apart_m + 2.0;
        let (wide_m, high_m) = match self {
            Self::Spread | Self::Doors => (long_m(square, APART_M), 3.0),
            Self::Piled => (long_m(cube, PILED_M), long_m(cube, PILED_M)),
            Self::AtOnePlace => (4.0, 3.0),
            Self::Chained => (long_m(count, LINK_M).min(1000.0), 3.0),
        };
        let room = House::shoebox([wide_m, high_m, wide_m], &ShoeboxMaterials::default())
            .expect("its edges are from 0.1 to 1,000 m");
        let mut data = room.data().clone();
        let cuboid = Mesh::cuboid(Vec3::splat(-HALF_M), Vec3::splat(HALF_M));
        let mesh = data.meshes.push(Arc::new(cuboid));
        let middle = Vec3::new(0.5 * wide_m, HALF_M, 0.5 * wide_m);
        for k in 0..count {
            let at = |rows: usize, apart_m: f32| {
                let [x, z, y] = [k % rows, k / rows % rows, k / rows / rows];
                Vec3::new(1.0, HALF_M, 1.0) + Vec3::new(x as f32, y as f32, z as f32) * apart_m
            };
            let place = match self {
                Self::Spread | Self::Doors => at(square, APART_M),
                Self::Piled => at(cube, PILED_M),
                Self::AtOnePlace => middle,
                Self::Chained => Vec3::new(0.5 + (k as f32 * LINK_M) % 900.0, 1.0, 0.5 * wide_m),
            };
            let one = matches!(self, Self::Chained | Self::Doors);
            let object = if one && k > 0 {
                data.objects[ObjectId(0)].part_count += 1;
                ObjectId(0)
            } else {
                add_object(
                    &mut data,
                    k,
                    if one {
                        Mobility::Articulated
                    } else {
                        Mobility::Movable
                    },
                )
            };
            let part = add_part(&mut data, object, (mesh, place, k));
            if one {
                let parent = (self == Self::Chained && k > 0).then(|| PartId::from_index(k - 1));
                let mut joint = Joint::new(
                    &format!("joint_{k}"),
                    object,
                    part,
                    JointKind::Hinge,
                    Vec3::Y,
                );
                let from = parent.map_or(Vec3::ZERO, |parent| {
                    data.parts[parent].world_from_part.position
                });
                joint.parent_from_joint = Pose::from_position(place - from);
                joint.parent = parent;
                data.joints.push(joint);
            }
        }
        House::new(data).expect("its tables are sound")
    }
}

fn add_object(data: &mut HouseData, k: usize, mobility: Mobility) -> ObjectId {
    data.objects.push(Object {
        name: format!("thing_{k}"),
        source_id: String::new(),
        model: String::new(),
        category: Category {
            fine: "box".to_owned(),
            coarse: "box".to_owned(),
            ..Category::default()
        },
        level: LevelId(0),
        room: Some(RoomId(0)),
        mobility,
        pickable: true,
        switch: None,
        first_part: PartId::from_index(data.parts.len()),
        part_count: 1,
    })
}

fn add_part(
    data: &mut HouseData,
    object: ObjectId,
    (mesh, place, k): (MeshId, Vec3, usize),
) -> PartId {
    data.parts.push(Part {
        object,
        name: format!("part_{k}"),
        fixed: false,
        world_from_part: Pose::from_position(place),
        mesh,
        part_from_mesh: Affine3A::IDENTITY,
        materials: vec![MaterialId(0)],
        colliders: vec![Collider::cuboid(Vec3::splat(-HALF_M), Vec3::splat(HALF_M))],
        mass_kg: None,
        density_kg_m3: 500.0,
        inertial: None,
    })
}
