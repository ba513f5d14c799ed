//! A house of several bodies, as `MolmoSpaces` and others write them for `MuJoCo`.
//!
//! Bodies and geoms with names of walls, floors and ceilings become the building, each floor a room; every other body of
//! the world becomes an object with its child bodies.

use std::sync::Arc;

use dwell_scene::material::{Substance, library};
use dwell_scene::{
    Aabb, Category, House, HouseData, Level, LevelId, Material, MaterialId, Mobility, ObjectId,
    Pose, Room, RoomId, Structure, StructureKind, interrupt, units,
};
use glam::{Vec2, Vec3};
use mjcf_rs::BodyId;

use super::geoms::BodyGeom;
use super::read::{MjcfSource, name_of, pose};
use crate::error::HousesError;
use crate::import::{
    CategoryRow, FloorFaces, UniqueNames, category_of, floor_faces, no_level_floor_warning,
    room_kind, structure_kind, substance_of,
};
use crate::report::LoadReport;
use crate::robot;
use crate::warning_kind::{UnmappedKind, WarningKind};

/// The one storey; where floors differ by more, the report says so.
const LEVEL: LevelId = LevelId(0);
/// Height of rooms without ceiling and walls, m.
const CEILING_M: f32 = 2.5;
/// Largest side of a thing that a hand takes, m.
const HANDY_M: f32 = 0.6;
/// Largest number of joints of an object that counts as furniture; more are a robot.
const MOST_JOINTS: usize = 40;

/// Returns whether the file is a house: more than one body is in the world, or one beside geoms with names of walls or floors.
pub(super) fn is_house(source: &MjcfSource) -> bool {
    let world = &source.model.bodies[0].body;
    let built = world
        .geoms
        .iter()
        .filter_map(|geom| structure_kind(geom.name.as_deref()?));
    let walls = built.filter(|kind| *kind == StructureKind::Wall).count();
    source.root_bodies().len() > 1 || walls > 1
}

/// Reads the house.
///
/// # Errors
/// [`HousesError::Empty`] when no triangle is left,
/// [`HousesError::Scene`] when the result breaks a rule of the scene.
pub(super) fn read(mut source: MjcfSource, report: &mut LoadReport) -> Result<House, HousesError> {
    let at = source.at.clone();
    let stem = source.name().rsplit('/').next().unwrap_or_default();
    let stem = stem.rsplit_once('.').map_or(stem, |(stem, _)| stem);
    let name = source.model.name.clone().unwrap_or_else(|| stem.to_owned());
    let mut reader = MjcfHouseReader {
        data: HouseData {
            name,
            source: "mjcf".to_owned(),
            ..HouseData::default()
        },
        structure_names: UniqueNames::default(),
        names: UniqueNames::default(),
        material_names: robot::MaterialNames::default(),
        world_from_file: robot::dwell_from_robot(),
    };
    reader.data.levels.push(Level {
        name: "0".to_owned(),
        bounds: Aabb::EMPTY,
    });
    let mut objects = Vec::new();
    match source.body_geoms(0, report) {
        Ok(pieces) => reader.building(&source, 0, Pose::IDENTITY, &pieces, report),
        Err(error) => report_skipped_body(&error, &source, report),
    }
    for root in source.root_bodies() {
        if structure_kind(&name_of(&source.model, root)).is_some() {
            reader.add_building_bodies(&mut source, root, report);
        } else {
            objects.push(root);
        }
    }
    reader.rooms(report, &source);
    for root in objects {
        interrupt::unwind_if_cancelled();
        match source.robot(root, report) {
            Ok(thing) => reader.object(&source, root, &thing, report),
            Err(error) => report_skipped_body(&error, &source, report),
        }
    }
    let mut data = reader.data;
    if data.meshes.iter().all(|mesh| mesh.triangles.is_empty()) {
        return Err(HousesError::empty(&at, report));
    }
    assign_rooms(&mut data);
    House::new(data).map_err(HousesError::scene(&at))
}

fn report_skipped_body(error: &HousesError, source: &MjcfSource, report: &mut LoadReport) {
    let what = format!("left out: {error}");
    report.warn(
        source.at.field("worldbody"),
        WarningKind::Simplified { what },
    );
}

struct MjcfHouseReader {
    data: HouseData,
    structure_names: UniqueNames,
    names: UniqueNames,
    material_names: robot::MaterialNames,
    /// From the file's axes, +Z up, to ours.
    world_from_file: Pose,
}

impl MjcfHouseReader {
    /// Adds a body of the building and all below it.
    fn add_building_bodies(
        &mut self,
        source: &mut MjcfSource,
        root: BodyId,
        report: &mut LoadReport,
    ) {
        let mut open = vec![(root, Pose::IDENTITY)];
        while let Some((id, file_from_parent)) = open.pop() {
            interrupt::unwind_if_cancelled();
            let file_from_body = file_from_parent * pose(&source.model.bodies[id].body.pose);
            match source.body_geoms(id, report) {
                Ok(pieces) => self.building(source, id, file_from_body, &pieces, report),
                Err(error) => report_skipped_body(&error, source, report),
            }
            let children = source.children(id).iter();
            open.extend(children.map(|child| (*child, file_from_body)));
        }
    }

    /// Adds the geoms of a body as pieces of the building: the visual ones, or without any the collision ones.
    fn building(
        &mut self,
        source: &MjcfSource,
        id: BodyId,
        file_from_body: Pose,
        pieces: &[BodyGeom],
        report: &mut LoadReport,
    ) {
        let body = name_of(&source.model, id);
        let seen = pieces.iter().any(|piece| piece.is_visible);
        for piece in pieces.iter().filter(|piece| piece.is_visible || !seen) {
            interrupt::unwind_if_cancelled();
            let name = match (&piece.name, id) {
                (Some(name), _) if structure_kind(name).is_some() || id == 0 => name.clone(),
                (None, 0) => "geom".to_owned(),
                _ => body.clone(),
            };
            let kind = structure_kind(&name).unwrap_or(if piece.is_plane {
                StructureKind::Ground
            } else {
                StructureKind::Other
            });
            let material = self.material(piece, &name, report, source);
            let place = self.world_from_file * file_from_body * piece.shape.link_from_shape;
            let mut mesh = piece
                .shape
                .geometry
                .surface()
                .transformed(&place.to_affine());
            mesh.slots = Vec::new();
            if piece.shape.image.is_none() {
                mesh.uvs = Vec::new();
            }
            let bounds = mesh.bounds();
            self.data.levels[LEVEL].bounds = self.data.levels[LEVEL].bounds.union(&bounds);
            let mesh = self.data.meshes.push(Arc::new(mesh));
            self.data.structure.push(Structure {
                name: self.structure_names.unique(&name),
                kind,
                room: None,
                level: LEVEL,
                mesh,
                materials: vec![material],
            });
        }
    }

    /// A material of the building: by the meaning of its name, else plaster, or parquet on floors.
    fn material(
        &mut self,
        piece: &BodyGeom,
        name: &str,
        report: &mut LoadReport,
        source: &MjcfSource,
    ) -> MaterialId {
        let known = substance_by_words(&piece.shape.material);
        if known.is_none() && !piece.shape.material.is_empty() {
            let damage = WarningKind::Unmapped {
                what: UnmappedKind::Substance,
                name: piece.shape.material.clone(),
            };
            report.warn(source.at.field("asset"), damage);
        }
        let floor = structure_kind(name) == Some(StructureKind::Floor);
        let usual = if floor { "parquet" } else { "painted_plaster" };
        let substance = known.unwrap_or_else(|| library().get_or_default(usual));
        let word = if piece.shape.material.is_empty() {
            "surface"
        } else {
            &piece.shape.material
        };
        let mut material = Material::from_substance(word.replace(['/', '\\'], "-"), substance);
        let image = piece.shape.image.as_ref();
        material.texture = image.map(|image| robot::texture(&mut self.data, image));
        if material.texture.is_some() {
            material.base_color = [1.0; 3];
        }
        if let Some([r, g, b, opacity]) = piece.shape.rgba {
            let clean = |x: f32| {
                if x.is_finite() {
                    x.clamp(0.0, 1.0)
                } else {
                    0.0
                }
            };
            material.base_color = [r, g, b].map(|c| units::linear_from_srgb(clean(c)));
            material.opacity = clean(opacity);
        }
        let same = |other: &Material| {
            Material {
                name: material.name.clone(),
                ..other.clone()
            } == material
                && other.name.starts_with(&material.name)
        };
        if let Some(k) = self.data.materials.iter().position(same) {
            return MaterialId(k as u32);
        }
        let names = || self.data.materials.iter().map(|other| &other.name);
        let base = material.name.clone();
        let mut number = 2;
        while names().any(|other| *other == material.name) {
            material.name = format!("{base}_{number}");
            number += 1;
        }
        self.data.materials.push(material)
    }

    /// A room over each floor.
    fn rooms(&mut self, report: &mut LoadReport, source: &MjcfSource) {
        let mut names = UniqueNames::default();
        let bounds_of = |data: &HouseData, kind: StructureKind| -> Vec<Aabb> {
            let pieces = data.structure.iter().filter(|piece| piece.kind == kind);
            pieces
                .map(|piece| data.meshes[piece.mesh].bounds())
                .collect()
        };
        let ceilings = bounds_of(&self.data, StructureKind::Ceiling);
        let walls = bounds_of(&self.data, StructureKind::Wall);
        for k in 0..self.data.structure.len() {
            interrupt::unwind_if_cancelled();
            let piece = &self.data.structure.as_slice()[k];
            if piece.kind != StructureKind::Floor {
                continue;
            }
            let mesh = &self.data.meshes[piece.mesh];
            let bounds = mesh.bounds();
            let found = floor_faces(std::iter::once(&**mesh));
            let Some(FloorFaces { footprint, floor_y }) = found else {
                let at = source.at.field(format_args!("worldbody.{}", piece.name));
                report.warn(at, no_level_floor_warning());
                continue;
            };
            let over = |other: &&Aabb| {
                other.min.x < bounds.max.x
                    && other.max.x > bounds.min.x
                    && other.min.z < bounds.max.z
                    && other.max.z > bounds.min.z
                    && other.max.y > floor_y + 1.0
            };
            let above = ceilings.iter().filter(over).map(|b| b.min.y);
            let tops = walls.iter().filter(over).map(|b| b.max.y);
            let ceiling_y = above
                .filter(|y| *y > floor_y + 1.0)
                .reduce(f32::min)
                .or(tops.reduce(f32::max))
                .unwrap_or(floor_y + CEILING_M);
            let words = room_kind_from_name(&piece.name);
            let kind = words.and_then(|words| room_kind(&words).ok());
            if kind.is_none() {
                let damage = WarningKind::Unmapped {
                    what: UnmappedKind::RoomType,
                    name: piece.name.clone(),
                };
                report.warn(source.at.field("worldbody"), damage);
            }
            let name = names.numbered(&kind.as_deref().unwrap_or("room").replace(' ', "_"));
            let id = self.data.rooms.push(Room {
                name,
                level: LEVEL,
                kinds: kind.into_iter().collect(),
                footprint,
                floor_y,
                ceiling_y,
                bounds: Aabb::new(bounds.min, bounds.max.with_y(ceiling_y)),
            });
            self.data.structure.as_mut_slice()[k].room = Some(id);
        }
    }

    /// Adds a body with its child bodies.
    fn object(
        &mut self,
        source: &MjcfSource,
        root: BodyId,
        thing: &robot::Robot,
        report: &mut LoadReport,
    ) {
        let body = &source.model.bodies[root].body;
        let file_name = name_of(&source.model, root);
        let name = self.names.unique(&file_name);
        if name != file_name {
            let at = source.at.field(format_args!("body[{file_name}]"));
            let (id, renamed) = (file_name.clone(), name.clone());
            report.warn(at, WarningKind::DuplicateId { id, renamed });
        }
        let world_from_root = self.world_from_file * pose(&body.pose);
        robot::add(
            &mut self.data,
            thing,
            &name,
            world_from_root,
            thing.has_fixed_base(),
            &mut self.material_names,
        );
        let Some(object) = self.data.objects.as_mut_slice().last_mut() else {
            return;
        };
        object.source_id.clone_from(&file_name);
        object.model.clone_from(&file_name);
        let row = category_of(&file_name);
        let joints = thing.movable_joint_names().count();
        if let Some(row) = row {
            object.category = category(row);
            object.switch = row.is_switchable().then_some(false);
        } else if joints <= MOST_JOINTS && thing.is_passive() {
            object.category = Category::default();
        }
        if thing.has_fixed_base() && joints == 0 {
            object.mobility = Mobility::Fixed;
        }
    }
}

fn category(row: &CategoryRow) -> Category {
    Category {
        fine: row.name.clone(),
        coarse: row.name.clone(),
        nyu40: row.nyu40_name.clone(),
    }
}

/// The substance that a whole name means, or one of its words: `DarkWood_2` is wood.
fn substance_by_words(name: &str) -> Option<&'static Substance> {
    let mut words = String::new();
    for c in name.chars() {
        if c.is_ascii_uppercase() {
            words.push(' ');
        }
        words.push(if c.is_ascii_alphabetic() {
            c.to_ascii_lowercase()
        } else {
            ' '
        });
    }
    let mut words = words.split_whitespace();
    substance_of(name).or_else(|| words.find_map(substance_of))
}

/// `floor_living_room_2` as `living room`; `None` for a name without more.
fn room_kind_from_name(name: &str) -> Option<String> {
    let words: Vec<&str> = name
        .split(|c: char| !c.is_ascii_alphabetic())
        .filter(|word| !word.is_empty())
        .skip(1)
        .filter(|word| !matches!(*word, "visual" | "mesh" | "collision" | "geom" | "room"))
        .collect();
    if words.is_empty() {
        return None;
    }
    let plain = words.join(" ").to_ascii_lowercase();
    let with_room = format!("{plain} room");
    let known = [plain.clone(), with_room]
        .into_iter()
        .find(|words| room_kind(words).is_ok());
    known.or(Some(plain))
}

/// Assigns objects to rooms, and sets the storey's box; small loose things can be taken.
fn assign_rooms(data: &mut HouseData) {
    for k in 0..data.objects.len() {
        interrupt::unwind_if_cancelled();
        let id = ObjectId(k as u32);
        let parts = data.objects[id].parts().map(|part| &data.parts[part]);
        let bounds = parts.fold(Aabb::EMPTY, |all, part| {
            let map = part.world_from_part.to_affine() * part.part_from_mesh;
            let points = data.meshes[part.mesh].positions.iter();
            all.union(&Aabb::from_points(points.map(|p| map.transform_point3(*p))))
        });
        if bounds.is_empty() {
            continue;
        }
        let room = room_at(data, bounds.center());
        let level = &mut data.levels[LEVEL].bounds;
        *level = level.union(&bounds);
        let object = &mut data.objects[id];
        object.room = room;
        let loose = object.mobility == Mobility::Movable;
        object.pickable = loose && bounds.size().max_element() <= HANDY_M;
    }
}

/// The room of the one storey over whose floor a point lies, the smallest where several do.
fn room_at(data: &HouseData, point: Vec3) -> Option<RoomId> {
    let holds = |room: &Room| {
        (room.floor_y - 0.3..=room.ceiling_y + 0.3).contains(&point.y)
            && room.contains_xz(Vec2::new(point.x, point.z))
    };
    let rooms = data.rooms.iter_ids().filter(|(_, room)| holds(room));
    let smallest = rooms.min_by(|(_, a), (_, b)| a.area_m2().total_cmp(&b.area_m2()));
    smallest.map(|(id, _)| id)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_floors_mean_rooms() {
        let kind = |name: &str| room_kind_from_name(name).and_then(|words| room_kind(&words).ok());
        assert_eq!(kind("floor_kitchen_1").as_deref(), Some("kitchen"));
        assert_eq!(kind("floor_living_room").as_deref(), Some("living room"));
        assert_eq!(kind("floor"), None);
        assert_eq!(room_kind_from_name("floor_visual_3"), None);
    }
}
