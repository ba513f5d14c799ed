//! Conversion of SUNCG files into a [`House`]: every decision about meaning is made below this folder.

mod arch;
mod boxes;
mod fixtures;
mod hinge;
mod mobility;
mod nodes;
mod objects;
mod parts;
mod place;
mod rooms;
mod shapes;
mod surface;

use std::collections::BTreeMap;

use dwell_scene::parallel::Threads;
use dwell_scene::{Aabb, House, HouseData, Level, LevelId, PartId, RoomId, TextureId};
use glam::Affine3A;
use tracing::debug_span;

use super::read::ParsedSuncgFiles;
use crate::error::HousesError;
use crate::import::{
    MaterialTableBuilder, UniqueNames, drop_rooms_without_floor, report_contained_rooms,
};
use crate::report::{FileLocation, LoadReport};

/// Converts the files into a house.
///
/// # Errors
/// [`HousesError::Field`] for axes nothing can be made of, [`HousesError::Empty`] when no triangle is left,
/// [`HousesError::Scene`] when the result breaks a rule of the scene. Everything else is reported.
pub fn convert(
    files: &ParsedSuncgFiles,
    threads: Threads,
    report: &mut LoadReport,
) -> Result<House, HousesError> {
    let at = FileLocation::file(&files.house_path);
    let data = HouseData {
        name: files
            .house
            .id
            .clone()
            .filter(|id| !id.is_empty())
            .unwrap_or_else(|| files.scene_id.clone()),
        source: files
            .house
            .version
            .clone()
            .unwrap_or_else(|| "suncg".to_owned()),
        ..HouseData::default()
    };
    let mut converter = Converter {
        files,
        world_from_file: place::world_from_file(&files.house, &at)?,
        node_names: nodes::names(&files.house, &at, report),
        shapes: {
            let _span = debug_span!("shapes").entered();
            shapes::ModelShapes::build(files, threads, report)
        },
        at,
        report,
        data,
        looks: MaterialTableBuilder::default(),
        textures: BTreeMap::new(),
        object_names: UniqueNames::default(),
        structure_names: UniqueNames::default(),
        stands: Vec::new(),
        arch_used: Vec::new(),
        corners_shown: 0,
    };
    {
        let _span = debug_span!("rooms").entered();
        converter.levels_and_rooms();
    }
    {
        let _span = debug_span!("objects").entered();
        converter.objects();
    }
    {
        let _span = debug_span!("bodies").entered();
        converter.add_convex_colliders(threads);
    }
    converter.finish()
}

/// A house under construction.
struct Converter<'a> {
    files: &'a ParsedSuncgFiles,
    at: FileLocation,
    report: &'a mut LoadReport,
    /// Scale and axes of the file; the identity in every file seen.
    world_from_file: Affine3A,
    /// The name of each node by level and index.
    node_names: Vec<Vec<String>>,
    shapes: shapes::ModelShapes,
    data: HouseData,
    looks: MaterialTableBuilder,
    /// Textures that are in use, by path.
    textures: BTreeMap<&'a str, TextureId>,
    object_names: UniqueNames,
    structure_names: UniqueNames,
    /// Bounds of the parts made so far, to see what rests on what.
    stands: Vec<(PartId, Aabb)>,
    /// True for each element of `arch.json` that some room has.
    arch_used: Vec<bool>,
    /// Number of corners of all rooms' meshes so far.
    corners_shown: u64,
}

/// A node's position: level, position there.
type NodeKey = (usize, usize);

impl Converter<'_> {
    /// The place of a node in `house.json`.
    fn node_at(&self, (level, node): NodeKey) -> FileLocation {
        self.at.field(format_args!("levels[{level}].nodes[{node}]"))
    }

    fn level_id(level: usize) -> LevelId {
        LevelId(level as u32)
    }

    fn levels_and_rooms(&mut self) {
        for (k, level) in self.files.house.levels.iter().enumerate() {
            let name = level.id.clone().unwrap_or_else(|| k.to_string());
            self.data.levels.push(Level {
                name,
                bounds: Aabb::EMPTY,
            });
        }
        for (key, node) in self.files.house.valid_nodes() {
            match node.kind.as_deref() {
                Some("Room") => self.room(key, node),
                Some("Ground") => self.ground(key, node),
                _ => {}
            }
        }
        self.add_unclaimed_arch_elements();
    }

    /// The room of a point, by floors: the smallest that holds it.
    fn room_around(&self, point: glam::Vec3) -> Option<RoomId> {
        let holds = |room: &dwell_scene::Room| {
            (room.floor_y - 0.3..=room.ceiling_y + 0.3).contains(&point.y)
                && room.contains_xz(glam::Vec2::new(point.x, point.z))
        };
        let rooms = self.data.rooms.iter_ids().filter(|(_, room)| holds(room));
        rooms
            .min_by(|(_, a), (_, b)| a.area_m2().total_cmp(&b.area_m2()))
            .map(|(id, _)| id)
    }

    fn finish(mut self) -> Result<House, HousesError> {
        self.data.materials = self.looks.finish_materials();
        let seen = self
            .data
            .structure
            .iter()
            .map(|piece| piece.mesh)
            .chain(self.data.parts.iter().map(|part| part.mesh));
        if seen
            .map(|mesh| self.data.meshes[mesh].triangles.len())
            .sum::<usize>()
            == 0
        {
            return Err(HousesError::empty(&self.at, self.report));
        }
        let _span = debug_span!("check").entered();
        drop_rooms_without_floor(&mut self.data, &self.at, self.report);
        let house = House::new(self.data).map_err(HousesError::scene(&self.at))?;
        report_contained_rooms(&house, &self.at, self.report);
        Ok(house)
    }
}
