//! A small house made by hand: two bedrooms, a kitchen and a hall.
//!
//! Seen from above (x to the right, z down the page), walls 0.1 m thick, height 2.5 m:
//!
//! ```text
//!        x 0      4      8
//! z 0   +--------+--------+
//!       | kitchen|bedroom |
//! z 4   +--------+--------+
//!       |  hall  |bedroom |
//! z 8   +--------+--------+
//! ```

#![allow(dead_code, reason = "each test file uses its own part of this module")]

use dwell_scene::material::library;
use dwell_scene::{
    Aabb, Category, Collider, House, HouseData, Level, LevelId, Material, MaterialId, Mesh,
    Mobility, Object, ObjectId, Part, Pose, Room, RoomId, Structure, StructureKind, Texture,
};
use glam::{Affine3A, Vec2, Vec3};
use std::sync::Arc;

/// Makes a house piece by piece.
#[derive(Default)]
pub(crate) struct Builder {
    pub(crate) data: HouseData,
}

/// Two corners of a box.
pub(crate) type Corners = ([f32; 3], [f32; 3]);

impl Builder {
    pub(crate) fn new(name: &str) -> Self {
        let mut builder = Self::default();
        name.clone_into(&mut builder.data.name);
        let bounds = Aabb::new(Vec3::ZERO, Vec3::new(8.0, 2.5, 8.0));
        builder.data.levels.push(Level {
            name: "0".into(),
            bounds,
        });
        builder
    }

    /// A material with an image of 48 by 48 pixels.
    pub(crate) fn textured(
        &mut self,
        substance: &str,
        color: impl Fn(usize, usize) -> [u8; 3],
    ) -> MaterialId {
        let pixels = (0..48 * 48).flat_map(|k| {
            let [red, green, blue] = color(k % 48, k / 48);
            [red, green, blue, 255]
        });
        let name = format!("image {}", self.data.textures.len());
        let texture = Texture::new(name.clone(), 48, 48, pixels.collect());
        let texture = self.data.textures.push(Arc::new(texture));
        let row = library()
            .get(substance)
            .expect("a substance of the library");
        let material = Material {
            texture: Some(texture),
            ..Material::from_substance(name, row).with_srgb([255; 3])
        };
        self.data.materials.push(material)
    }

    /// The material of a substance in a colour; made once.
    pub(crate) fn material(&mut self, substance: &str, srgb: [u8; 3]) -> MaterialId {
        let name = format!("{substance} {srgb:?}");
        if let Some((id, _)) = self
            .data
            .materials
            .iter_ids()
            .find(|(_, material)| material.name == name)
        {
            return id;
        }
        let row = library()
            .get(substance)
            .unwrap_or_else(|| panic!("no substance {substance}"));
        self.data
            .materials
            .push(Material::from_substance(name, row).with_srgb(srgb))
    }

    pub(crate) fn piece(
        &mut self,
        kind: StructureKind,
        room: Option<RoomId>,
        corners: Corners,
        material: MaterialId,
    ) {
        let mesh = Mesh::cuboid(Vec3::from(corners.0), Vec3::from(corners.1));
        let mesh = self.data.meshes.push(Arc::new(mesh));
        let name = format!("{kind:?} {}", self.data.structure.len());
        let level = LevelId(0);
        self.data.structure.push(Structure {
            name,
            kind,
            room,
            level,
            mesh,
            materials: vec![material],
        });
    }

    /// A rectangular room with floor, ceiling and four walls.
    pub(crate) fn room(&mut self, kind: &str, min: [f32; 2], max: [f32; 2]) -> RoomId {
        let corner = |x: f32, z: f32| Vec2::new(x, z);
        let (a, b) = (corner(min[0], min[1]), corner(max[0], min[1]));
        let (c, d) = (corner(max[0], max[1]), corner(min[0], max[1]));
        let kinds = if kind.is_empty() {
            Vec::new()
        } else {
            vec![kind.to_owned()]
        };
        let id = self.data.rooms.push(Room {
            name: format!("room_{}", self.data.rooms.len()),
            level: LevelId(0),
            kinds,
            footprint: vec![[a, b, c], [a, c, d]],
            floor_y: 0.0,
            ceiling_y: 2.5,
            bounds: Aabb::new(
                Vec3::new(min[0], 0.0, min[1]),
                Vec3::new(max[0], 2.5, max[1]),
            ),
        });
        let floor = self.material("parquet", [170, 125, 78]);
        let wall = self.material("painted_plaster", [245, 245, 242]);
        let (x0, z0, x1, z1) = (min[0], min[1], max[0], max[1]);
        self.piece(
            StructureKind::Floor,
            Some(id),
            ([x0, -0.05, z0], [x1, 0.0, z1]),
            floor,
        );
        self.piece(
            StructureKind::Ceiling,
            Some(id),
            ([x0, 2.5, z0], [x1, 2.55, z1]),
            wall,
        );
        let t = 0.05;
        for walls in [
            ([x0 - t, 0.0, z0 - t], [x1 + t, 2.5, z0]),
            ([x0 - t, 0.0, z1], [x1 + t, 2.5, z1 + t]),
            ([x0 - t, 0.0, z0], [x0, 2.5, z1]),
            ([x1, 0.0, z0], [x1 + t, 2.5, z1]),
        ] {
            self.piece(StructureKind::Wall, Some(id), walls, wall);
        }
        id
    }

    /// An object of boxes of one material; the origin of its part is the middle of its first box's lower face.
    pub(crate) fn thing(
        &mut self,
        category: &str,
        boxes: &[Corners],
        material: MaterialId,
    ) -> ObjectId {
        let first = (Vec3::from(boxes[0].0), Vec3::from(boxes[0].1));
        let origin = Vec3::new(
            (first.0.x + first.1.x) * 0.5,
            first.0.y,
            (first.0.z + first.1.z) * 0.5,
        );
        let mut mesh = Mesh::default();
        let mut colliders = Vec::new();
        for (min, max) in boxes {
            let (min, max) = (Vec3::from(*min) - origin, Vec3::from(*max) - origin);
            mesh.append(&Mesh::cuboid(min, max), 0);
            colliders.push(Collider::cuboid(min, max));
        }
        let mesh = self.data.meshes.push(Arc::new(mesh));
        let object = ObjectId(self.data.objects.len() as u32);
        let part = self.data.parts.push(Part {
            object,
            name: "body".into(),
            fixed: false,
            world_from_part: Pose::from_position(origin),
            mesh,
            part_from_mesh: Affine3A::IDENTITY,
            materials: vec![material],
            colliders,
            mass_kg: Some(1.0),
            density_kg_m3: 100.0,
            inertial: None,
        });
        self.data.objects.push(Object {
            name: format!("{category}_{}", object.0),
            source_id: String::new(),
            model: category.to_owned(),
            category: Category {
                fine: category.to_owned(),
                coarse: category.to_owned(),
                nyu40: String::new(),
            },
            level: LevelId(0),
            room: None,
            mobility: Mobility::Movable,
            pickable: true,
            switch: None,
            first_part: part,
            part_count: 1,
        })
    }

    /// A table with a top of 6 cm and four legs of 6 cm.
    pub(crate) fn table(
        &mut self,
        min: [f32; 2],
        max: [f32; 2],
        height: f32,
        material: MaterialId,
    ) -> ObjectId {
        let [x0, z0] = min;
        let [x1, z1] = max;
        let leg = 0.06;
        let under = height - 0.06;
        let boxes = [
            ([x0, under, z0], [x1, height, z1]),
            ([x0, 0.0, z0], [x0 + leg, under, z0 + leg]),
            ([x1 - leg, 0.0, z0], [x1, under, z0 + leg]),
            ([x0, 0.0, z1 - leg], [x0 + leg, under, z1]),
            ([x1 - leg, 0.0, z1 - leg], [x1, under, z1]),
        ];
        self.thing("table", &boxes, material)
    }

    /// An open box of walls 2 cm thick.
    pub(crate) fn open_box(
        &mut self,
        category: &str,
        (min, max): Corners,
        material: MaterialId,
    ) -> ObjectId {
        let [x0, y0, z0] = min;
        let [x1, y1, z1] = max;
        let t = 0.02;
        let boxes = [
            ([x0, y0, z0], [x1, y0 + t, z1]),
            ([x0, y0, z0], [x0 + t, y1, z1]),
            ([x1 - t, y0, z0], [x1, y1, z1]),
            ([x0, y0, z0], [x1, y1, z0 + t]),
            ([x0, y0, z1 - t], [x1, y1, z1]),
        ];
        self.thing(category, &boxes, material)
    }

    pub(crate) fn build(self) -> Arc<House> {
        Arc::new(House::new(self.data).expect("the house is well made"))
    }
}

/// The small house and its things.
pub(crate) struct Small {
    pub(crate) house: Arc<House>,
    pub(crate) table: ObjectId,
    pub(crate) cup: ObjectId,
    pub(crate) bowl: ObjectId,
    pub(crate) apple: ObjectId,
    pub(crate) red_chair: ObjectId,
    pub(crate) blue_chair: ObjectId,
    pub(crate) fridge: ObjectId,
    pub(crate) picture: ObjectId,
    pub(crate) bed_a: ObjectId,
    pub(crate) bed_b: ObjectId,
    pub(crate) desk: ObjectId,
    pub(crate) rug: ObjectId,
    pub(crate) stool: ObjectId,
    pub(crate) kitchen: RoomId,
    pub(crate) hall: RoomId,
    pub(crate) bedroom_a: RoomId,
    pub(crate) bedroom_b: RoomId,
}

pub(crate) fn small_house() -> Small {
    let mut b = Builder::new("small");
    let kitchen = b.room("kitchen", [0.05, 0.05], [3.95, 3.95]);
    let bedroom_a = b.room("bedroom", [4.05, 0.05], [7.95, 3.95]);
    let hall = b.room("hallway", [0.05, 4.05], [3.95, 7.95]);
    let bedroom_b = b.room("bedroom", [4.05, 4.05], [7.95, 7.95]);
    let wood = b.material("wood", [150, 111, 72]);
    let red = b.material("plastic", [180, 20, 25]);
    let blue = b.material("plastic", [30, 60, 150]);
    let white = b.material("porcelain", [250, 250, 250]);
    let steel = b.material("appliance", [245, 245, 245]);
    let cloth = b.material("textile", [40, 110, 50]);
    let paper = b.material("paper", [235, 215, 60]);
    let table = b.table([1.0, 1.0], [2.4, 1.9], 0.75, wood);
    let cup = b.thing("cup", &[([1.2, 0.75, 1.2], [1.28, 0.85, 1.28])], white);
    let bowl = b.open_box("bowl", ([1.8, 0.75, 1.3], [2.1, 0.9, 1.6]), white);
    let apple = b.thing("food", &[([1.9, 0.771, 1.4], [1.98, 0.85, 1.48])], red);
    let chair = |b: &mut Builder, x: f32, z: f32, material| {
        b.thing(
            "chair",
            &[
                ([x, 0.0, z], [x + 0.45, 0.45, z + 0.45]),
                ([x, 0.45, z], [x + 0.05, 0.9, z + 0.45]),
            ],
            material,
        )
    };
    let red_chair = chair(&mut b, 0.4, 1.1, red);
    let blue_chair = chair(&mut b, 2.6, 1.1, blue);
    let fridge = b.thing("refrigerator", &[([0.1, 0.0, 3.2], [0.7, 1.8, 3.8])], steel);
    let picture = b.thing(
        "picture_frame",
        &[([1.5, 1.4, 0.06], [2.1, 1.9, 0.09])],
        paper,
    );
    let bed_a = b.thing("double_bed", &[([4.2, 0.0, 0.3], [6.0, 0.5, 2.4])], cloth);
    let bed_b = b.thing("double_bed", &[([4.2, 0.0, 5.0], [6.0, 0.5, 7.1])], cloth);
    let desk = b.thing("desk", &[([6.6, 0.0, 5.0], [7.9, 0.74, 5.7])], wood);
    let rug = b.thing("rug", &[([1.0, 0.0, 5.0], [3.0, 0.02, 7.0])], cloth);
    let stool = b.thing("stool", &[([1.8, 0.02, 5.8], [2.2, 0.6, 6.2])], wood);
    Small {
        house: b.build(),
        table,
        cup,
        bowl,
        apple,
        red_chair,
        blue_chair,
        fridge,
        picture,
        bed_a,
        bed_b,
        desk,
        rug,
        stool,
        kitchen,
        hall,
        bedroom_a,
        bedroom_b,
    }
}

/// Fixes a thing in its place.
pub(crate) fn fix(b: &mut Builder, thing: ObjectId) {
    b.data.objects[thing].mobility = Mobility::Fixed;
    b.data.objects[thing].pickable = false;
    let part = b.data.objects[thing].first_part;
    b.data.parts[part].fixed = true;
}
