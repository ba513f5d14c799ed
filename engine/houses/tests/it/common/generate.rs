//! Houses out of a list of numbers: every field of every table takes odd values, and every rule of the scene holds.

use std::sync::Arc;

use dwell_scene::space::is_singular;
use dwell_scene::{
    Aabb, Bands, Category, Collider, HouseData, Joint, JointKind, Level, LevelId, Light,
    LightShape, Material, MaterialId, Mesh, MeshId, Mobility, Object, ObjectId, Part, PartId, Pose,
    Receptacle, ReceptacleKind, Room, RoomId, Servo, Sky, SkyConditions, SoundEmitter, Structure,
    StructureKind, Texture, TextureId, Weather,
};
use glam::{Affine3A, Mat3A, Quat, Vec2, Vec3, Vec3A};

/// Numbers that a house is made of; they begin again when they run out.
pub(crate) struct Numbers<'a> {
    numbers: &'a [u32],
    next: usize,
}

impl<'a> Numbers<'a> {
    pub(crate) fn new(numbers: &'a [u32]) -> Self {
        Self { numbers, next: 0 }
    }

    fn bits(&mut self) -> u32 {
        let number = self
            .numbers
            .get(self.next % self.numbers.len().max(1))
            .copied()
            .unwrap_or(0);
        self.next += 1;
        // Mixed with the position, so that the same numbers the second time round do not make all things alike.
        let mixed =
            (u64::from(number) << 32 | self.next as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        ((mixed ^ mixed >> 29).wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 32) as u32
    }

    fn below(&mut self, count: usize) -> usize {
        self.bits() as usize % count.max(1)
    }

    fn flag(&mut self) -> bool {
        self.bits() & 1 == 1
    }

    /// Any finite number of moderate size, with all its bits.
    fn float(&mut self) -> f32 {
        let value = f32::from_bits(self.bits());
        if value.is_finite() && value.abs() < 1e4 && (value == 0.0 || value.abs() > 1e-30) {
            value
        } else {
            (self.bits() as f32) * 1e-7 - 200.0
        }
    }

    /// A number in 0 to 1.
    fn unit(&mut self) -> f32 {
        (self.bits() >> 8) as f32 / (1 << 24) as f32
    }

    /// A number above 0.
    fn size(&mut self) -> f32 {
        self.unit() + 1e-3
    }

    fn vec3(&mut self) -> Vec3 {
        Vec3::new(self.float(), self.float(), self.float())
    }

    fn vec2(&mut self) -> Vec2 {
        Vec2::new(self.float(), self.float())
    }

    /// A triangle with an area.
    fn triangle(&mut self) -> [Vec2; 3] {
        let corners = [self.vec2(), self.vec2(), self.vec2()];
        let [a, b, c] = corners;
        if (b - a).perp_dot(c - a) == 0.0 {
            return [Vec2::ZERO, Vec2::X, Vec2::Y];
        }
        corners
    }

    fn direction(&mut self) -> Vec3 {
        Vec3::new(self.unit() - 0.5, self.unit() - 0.5, self.unit() + 0.1).normalize()
    }

    fn pose(&mut self) -> Pose {
        let angles = [self.unit(), self.unit(), self.unit()].map(|x| x * 6.0);
        Pose::new(
            self.vec3(),
            Quat::from_euler(glam::EulerRot::YXZ, angles[0], angles[1], angles[2]).normalize(),
        )
    }

    /// With columns below 1, so that a mesh of 10 km stays within the 32 km that a house may have.
    fn affine(&mut self) -> Affine3A {
        let columns = [self.vec3(), self.vec3(), self.vec3()].map(|c| Vec3A::from(c) * 5e-5);
        let drawn = Mat3A::from_cols(columns[0], columns[1], columns[2]);
        Affine3A {
            matrix3: if is_singular(&drawn) {
                Mat3A::IDENTITY
            } else {
                drawn
            },
            translation: self.vec3().into(),
        }
    }

    fn aabb(&mut self) -> Aabb {
        if self.below(5) == 0 {
            Aabb::EMPTY
        } else {
            let (a, b) = (self.vec3(), self.vec3());
            Aabb::new(a.min(b), a.max(b))
        }
    }

    /// A name with characters that text formats must take care of.
    fn name(&mut self, k: usize) -> String {
        let odd = [
            "chair",
            "Küche",
            "a \"b\" \\ c",
            "slash/../x",
            "線",
            "tab\there",
            " ",
        ];
        format!("{}_{k}", odd[self.below(odd.len())])
    }

    fn bands(&mut self, high: f32) -> Bands {
        let count = 1 + self.below(4);
        let mut centre = 20.0;
        let centres_hz = (0..count)
            .map(|_| {
                centre += 1.0 + self.unit() * 1000.0;
                centre
            })
            .collect();
        Bands {
            centres_hz,
            values: (0..count).map(|_| self.unit() * high).collect(),
        }
    }
}

fn mesh(n: &mut Numbers<'_>, slots: usize) -> Mesh {
    let vertices = 1 + n.below(7);
    let triangles = n.below(9);
    let (normals, uvs, slotted) = (n.flag(), n.flag(), n.flag());
    Mesh {
        positions: (0..vertices).map(|_| n.vec3()).collect(),
        normals: if normals {
            (0..vertices).map(|_| n.direction()).collect()
        } else {
            vec![]
        },
        uvs: if uvs {
            (0..vertices).map(|_| n.vec2()).collect()
        } else {
            vec![]
        },
        triangles: (0..triangles)
            .map(|_| [0; 3].map(|_| n.below(vertices) as u32))
            .collect(),
        slots: if slotted {
            (0..triangles).map(|_| n.below(slots) as u16).collect()
        } else {
            vec![]
        },
    }
}

fn texture(n: &mut Numbers<'_>, k: usize) -> Texture {
    let (width, height) = (1 + n.below(5) as u32, 1 + n.below(5) as u32);
    let rgba = (0..width * height * 4).map(|_| n.bits() as u8).collect();
    Texture::new(n.name(k), width, height, rgba)
}

fn material(n: &mut Numbers<'_>, k: usize, textures: usize) -> Material {
    Material {
        name: n.name(k),
        substance: n.name(0),
        base_color: [n.unit(), n.unit(), n.unit()],
        texture: (textures > 0 && n.flag()).then(|| TextureId(n.below(textures) as u32)),
        emission: [n.unit() * 9.0, 0.0, n.unit()],
        opacity: n.unit(),
        metallic: n.unit(),
        roughness: n.unit(),
        density_kg_m3: 1.0 + n.unit() * 9000.0,
        friction: n.unit(),
        restitution: n.unit(),
        absorption: n.bands(1.0),
        scattering: n.bands(1.0),
        transmission_loss_db: n.bands(200.0),
    }
}

fn collider(n: &mut Numbers<'_>, fixed: bool) -> Collider {
    match n.below(if fixed { 5 } else { 4 }) {
        0 => Collider::Cuboid {
            part_from_box: n.pose(),
            half_extents: n.vec3().abs() + 1e-3,
        },
        1 => Collider::Ball {
            center: n.vec3(),
            radius: n.size(),
        },
        2 => Collider::Cylinder {
            part_from_cylinder: n.pose(),
            half_height: n.size(),
            radius: n.size(),
        },
        3 => Collider::Hull {
            points: (0..4 + n.below(4)).map(|_| n.vec3()).collect(),
        },
        _ => Collider::ExactMesh,
    }
}

/// A house of those numbers.
pub(crate) fn house(numbers: &[u32]) -> HouseData {
    let n = &mut Numbers::new(numbers);
    let slots = 3;
    let mut data = HouseData {
        name: n.name(0),
        source: n.name(1),
        ..HouseData::default()
    };
    let levels = 1 + n.below(2);
    data.levels = (0..levels)
        .map(|k| Level {
            name: n.name(k),
            bounds: n.aabb(),
        })
        .collect();
    data.textures = (0..n.below(3)).map(|k| Arc::new(texture(n, k))).collect();
    let textures = data.textures.len();
    data.materials = (0..=n.below(4)).map(|k| material(n, k, textures)).collect();
    data.meshes = (0..=n.below(4)).map(|_| Arc::new(mesh(n, slots))).collect();
    let (materials, meshes) = (data.materials.len(), data.meshes.len());
    data.rooms = (0..n.below(3))
        .map(|k| Room {
            name: n.name(k),
            level: LevelId(n.below(levels) as u32),
            kinds: (0..n.below(3)).map(|k| n.name(k)).collect(),
            footprint: (0..=n.below(2)).map(|_| n.triangle()).collect(),
            floor_y: n.float(),
            ceiling_y: n.float(),
            bounds: n.aabb(),
        })
        .collect();
    for room in data.rooms.as_mut_slice() {
        let (a, b) = (room.floor_y, room.ceiling_y);
        (room.floor_y, room.ceiling_y) = (a.min(b), a.max(b));
    }
    let rooms = data.rooms.len();
    let slot_materials = |n: &mut Numbers<'_>| {
        (0..slots)
            .map(|_| MaterialId(n.below(materials) as u32))
            .collect::<Vec<_>>()
    };
    let kinds = [
        StructureKind::Wall,
        StructureKind::Floor,
        StructureKind::Ceiling,
        StructureKind::Ground,
        StructureKind::Other,
    ];
    data.structure = (0..n.below(4))
        .map(|k| Structure {
            name: n.name(k),
            kind: kinds[n.below(kinds.len())],
            room: (rooms > 0 && n.flag()).then(|| RoomId(n.below(rooms) as u32)),
            level: LevelId(n.below(levels) as u32),
            mesh: MeshId(n.below(meshes) as u32),
            materials: slot_materials(n),
        })
        .collect();
    for k in 0..n.below(4) {
        let object = ObjectId(k as u32);
        let mobility = [Mobility::Fixed, Mobility::Articulated, Mobility::Movable][n.below(3)];
        let first_part = PartId(data.parts.len() as u32);
        let part_count = 1 + n.below(3) as u32;
        for part in 0..part_count {
            let fixed =
                mobility == Mobility::Fixed || (mobility == Mobility::Articulated && part == 0);
            data.parts.push(Part {
                object,
                name: n.name(part as usize),
                fixed,
                world_from_part: n.pose(),
                mesh: MeshId(n.below(meshes) as u32),
                part_from_mesh: n.affine(),
                materials: slot_materials(n),
                colliders: (0..n.below(3)).map(|_| collider(n, fixed)).collect(),
                mass_kg: n.flag().then(|| 0.1 + n.unit() * 90.0),
                density_kg_m3: 1.0 + n.unit() * 900.0,
                inertial: None,
            });
            if !fixed && part > 0 && n.flag() {
                data.joints
                    .push(joint(n, object, first_part, PartId(first_part.0 + part)));
            }
        }
        data.objects.push(Object {
            name: n.name(k),
            source_id: n.name(k),
            model: n.name(k),
            category: Category {
                fine: n.name(0),
                coarse: n.name(1),
                nyu40: String::new(),
            },
            level: LevelId(n.below(levels) as u32),
            room: (rooms > 0 && n.flag()).then(|| RoomId(n.below(rooms) as u32)),
            mobility,
            pickable: n.flag(),
            switch: [None, Some(true), Some(false)][n.below(3)],
            first_part,
            part_count,
        });
        fixtures(n, &mut data, object, first_part);
    }
    let moment = SkyConditions {
        hour_h: n.unit() * 24.0,
        day: 1 + n.below(366) as u16,
        latitude_deg: n.unit() * 180.0 - 90.0,
        north_yaw_deg: n.unit() * 360.0 - 180.0,
        weather: if n.flag() {
            Weather::Overcast
        } else {
            Weather::Clear {
                turbidity: 2.0 + n.unit() * 8.0,
            }
        },
    };
    data.sky = n.flag().then(|| Sky::at(&moment).unwrap());
    data
}

fn joint(n: &mut Numbers<'_>, object: ObjectId, first: PartId, child: PartId) -> Joint {
    let (low, span) = (n.float().clamp(-3.0, 3.0), n.unit());
    Joint {
        name: n.name(0),
        object,
        parent: n.flag().then_some(first),
        child,
        kind: if n.flag() {
            JointKind::Hinge
        } else {
            JointKind::Slide
        },
        axis: n.direction(),
        parent_from_joint: n.pose(),
        child_from_joint: n.pose(),
        limits: n.flag().then_some([low, low + span]),
        closed: low,
        open: low + span,
        initial: low,
        friction: n.unit(),
        damping: n.unit(),
        armature: n.unit(),
        servo: n.flag().then(|| Servo {
            stiffness: n.unit(),
            damping: n.unit(),
            max_effort: n.unit(),
            velocity_gain: n.unit(),
            max_velocity: n.flag().then(|| n.unit()),
            gear: 0.5 + n.unit(),
            feed_forward: n.flag(),
        }),
        mimic: None,
        toggles_switch: false,
    }
}

fn fixtures(n: &mut Numbers<'_>, data: &mut HouseData, object: ObjectId, part: PartId) {
    for _ in 0..n.below(3) {
        let shape = match n.below(3) {
            0 => LightShape::Point,
            1 => LightShape::Spot {
                direction: n.direction(),
                cutoff_rad: n.unit(),
                dropoff_rate: n.unit(),
            },
            _ => LightShape::Line { end: n.vec3() },
        };
        let color = [n.unit(), n.unit(), n.unit()];
        data.lights.push(Light {
            object,
            part,
            position: n.vec3(),
            shape,
            color,
            power_w: n.unit() * 60.0,
            attenuation: [n.unit(), 0.0, 1.0],
        });
    }
    for k in 0..n.below(2) {
        let emitter = SoundEmitter::looping(object, part, n.vec3(), n.name(k), n.unit() * 100.0);
        data.emitters.push(emitter);
        let holding = if n.flag() {
            ReceptacleKind::On
        } else {
            ReceptacleKind::In
        };
        data.receptacles.push(Receptacle {
            object,
            part,
            name: n.name(k),
            holding,
            space_in_part: n.aabb(),
        });
    }
}
