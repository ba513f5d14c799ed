//! The room around a point, by table.

use dwell_scene::{House, Id, RoomId, Structure, StructureKind};
use glam::{Vec2, Vec3};

/// Edge of a cell, m; larger for houses that would need more than [`MOST_CELLS`].
const CELL_M: f32 = 0.1;
/// Largest number of cells a storey.
const MOST_CELLS: f32 = 1e6;
/// Largest number of cells along an edge.
const MOST_CELLS_ALONG: f32 = 16_384.0;
/// Reach of rooms beyond their floor, in cells: into the walls around them.
const REACH: usize = 2;
/// A cell outside.
const OUTSIDE: u16 = u16::MAX;

/// The rooms of one storey from above.
#[derive(Debug)]
pub(super) struct StoreyGrid {
    /// Heights between which the storey lies, m.
    pub(super) low_y: f32,
    pub(super) high_y: f32,
    /// Shape (cells along z, cells along x).
    pub(super) cells: Vec<u16>,
}

/// All storeys.
#[derive(Debug)]
pub(crate) struct RoomGrid {
    pub(super) storeys: Vec<StoreyGrid>,
    /// The corner of the first cell, (x, z), m.
    pub(super) corner: Vec2,
    pub(super) cells_per_m: f32,
    pub(super) width: usize,
    pub(super) depth: usize,
}

impl RoomGrid {
    pub(crate) fn new(house: &House) -> Self {
        let points = || {
            house
                .rooms
                .iter()
                .flat_map(|room| room.footprint.iter().flatten().copied())
        };
        let low = points().fold(Vec2::MAX, Vec2::min) - 1.0;
        let high = points().fold(Vec2::MIN, Vec2::max) + 1.0;
        let span = high - low;
        if !(span.is_finite() && span.min_element() > 0.0) {
            return Self {
                storeys: Vec::new(),
                corner: Vec2::ZERO,
                cells_per_m: 1.0,
                width: 0,
                depth: 0,
            };
        }
        let cell = (span.x * span.y / MOST_CELLS).sqrt().max(CELL_M);
        // A street of houses is long and narrow.
        let cell = cell.max(span.max_element() / MOST_CELLS_ALONG);
        let (width, depth) = ((span.x / cell) as usize + 1, (span.y / cell) as usize + 1);
        let mut grid = Self {
            storeys: Vec::new(),
            corner: low,
            cells_per_m: 1.0 / cell,
            width,
            depth,
        };
        for level in house.levels.ids() {
            // Where rooms overlap the smaller one counts: it is drawn last.
            let mut rooms: Vec<RoomId> = house
                .rooms
                .ids()
                .filter(|id| house.rooms[*id].level == level)
                .collect();
            rooms.retain(|id| id.index() < usize::from(OUTSIDE) && is_roofed(house, *id));
            rooms.sort_by(|a, b| {
                house.rooms[*b]
                    .area_m2()
                    .total_cmp(&house.rooms[*a].area_m2())
            });
            let heights = rooms
                .iter()
                .map(|id| (house.rooms[*id].floor_y, house.rooms[*id].ceiling_y));
            let (low_y, high_y) = heights.fold(
                (f32::INFINITY, f32::NEG_INFINITY),
                |(low, high), (floor, ceiling)| (low.min(floor), high.max(ceiling)),
            );
            if rooms.is_empty() {
                continue;
            }
            let mut cells = vec![OUTSIDE; width * depth];
            for id in rooms {
                grid.mark_room(&mut cells, house, id);
            }
            for _ in 0..REACH {
                grid.extend_into_walls(&mut cells);
            }
            grid.storeys.push(StoreyGrid {
                low_y: low_y - 0.3,
                high_y: high_y + 0.3,
                cells,
            });
        }
        grid
    }

    /// Marks the cells whose middle lies over a room's floor.
    fn mark_room(&self, cells: &mut [u16], house: &House, id: RoomId) {
        let room = &house.rooms[id];
        let clamp = |p: Vec2| (p - self.corner) * self.cells_per_m;
        let (low, high) = room
            .footprint
            .iter()
            .flatten()
            .fold((Vec2::MAX, Vec2::MIN), |(low, high), p| {
                (low.min(clamp(*p)), high.max(clamp(*p)))
            });
        for z in low.y.max(0.0) as usize..self.depth.min(high.y.max(0.0) as usize + 1) {
            for x in low.x.max(0.0) as usize..self.width.min(high.x.max(0.0) as usize + 1) {
                let middle =
                    self.corner + Vec2::new(x as f32 + 0.5, z as f32 + 0.5) / self.cells_per_m;
                if room.contains_xz(middle) {
                    cells[z * self.width + x] = id.0 as u16;
                }
            }
        }
    }

    /// Assigns cells outside to a room beside them.
    fn extend_into_walls(&self, cells: &mut [u16]) {
        let before = cells.to_vec();
        let at = |x: usize, z: usize| before[z * self.width + x];
        for z in 1..self.depth.saturating_sub(1) {
            for x in 1..self.width.saturating_sub(1) {
                if at(x, z) == OUTSIDE {
                    let beside = [at(x - 1, z), at(x + 1, z), at(x, z - 1), at(x, z + 1)];
                    cells[z * self.width + x] = beside.into_iter().min().unwrap_or(OUTSIDE);
                }
            }
        }
    }

    /// The position of the room that holds `point`, walls around it included to half their thickness.
    #[inline]
    pub(crate) fn room_at(&self, point: Vec3) -> Option<usize> {
        let place = (Vec2::new(point.x, point.z) - self.corner) * self.cells_per_m;
        if !(place.x >= 0.0 && place.y >= 0.0) {
            return None;
        }
        let (x, z) = (place.x as usize, place.y as usize);
        if x >= self.width || z >= self.depth {
            return None;
        }
        // The upper storey where two meet.
        let storeys = self
            .storeys
            .iter()
            .rev()
            .filter(|storey| point.y >= storey.low_y && point.y <= storey.high_y);
        let mut rooms = storeys
            .map(|storey| storey.cells[z * self.width + x])
            .filter(|room| *room != OUTSIDE);
        rooms.next().map(usize::from)
    }
}

/// Returns whether a room is one to light: balconies and terraces lie in the open where there is a sky.
fn is_roofed(house: &House, id: RoomId) -> bool {
    let is_ceiling =
        |piece: &Structure| piece.kind == StructureKind::Ceiling && piece.room == Some(id);
    house.sky.is_none() || house.structure.iter().any(is_ceiling)
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::ShoeboxMaterials;

    #[test]
    fn a_point_is_in_its_room_or_its_walls_or_outside() {
        let house = House::shoebox([4.0, 3.0, 5.0], &ShoeboxMaterials::default()).unwrap();
        let grid = RoomGrid::new(&house);
        for inside in [
            Vec3::new(0.1, 1.0, 0.1),
            Vec3::new(3.9, 2.9, 4.9),
            Vec3::new(-0.05, 1.0, 2.0),
        ] {
            assert_eq!(grid.room_at(inside), Some(0), "{inside}");
        }
        let nowhere = Vec3::new(f32::NAN, 1.0, 1.0);
        for outside in [
            Vec3::new(-0.5, 1.0, 2.0),
            Vec3::new(2.0, 4.0, 2.0),
            Vec3::new(1e30, 1.0, 0.0),
            nowhere,
        ] {
            assert_eq!(grid.room_at(outside), None, "{outside}");
        }
    }

    #[test]
    fn a_house_without_rooms_is_all_outside() {
        let house = House::new(dwell_scene::HouseData::default()).unwrap();
        assert_eq!(RoomGrid::new(&house).room_at(Vec3::ZERO), None);
    }
}
