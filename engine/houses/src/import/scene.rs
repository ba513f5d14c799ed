//! Conversion of named meshes of a general format into a house.
//!
//! Formats such as OBJ and glTF know meshes and names, but no rooms and doors. The meaning of a name is used: walls,
//! floors and ceilings become structure, one room lies over the floors (unless the file names its rooms), everything else
//! is an object of the category that its name means.

use std::collections::BTreeMap;
use std::sync::Arc;

use dwell_scene::{
    Aabb, Category, Collider, House, HouseData, Id, Level, LevelId, Mesh, MeshId, Mobility, Object,
    ObjectId, Part, PartId, Room, RoomId, Sky, Structure, StructureKind, Texture, interrupt, space,
};
use glam::{Affine3A, Vec2, Vec3};

use super::CategoryRow;
use super::annotated::{AnnotatedObject, ImportedObject};
use super::floor_faces::{FloorFaces, floor_faces, no_level_floor_warning};
use super::lamps::{self, ImportedLamp};
use super::rooms_check::report_contained_rooms;
use super::{MaterialTableBuilder, UniqueNames, category, convex_pieces};
use crate::error::HousesError;
use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;

/// Largest gap between a thing and its support, m.
const GAP_M: f32 = 0.03;

/// A named mesh with its transform and materials.
pub(crate) struct SceneNode {
    pub(crate) name: String,
    pub(crate) mesh: Arc<Mesh>,
    pub(crate) world_from_mesh: Affine3A,
    pub(crate) materials: Vec<dwell_scene::MaterialId>,
    /// The storey and the room in which the file puts it, as positions in [`ImportedScene`].
    pub(crate) level: Option<usize>,
    pub(crate) room: Option<usize>,
    pub(crate) role: NodeRole,
    /// The object and its part, as positions in [`ImportedScene::objects`], whose look this is.
    pub(crate) part_of: Option<(usize, usize)>,
}

/// The role that a file states for a node.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) enum NodeRole {
    /// None: its name may mean something.
    #[default]
    Unspecified,
    /// A piece of the building.
    Building(StructureKind),
    /// An object.
    Object,
}

impl SceneNode {
    fn structure_kind(&self) -> Option<StructureKind> {
        match self.role {
            NodeRole::Unspecified => structure_kind(&self.name),
            NodeRole::Building(kind) => Some(kind),
            NodeRole::Object => None,
        }
    }

    /// Returns whether its transform leaves it a volume; one that does not is reported.
    fn has_invertible_transform(&self, at: &FileLocation, report: &mut LoadReport) -> bool {
        let keeps = !space::is_singular(&self.world_from_mesh.matrix3);
        if !keeps {
            let reason = "it flattens space".to_owned();
            report.warn(at.field(&self.name), WarningKind::BadTransform { reason });
        }
        keeps
    }
}

/// A room that a file names.
pub(crate) struct NamedRoom {
    pub(crate) name: String,
    /// Its storey, as a position in [`ImportedScene::levels`].
    pub(crate) level: usize,
    pub(crate) kinds: Vec<String>,
    /// Triangles of (x, z), m.
    pub(crate) footprint: Vec<[Vec2; 3]>,
    pub(crate) floor_y: f32,
    pub(crate) ceiling_y: f32,
}

/// A scene of named meshes.
pub(crate) struct ImportedScene {
    pub(crate) name: String,
    pub(crate) source: &'static str,
    pub(crate) nodes: Vec<SceneNode>,
    pub(crate) materials: MaterialTableBuilder,
    pub(crate) textures: Vec<Arc<Texture>>,
    /// Storeys that the file names; empty: one.
    pub(crate) levels: Vec<String>,
    /// Rooms that the file names; empty: one over all floors.
    pub(crate) rooms: Vec<NamedRoom>,
    pub(crate) sky: Option<Sky>,
    pub(crate) lamps: Vec<ImportedLamp>,
    /// Objects with more than shapes and names in the file.
    pub(crate) objects: Vec<AnnotatedObject>,
}

impl ImportedScene {
    /// Makes the house.
    ///
    /// # Errors
    /// [`HousesError::Empty`] without a triangle, [`HousesError::Scene`] when the result breaks a rule of the scene.
    pub(crate) fn into_house(
        self,
        at: &FileLocation,
        report: &mut LoadReport,
    ) -> Result<House, HousesError> {
        if self
            .nodes
            .iter()
            .all(|thing| thing.mesh.triangles.is_empty())
        {
            return Err(HousesError::empty(at, report));
        }
        let data = HouseData {
            name: self.name,
            source: self.source.to_owned(),
            materials: self.materials.finish_materials(),
            textures: self.textures.into(),
            sky: self.sky,
            ..HouseData::default()
        };
        let mut builder = HouseBuilder {
            data,
            ..HouseBuilder::default()
        };
        let one = (self.levels.is_empty()).then(|| "0".to_owned());
        for name in one.into_iter().chain(self.levels) {
            let bounds = Aabb::EMPTY;
            builder.data.levels.push(Level { name, bounds });
        }
        let named = !self.rooms.is_empty();
        for room in self.rooms {
            builder.named_room(room);
        }
        let (given, things) = assemble_annotated_objects(self.objects, self.nodes, at, report);
        let (structure, objects): (Vec<_>, Vec<_>) = things
            .into_iter()
            .filter(|thing| !thing.mesh.triangles.is_empty())
            .filter(|thing| thing.has_invertible_transform(at, report))
            .partition(|thing| thing.structure_kind().is_some());
        let alone = structure.is_empty() && given.is_empty() && objects.len() == 1;
        for thing in structure {
            builder.structure(thing);
        }
        if !named {
            room_over_floors(&mut builder.data, at, report);
        }
        for object in given {
            builder.add_annotated_object(object);
        }
        let known = builder.data.objects.len();
        for thing in objects {
            interrupt::unwind_if_cancelled();
            builder.object(thing, alone, at, report);
        }
        builder.make_floating_objects_fixed(alone, known);
        lamps::attach_lamps(self.lamps, &mut builder.data, &builder.bounds);
        if builder.data.structure.is_empty() && builder.data.objects.is_empty() {
            return Err(HousesError::empty(at, report));
        }
        let house = House::new(builder.data).map_err(HousesError::scene(at))?;
        report_contained_rooms(&house, at, report);
        Ok(house)
    }
}

/// Objects with the meshes of their parts, in the order of the house that was written, and the things that are left: those of
/// objects that were scaled are things like any other.
fn assemble_annotated_objects(
    objects: Vec<AnnotatedObject>,
    things: Vec<SceneNode>,
    at: &FileLocation,
    report: &mut LoadReport,
) -> (Vec<ImportedObject>, Vec<SceneNode>) {
    let mut looks: Vec<Vec<Option<SceneNode>>> = objects
        .iter()
        .map(|object| object.parts.iter().map(|_| None).collect())
        .collect();
    let mut left = Vec::new();
    for thing in things {
        match thing.part_of {
            Some((object, part)) => looks[object][part] = Some(thing),
            None => left.push(thing),
        }
    }
    let mut ready = Vec::new();
    for (object, own) in objects.into_iter().zip(looks) {
        let shapes = own.iter().map(|thing| {
            thing
                .as_ref()
                .map(|t| (t.mesh.clone(), t.materials.clone()))
        });
        match ImportedObject::new(object, shapes.collect()) {
            Ok(object) => ready.push(object),
            Err(name) => {
                let what = "it was scaled, so that what extras say of its joints, masses and shapes is not read";
                let damage = WarningKind::Simplified {
                    what: what.to_owned(),
                };
                report.warn(at.field(name), damage);
                left.extend(own.into_iter().flatten());
            }
        }
    }
    ready.sort_by_key(ImportedObject::order);
    (ready, left)
}

/// Returns the kind of structure that a name means, if it means one: `Wall_3`, `WallInside#0_0_1`, `floor`; not `wall_lamp_1`.
pub(crate) fn structure_kind(name: &str) -> Option<StructureKind> {
    let lower = name.to_ascii_lowercase();
    let words = lower.split(|c: char| !c.is_ascii_alphabetic());
    let mut words = words.filter(|word| !word.is_empty());
    let word = words.next()?;
    if let Some(second) = words.next()
        && category([format!("{word}_{second}").as_str()]).is_some()
    {
        return None;
    }
    match word {
        "wall" | "walls" | "wallinside" | "walloutside" => Some(StructureKind::Wall),
        "floor" | "floors" => Some(StructureKind::Floor),
        "ceiling" | "ceilings" => Some(StructureKind::Ceiling),
        "ground" => Some(StructureKind::Ground),
        "roof" => Some(StructureKind::Other),
        _ => None,
    }
}

/// The row that a name means: `coffee_table_2` means `coffee_table`, `Blue Chair` means `chair`.
pub(crate) fn category_of(name: &str) -> Option<&'static CategoryRow> {
    let lower = name.to_ascii_lowercase();
    let words: Vec<&str> = lower
        .split(|c: char| !c.is_ascii_alphabetic())
        .filter(|word| !word.is_empty())
        .collect();
    let joined = words.join("_");
    let tails = (0..words.len()).map(|start| words[start..].join("_"));
    tails
        .chain([joined])
        .find_map(|candidate| category([candidate.as_str()]))
}

/// One room over all floors of the first storey, to which all pieces of the building belong; floors of which none can be made are
/// reported.
pub(crate) fn room_over_floors(data: &mut HouseData, at: &FileLocation, report: &mut LoadReport) {
    let of = |kind: StructureKind| {
        let pieces = data.structure.iter();
        let pieces = pieces.filter(move |piece| piece.kind == kind);
        pieces.map(|piece| &data.meshes[piece.mesh])
    };
    let Some(FloorFaces { footprint, floor_y }) =
        floor_faces(of(StructureKind::Floor).map(|mesh| &**mesh))
    else {
        let floor = |piece: &&Structure| piece.kind == StructureKind::Floor;
        if let Some(piece) = data.structure.iter().find(floor) {
            report.warn(at.field(&piece.name), no_level_floor_warning());
        }
        return;
    };
    let bounds = data.levels[LEVEL].bounds;
    let ceiling_y = of(StructureKind::Ceiling)
        .map(|mesh| mesh.bounds().min.y)
        .filter(|ceiling_y| *ceiling_y >= floor_y)
        .reduce(f32::min)
        .unwrap_or(bounds.max.y);
    let mut room = Room {
        name: "room_1".to_owned(),
        level: LEVEL,
        kinds: Vec::new(),
        footprint,
        floor_y,
        ceiling_y,
        bounds,
    };
    room.repair_footprint_and_ceiling();
    if room.footprint.is_empty() {
        return;
    }
    let id = data.rooms.push(room);
    data.structure
        .iter_mut()
        .for_each(|piece| piece.room = Some(id));
}

#[derive(Default)]
struct HouseBuilder {
    data: HouseData,
    names: UniqueNames,
    structure_names: UniqueNames,
    /// Unique names of the rooms in the file.
    room_names: UniqueNames,
    /// The box of each object.
    bounds: Vec<Aabb>,
    /// Meshes of objects that are part of the house already, by address.
    meshes: BTreeMap<usize, MeshId>,
}

const LEVEL: LevelId = LevelId(0);

impl HouseBuilder {
    fn grow(&mut self, level: LevelId, bounds: &Aabb) {
        self.data.levels[level].bounds = self.data.levels[level].bounds.union(bounds);
    }

    /// The storey of a thing.
    fn level(&self, thing: &SceneNode) -> LevelId {
        let known = thing.level.filter(|k| *k < self.data.levels.len());
        known.map_or(LEVEL, |k| LevelId(k as u32))
    }

    fn named_room(&mut self, room: NamedRoom) {
        let mut bounds = Aabb::EMPTY;
        for p in room.footprint.iter().flatten() {
            bounds.add_point(Vec3::new(p.x, room.floor_y, p.y));
            bounds.add_point(Vec3::new(p.x, room.ceiling_y, p.y));
        }
        let mut room = Room {
            name: self.room_names.unique(&room.name),
            level: LevelId(room.level as u32),
            kinds: room.kinds,
            footprint: room.footprint,
            floor_y: room.floor_y,
            ceiling_y: room.ceiling_y,
            bounds,
        };
        room.repair_footprint_and_ceiling();
        self.data.rooms.push(room);
    }

    fn structure(&mut self, thing: SceneNode) {
        let Some(kind) = thing.structure_kind() else {
            return;
        };
        let level = self.level(&thing);
        let mesh = thing.mesh.transformed(&thing.world_from_mesh);
        self.grow(level, &mesh.bounds());
        let name = self.structure_names.unique(&thing.name);
        let mesh = self.data.meshes.push(Arc::new(mesh));
        self.data.structure.push(Structure {
            name,
            kind,
            room: thing.room.map(|k| RoomId(k as u32)),
            level,
            mesh,
            materials: thing.materials,
        });
    }

    /// Returns the id of an object's mesh, which several may share.
    fn mesh(meshes: &mut BTreeMap<usize, MeshId>, data: &mut HouseData, mesh: Arc<Mesh>) -> MeshId {
        let address = Arc::as_ptr(&mesh).addr();
        *meshes
            .entry(address)
            .or_insert_with(|| data.meshes.push(mesh))
    }

    fn add_annotated_object(&mut self, object: ImportedObject) {
        let (level, _) = object.level_and_room();
        let level = level.filter(|k| *k < self.data.levels.len());
        let level = level.map_or(LEVEL, |k| LevelId(k as u32));
        let bounds = object.bounds();
        self.grow(level, &bounds);
        self.bounds.push(bounds);
        let name = self.names.unique(object.name());
        let meshes = &mut self.meshes;
        object.add_to_house(&mut self.data, name, level, |data, mesh| {
            Self::mesh(meshes, data, mesh)
        });
    }

    fn object(
        &mut self,
        thing: SceneNode,
        alone: bool,
        at: &FileLocation,
        report: &mut LoadReport,
    ) {
        let Some((pose, part_from_mesh)) = space::split_affine(&thing.world_from_mesh) else {
            let reason = "it flattens space or is not finite".to_owned();
            return report.warn(at.field(&thing.name), WarningKind::BadTransform { reason });
        };
        let world_from_mesh = pose.to_affine() * part_from_mesh;
        let bounds = Aabb::from_points(
            thing
                .mesh
                .positions
                .iter()
                .map(|p| world_from_mesh.transform_point3(*p)),
        );
        let level = self.level(&thing);
        self.grow(level, &bounds);
        self.bounds.push(bounds);
        let row = category_of(&thing.name);
        let moves = alone || row.is_some_and(|row| row.is_movable() && !row.is_mounted());
        let colliders = if moves {
            convex_pieces(&thing.mesh, &part_from_mesh)
        } else {
            vec![Collider::ExactMesh]
        };
        let mesh = Self::mesh(&mut self.meshes, &mut self.data, thing.mesh.clone());
        let id = ObjectId(self.data.objects.len() as u32);
        let density_kg_m3 = row
            .map_or(300.0, CategoryRow::box_density_kg_m3)
            .clamp(0.1, 30_000.0);
        let box_m3 = bounds.volume();
        self.data.parts.push(Part {
            object: id,
            name: "body".to_owned(),
            fixed: !moves,
            world_from_part: pose,
            mesh,
            part_from_mesh,
            materials: thing.materials,
            colliders,
            mass_kg: moves.then(|| (box_m3 * density_kg_m3).clamp(0.02, 2000.0)),
            inertial: None,
            density_kg_m3,
        });
        let first_part = PartId(self.data.parts.len() as u32 - 1);
        let handy = bounds.size().max_element() <= 0.6 && box_m3 <= 0.05;
        let center = bounds.center();
        let in_room =
            |room: &Room| room.level == level && room.contains_xz(Vec2::new(center.x, center.z));
        let over = || self.data.rooms.iter().position(in_room);
        let room = thing.room.or_else(over).map(|k| RoomId(k as u32));
        self.data.objects.push(Object {
            name: self.names.unique(&thing.name),
            source_id: thing.name.clone(),
            model: thing.name,
            category: row.map_or_else(Category::default, |row| Category {
                fine: row.name.clone(),
                coarse: row.name.clone(),
                nyu40: row.nyu40_name.clone(),
            }),
            level,
            room,
            mobility: if moves {
                Mobility::Movable
            } else {
                Mobility::Fixed
            },
            pickable: moves && handy,
            switch: row.is_some_and(CategoryRow::is_switchable).then_some(false),
            first_part,
            part_count: 1,
        });
    }

    /// Makes movable things fixed that float: they would only fall. The first `known` objects are as their file says.
    fn make_floating_objects_fixed(&mut self, alone: bool, known: usize) {
        let floor_of = |level: LevelId| {
            let rooms = self.data.rooms.iter().filter(|room| room.level == level);
            let floor_y = rooms.map(|room| room.floor_y).reduce(f32::max);
            floor_y.unwrap_or(self.data.levels[level].bounds.min.y)
        };
        let grounds: Vec<f32> = self.data.levels.ids().map(floor_of).collect();
        for (k, object) in self.data.objects.iter_mut().enumerate().skip(known) {
            interrupt::unwind_if_cancelled();
            let own = self.bounds[k];
            let foot = own.center().with_y(own.min.y);
            let stands = || {
                self.bounds.iter().enumerate().any(|(other, b)| {
                    other != k
                        && b.min.y < foot.y - 0.01
                        && foot.y < b.max.y + GAP_M
                        && b.contains(foot.with_y(b.center().y))
                })
            };
            if object.mobility == Mobility::Movable
                && !alone
                && (foot.y - grounds[object.level.index()]).abs() > GAP_M
                && !stands()
            {
                object.mobility = Mobility::Fixed;
                object.pickable = false;
                let part = &mut self.data.parts[object.first_part];
                (part.fixed, part.colliders, part.mass_kg) =
                    (true, vec![Collider::ExactMesh], None);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_mean_structure_or_a_category() {
        assert_eq!(
            structure_kind("WallInside#0_0_1"),
            Some(StructureKind::Wall)
        );
        assert_eq!(
            (
                structure_kind("Floor.001"),
                structure_kind("floorlamp"),
                structure_kind("12")
            ),
            (Some(StructureKind::Floor), None, None)
        );
        let name = |text| category_of(text).map(|row| row.name.as_str());
        assert_eq!(
            (name("coffee_table_2"), name("Blue Chair.003"), name("Cube")),
            (Some("coffee_table"), Some("chair"), None)
        );
    }

    /// Each floating thing is compared with all others.
    #[test]
    fn many_floating_things_can_be_stopped() {
        let mut builder = HouseBuilder::default();
        let (name, bounds) = ("0".to_owned(), Aabb::EMPTY);
        builder.data.levels.push(Level { name, bounds });
        let mesh = Arc::new(Mesh::cuboid(Vec3::splat(-0.1), Vec3::splat(0.1)));
        for k in 0..20_000 {
            let thing = SceneNode {
                name: "chair".to_owned(),
                mesh: mesh.clone(),
                world_from_mesh: Affine3A::from_translation(Vec3::Y * k as f32),
                materials: Vec::new(),
                level: None,
                room: None,
                role: NodeRole::Object,
                part_of: None,
            };
            let at = FileLocation::file("a.gltf");
            builder.object(thing, false, &at, &mut LoadReport::new());
        }
        let stopped =
            interrupt::interruptible(|| true, || builder.make_floating_objects_fixed(false, 0));
        assert!(stopped.is_err());
    }
}
