//! Bounding rectangles of rooms' floors, so that a point is tested against few floors.

use super::data::Room;
use glam::Vec2;

/// Rounding tolerance by which [`Room::contains_xz`] may accept a point beyond a corner: m, and a share of the coordinates.
const MARGIN_M: f32 = 1e-3;
const MARGIN: f32 = 1e-6;

/// The bounding rectangle of a room's footprint, and the footprint's area.
#[derive(Debug, Clone, Copy)]
pub(super) struct FootprintBounds {
    low: Vec2,
    high: Vec2,
    /// m².
    pub(super) area_m2: f32,
}

impl FootprintBounds {
    pub(super) fn of(room: &Room) -> Self {
        let corners = room.footprint.iter().flatten();
        let (low, high) = corners.fold((Vec2::INFINITY, Vec2::NEG_INFINITY), |(low, high), c| {
            (low.min(*c), high.max(*c))
        });
        let margin = |corner: Vec2| Vec2::splat(MARGIN_M) + corner.abs() * MARGIN;
        Self {
            low: low - margin(low),
            high: high + margin(high),
            area_m2: room.area_m2(),
        }
    }

    /// Returns whether the point (x, z) may lie over the floor.
    pub(super) fn may_contain_xz(&self, point: Vec2) -> bool {
        point.cmpge(self.low).all() && point.cmple(self.high).all()
    }
}
