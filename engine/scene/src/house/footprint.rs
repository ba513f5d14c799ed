//! Boxes around rooms' floors, so that a point is tested against few of them.

use super::data::Room;
use crate::bounds::Aabb;
use crate::bvh::BoxTree;
use crate::ids::{Id, IdVec, RoomId};
use glam::{Vec2, Vec3};

/// Height below the floor and above the ceiling at which a point still is in the room, m.
pub(super) const STRAY_M: f32 = 0.3;

/// Rounding tolerance by which [`Room::contains_xz`] may accept a point beyond a corner: m, and a share of the coordinates.
const MARGIN_M: f32 = 1e-3;
const MARGIN: f32 = 1e-6;

/// The rooms of a house by where their floors lie.
#[derive(Debug)]
pub(super) struct RoomIndex {
    /// One box a room: around its footprint, between floor and ceiling with [`STRAY_M`] beyond both.
    boxes: BoxTree,
    /// The area of each footprint, m².
    pub(super) area_m2: IdVec<RoomId, f32>,
}

impl RoomIndex {
    pub(super) fn new(rooms: &IdVec<RoomId, Room>) -> Self {
        Self {
            boxes: BoxTree::new(rooms.iter().map(reach).collect()),
            area_m2: rooms.iter().map(Room::area_m2).collect(),
        }
    }

    /// Calls `visit` with each room whose floor may lie below `point`, in no particular order.
    pub(super) fn for_each_near(&self, point: Vec3, mut visit: impl FnMut(RoomId)) {
        self.boxes
            .for_each_at(point, |k| visit(RoomId::from_index(k)));
    }
}

/// The box in which points of a room lie.
fn reach(room: &Room) -> Aabb {
    let corners = room.footprint.iter().flatten();
    let (low, high) = corners.fold((Vec2::INFINITY, Vec2::NEG_INFINITY), |(low, high), c| {
        (low.min(*c), high.max(*c))
    });
    let margin = |corner: Vec2| Vec2::splat(MARGIN_M) + corner.abs() * MARGIN;
    let (low, high) = (low - margin(low), high + margin(high));
    Aabb {
        min: Vec3::new(low.x, room.floor_y - STRAY_M, low.y),
        max: Vec3::new(high.x, room.ceiling_y + STRAY_M, high.y),
    }
}
