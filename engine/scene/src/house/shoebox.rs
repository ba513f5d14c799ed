//! A rectangular room: the simplest house, with closed-form acoustics.

use super::House;
use super::data::{HouseData, Level, Room, Structure, StructureKind};
use crate::bounds::Aabb;
use crate::error::SceneError;
use crate::ids::{LevelId, RoomId};
use crate::material::{Material, library};
use crate::mesh::Mesh;
use glam::{Vec2, Vec3};
use std::sync::Arc;

/// The six materials of a shoebox room.
#[derive(Clone, Debug, PartialEq)]
pub struct ShoeboxMaterials {
    /// y = 0.
    pub floor: Material,
    /// y = height.
    pub ceiling: Material,
    /// x = 0.
    pub west: Material,
    /// x = width.
    pub east: Material,
    /// z = 0.
    pub north: Material,
    /// z = depth.
    pub south: Material,
}

impl ShoeboxMaterials {
    /// The same material on all six sides.
    pub fn uniform(material: &Material) -> Self {
        let side = |name: &str| Material {
            name: name.to_owned(),
            ..material.clone()
        };
        Self {
            floor: side("floor"),
            ceiling: side("ceiling"),
            west: side("west"),
            east: side("east"),
            north: side("north"),
            south: side("south"),
        }
    }
}

impl Default for ShoeboxMaterials {
    fn default() -> Self {
        let of = |name: &str, substance: &str| {
            Material::from_substance(name, library().get_or_default(substance))
        };
        Self {
            floor: of("floor", "parquet"),
            ..Self::uniform(&of("plaster", "plaster"))
        }
    }
}

impl House {
    /// A closed rectangular room from the origin to `size_m` (x, height, z), each side one structure piece whose faces look inwards.
    ///
    /// # Errors
    /// [`SceneError::Range`] unless every edge lies in 0.1 to 1,000 m; faults of the materials.
    ///
    /// ```
    /// use dwell_scene::{House, ShoeboxMaterials};
    /// let house = House::shoebox([6.0, 3.0, 5.0], &ShoeboxMaterials::default())?;
    /// assert_eq!(house.structure.len(), 6);
    /// # Ok::<(), dwell_scene::SceneError>(())
    /// ```
    pub fn shoebox(size_m: [f32; 3], materials: &ShoeboxMaterials) -> Result<Self, SceneError> {
        if size_m.iter().any(|edge| !(0.1..=1000.0).contains(edge)) {
            let found = format!("{size_m:?}");
            return Err(SceneError::Range {
                at: "shoebox".into(),
                field: "size_m",
                found,
                allowed: "0.1 to 1000 m an edge",
            });
        }
        let size = Vec3::from_array(size_m);
        let (x, y, z) = (size.x, size.y, size.z);
        let v = Vec3::new;
        // Corners run counter-clockwise seen from inside, starting at the lower left one, so that v points up on walls.
        let sides = [
            (
                "floor",
                StructureKind::Floor,
                &materials.floor,
                [v(0., 0., z), v(x, 0., z), v(x, 0., 0.), v(0., 0., 0.)],
            ),
            (
                "ceiling",
                StructureKind::Ceiling,
                &materials.ceiling,
                [v(0., y, 0.), v(x, y, 0.), v(x, y, z), v(0., y, z)],
            ),
            (
                "west",
                StructureKind::Wall,
                &materials.west,
                [v(0., 0., z), v(0., 0., 0.), v(0., y, 0.), v(0., y, z)],
            ),
            (
                "east",
                StructureKind::Wall,
                &materials.east,
                [v(x, 0., 0.), v(x, 0., z), v(x, y, z), v(x, y, 0.)],
            ),
            (
                "north",
                StructureKind::Wall,
                &materials.north,
                [v(0., 0., 0.), v(x, 0., 0.), v(x, y, 0.), v(0., y, 0.)],
            ),
            (
                "south",
                StructureKind::Wall,
                &materials.south,
                [v(x, 0., z), v(0., 0., z), v(0., y, z), v(x, y, z)],
            ),
        ];
        let mut data = HouseData {
            name: "shoebox".into(),
            source: "shoebox@1".into(),
            ..HouseData::default()
        };
        let bounds = Aabb::new(Vec3::ZERO, size);
        data.levels.push(Level {
            name: "0".into(),
            bounds,
        });
        data.rooms.push(Room {
            name: "room".into(),
            level: LevelId(0),
            kinds: vec!["room".into()],
            footprint: vec![
                [Vec2::ZERO, Vec2::new(x, 0.0), Vec2::new(x, z)],
                [Vec2::ZERO, Vec2::new(x, z), Vec2::new(0.0, z)],
            ],
            floor_y: 0.0,
            ceiling_y: y,
            bounds,
        });
        for (name, kind, material, corners) in sides {
            let mesh = data.meshes.push(Arc::new(Mesh::rectangle(corners)));
            let material = data.materials.push(Material {
                name: name.into(),
                ..material.clone()
            });
            let (room, level) = (Some(RoomId(0)), LevelId(0));
            data.structure.push(Structure {
                name: name.into(),
                kind,
                room,
                level,
                mesh,
                materials: vec![material],
            });
        }
        Self::new(data)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shoebox_is_closed_and_looks_inwards() {
        let house = House::shoebox([6.0, 3.0, 5.0], &ShoeboxMaterials::default()).unwrap();
        let mut all = Mesh::default();
        for piece in &house.structure {
            all.append(&house.meshes[piece.mesh], 0);
        }
        assert!(
            (all.enclosed_volume_m3() + 90.0).abs() < 1e-4,
            "{}",
            all.enclosed_volume_m3()
        );
        assert!((all.area_m2() - 126.0).abs() < 1e-4);
        assert!((house.rooms[RoomId(0)].area_m2() - 30.0).abs() < 1e-5);
        assert_eq!(house.room_at(Vec3::new(1.0, 1.2, 1.0)), Some(RoomId(0)));
        assert_eq!(house.room_at(Vec3::new(-1.0, 1.2, 1.0)), None);
        assert!(House::shoebox([0.0, 3.0, 5.0], &ShoeboxMaterials::default()).is_err());
    }
}
