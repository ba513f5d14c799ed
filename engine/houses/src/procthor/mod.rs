//! Houses of ProcTHOR: walls, doors and windows as the file has them, and our models for its assets.
//!
//! `docs/formats/procthor.md` lists the fields that are read, where they come from, and what is left out.

mod covers;
mod file;
mod objects;
mod shell;
mod sizes;

use std::collections::BTreeSet;
use std::path::Path;

use dwell_scene::{Aabb, House, Room, RoomId};
use glam::{DVec2, Quat, Vec2, Vec3};

use crate::building::assembly::HouseAssembly;
use crate::data_root::{DataRoot, is_json_containing};
use crate::error::HousesError;
use crate::import::{drop_rooms_without_floor, report_contained_rooms};
use crate::json;
use crate::limits::{MAX_NODES, MAX_TEXT_BYTES};
use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;
use file::{ProcThorHouse, ProcThorObject, Vector3};
use sizes::AssetSizes;

/// Returns whether `path` is a house of ProcTHOR: a JSON file that speaks of its parameters and of walls.
pub(crate) fn recognizes(path: &Path) -> bool {
    is_json_containing(path, &[&["\"proceduralParameters\""], &["\"walls\""]])
}

/// Opens a house. Sizes of assets come from an `asset-database.json` beside it, or up to two folders above, where there is
/// one.
///
/// # Errors
/// [`HousesError::Io`] when the file cannot be read, [`HousesError::Syntax`] when it is no JSON of that form,
/// [`HousesError::TooLarge`] for more objects than are read, [`HousesError::Empty`] without a room,
/// [`HousesError::Scene`] when the result breaks a rule of the scene. Everything else is reported.
pub fn open(path: &Path) -> Result<(House, LoadReport), HousesError> {
    let folder = path.parent().unwrap_or_else(|| Path::new(""));
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    std::fs::metadata(path).map_err(HousesError::io(path))?;
    let root = DataRoot::new(folder)?;
    let bytes = root.read_user_named(&name, MAX_TEXT_BYTES)?;
    let mut report = LoadReport::new();
    let sizes = AssetSizes::read_near(folder, &mut report);
    convert(&bytes, &name, &sizes, report)
}

fn convert(
    bytes: &[u8],
    name: &str,
    sizes: &AssetSizes,
    mut report: LoadReport,
) -> Result<(House, LoadReport), HousesError> {
    let at = FileLocation::file(name);
    let file: ProcThorHouse = json::from_slice(bytes).map_err(json::syntax(&at))?;
    let openings = file.doors.len() + file.windows.len();
    let lamps = file.procedural_parameters.lights.len();
    let count =
        file.walls.len() + file.rooms.len() + openings + lamps + count_with_children(&file.objects);
    if count > MAX_NODES {
        return Err(HousesError::TooLarge {
            at: at.field("objects"),
            what: "count of rooms, walls, openings, objects and lamps",
            found: count as u64,
            allowed: MAX_NODES as u64,
        });
    }
    if file.rooms.len() > Room::MAX_PER_HOUSE {
        return Err(HousesError::TooLarge {
            at: at.field("rooms"),
            what: "count of rooms",
            found: file.rooms.len() as u64,
            allowed: Room::MAX_PER_HOUSE as u64,
        });
    }
    let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    let mut reader = ProcThorReader {
        at: at.clone(),
        assembly: HouseAssembly::new(stem, "procthor"),
        report: &mut report,
        sizes,
        rooms: Vec::new(),
        ids: BTreeSet::new(),
        floor_y: 0.0,
    };
    reader.assembly.add_storey();
    reader.shell(&file);
    if reader.rooms.is_empty() {
        return Err(HousesError::empty(&at, &report));
    }
    reader.objects(&file.objects);
    reader.lamps(&file.procedural_parameters.lights);
    let mut data = reader.assembly.finish();
    drop_rooms_without_floor(&mut data, &at, &mut report);
    let house = House::new(data).map_err(HousesError::scene(&at))?;
    report_contained_rooms(&house, &at, &mut report);
    Ok((house, report))
}

fn count_with_children(objects: &[ProcThorObject]) -> usize {
    objects
        .iter()
        .map(|object| 1 + count_with_children(&object.children))
        .sum()
}

/// A converted room.
struct ConvertedRoom {
    id: RoomId,
    file_id: String,
    /// Its floor, (x, z) in our axes, m.
    outline: Vec<DVec2>,
    ceiling_y: f32,
}

/// The conversion of a house.
struct ProcThorReader<'a> {
    at: FileLocation,
    assembly: HouseAssembly,
    report: &'a mut LoadReport,
    sizes: &'a AssetSizes,
    rooms: Vec<ConvertedRoom>,
    /// Ids of objects, doors and windows.
    ids: BTreeSet<String>,
    /// Height of the floors, m.
    floor_y: f32,
}

impl ProcThorReader<'_> {
    /// The room whose floor is below a place.
    fn containing_room(&self, place: Vec3) -> Option<&ConvertedRoom> {
        let known = &self.assembly.data.rooms;
        let place = Vec2::new(place.x, place.z);
        self.rooms
            .iter()
            .find(|room| known[room.id].contains_xz(place))
    }

    /// That room, else the one whose middle is nearest.
    fn containing_or_nearest_room(&self, place: Vec3) -> Option<&ConvertedRoom> {
        self.containing_room(place).or_else(|| {
            let place = DVec2::new(f64::from(place.x), f64::from(place.z));
            let distance = |room: &ConvertedRoom| {
                let sum: DVec2 = room.outline.iter().sum();
                (sum / room.outline.len() as f64).distance_squared(place)
            };
            self.rooms
                .iter()
                .min_by(|a, b| distance(a).total_cmp(&distance(b)))
        })
    }

    fn warn(&mut self, field: &str, damage: WarningKind) {
        self.report.warn(self.at.field(field), damage);
    }

    fn bad_field(&mut self, field: &str, found: String, expected: &str) {
        let expected = expected.to_owned();
        self.warn(field, WarningKind::BadField { found, expected });
    }
}

/// Converts a point of the file to our axes: +Z is backwards here, forwards there.
fn point(p: Vector3) -> Vec3 {
    Vec3::new(p.x, p.y, -p.z)
}

/// Euler angles of the file (about Z, then X, then Y, in left-handed axes) as a rotation in ours.
fn rotation(degrees: Vector3) -> Quat {
    let turn =
        |axis: Vec3, angle: f32| dwell_furniture::shapes::axis_rotation(axis, angle.to_radians());
    // Seen in a mirror across z = 0, turns about X and Y run the other way.
    turn(Vec3::Y, -degrees.y) * turn(Vec3::X, -degrees.x) * turn(Vec3::Z, degrees.z)
}

/// Returns whether numbers are a possible position in a house.
fn is_valid_position(p: Vec3) -> bool {
    p.is_finite() && Aabb::new(Vec3::splat(-1e4), Vec3::splat(1e4)).contains(p)
}
