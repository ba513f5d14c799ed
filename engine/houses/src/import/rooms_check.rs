//! Rooms that a file states and that have no floor of their own.

use dwell_scene::{House, HouseData, Id, RoomId};
use glam::Vec3;

use crate::report::{FileLocation, LoadReport};
use crate::warning_kind::WarningKind;

/// Points by which a room is looked for among others.
const POINTS: usize = 16;

/// Leaves out rooms without a floor, each told of. What was in them is in no room.
pub(crate) fn drop_rooms_without_floor(
    data: &mut HouseData,
    at: &FileLocation,
    report: &mut LoadReport,
) {
    if data.rooms.iter().all(|room| !room.footprint.is_empty()) {
        return;
    }
    let mut new_of_old: Vec<Option<RoomId>> = Vec::new();
    for room in &std::mem::take(&mut data.rooms) {
        new_of_old.push(if room.footprint.is_empty() {
            let what = format!(
                "room {:?} has a floor without area; it is no room of the house",
                room.name
            );
            report.warn(at.clone(), WarningKind::Simplified { what });
            None
        } else {
            Some(data.rooms.push(room.clone()))
        });
    }
    let new = |old: Option<RoomId>| old.and_then(|id| new_of_old.get(id.index()).copied()?);
    let pieces = data.structure.iter_mut().map(|piece| &mut piece.room);
    let objects = data.objects.iter_mut().map(|object| &mut object.room);
    for room in pieces.chain(objects) {
        *room = new(*room);
    }
}

/// Tells of rooms whose whole floor lies in another room, which is where all that stands on it is.
pub(crate) fn report_contained_rooms(house: &House, at: &FileLocation, report: &mut LoadReport) {
    for (id, room) in house.rooms.iter_ids() {
        if !house.points_in_room(id, POINTS).is_empty() || house.exclusive_area_m2(id) > 0.0 {
            continue;
        }
        let over = room.footprint.iter().find_map(|[a, b, c]| {
            let middle = (*a + *b + *c) / 3.0;
            let y = room.floor_y.midpoint(room.ceiling_y);
            house.room_at(Vec3::new(middle.x, y, middle.y))
        });
        let over = over.filter(|over| *over != id);
        let name = over.map_or("others", |over| house.rooms[over].name.as_str());
        let what = format!(
            "the floor of room {:?} lies in room {name:?} as a whole; what stands there is in {name:?}, and {:?} has 0 m2",
            room.name, room.name
        );
        report.warn(at.clone(), WarningKind::Simplified { what });
    }
}
