//! Candidate cells of goals: those of a grid's largest island, by place and by room.

use dwell_scene::interrupt::CancelPoller;
use dwell_scene::navigation::{NavCell, NavGrid};
use dwell_scene::{Aabb, House, RoomId};
use glam::Vec3;
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// Edge of the squares by which cells are found, m.
const SQUARE_M: f32 = 1.0;
/// Cells between checks for cancellation.
const CELLS_PER_CHECK: usize = 256;

/// The cells of the largest island, collected once for all goals.
pub(super) struct LargestIslandIndex<'a> {
    pub(super) grid: &'a NavGrid,
    /// Rising.
    cells: Vec<NavCell>,
    /// By squares along x and z.
    squares: BTreeMap<[i32; 2], Vec<NavCell>>,
    /// The rooms on the four sides of each cell, as soon as a room is a goal. Shape (cell,).
    sides: OnceLock<Vec<[Option<RoomId>; 4]>>,
}

fn cell_block_of(value: f32) -> i32 {
    (value / SQUARE_M).floor() as i32
}

impl<'a> LargestIslandIndex<'a> {
    pub(super) fn of(grid: &'a NavGrid) -> Self {
        let on_island = |cell: &NavCell| grid.island(*cell) == Some(0);
        let cells: Vec<NavCell> = grid.walkable().filter(on_island).collect();
        let mut squares: BTreeMap<[i32; 2], Vec<NavCell>> = BTreeMap::new();
        for cell in &cells {
            let at = grid.position(*cell);
            let square = squares.entry([cell_block_of(at.x), cell_block_of(at.z)]);
            square.or_default().push(*cell);
        }
        Self {
            grid,
            cells,
            squares,
            sides: OnceLock::new(),
        }
    }

    /// The cells over or under a box, and some around it.
    pub(super) fn cells_around(&self, bounds: &Aabb) -> Vec<NavCell> {
        let (low, high) = (bounds.min, bounds.max);
        let rows = cell_block_of(low.x)..=cell_block_of(high.x);
        let mut found = Vec::new();
        for x in rows {
            let row = [x, cell_block_of(low.z)]..=[x, cell_block_of(high.z)];
            found.extend(self.squares.range(row).flat_map(|(_, cells)| cells));
        }
        found
    }

    /// The cells that have one of some rooms all around, so that an agent that stops anywhere on them counts; rising.
    pub(super) fn cells_in_rooms(&self, house: &House, rooms: &[RoomId]) -> Vec<NavCell> {
        let mut pace = CancelPoller::new(CELLS_PER_CHECK);
        let sides = self.sides.get_or_init(|| {
            let edge = self.grid.config().cell_m;
            let sides = [(-edge, 0.0), (edge, 0.0), (0.0, -edge), (0.0, edge)];
            let of = |cell: &NavCell| {
                pace.count_one();
                let at = self.grid.position(*cell);
                sides.map(|(dx, dz)| house.room_at(at + Vec3::new(dx, 0.1, dz)))
            };
            self.cells.iter().map(of).collect()
        });
        let inside = |room: &Option<RoomId>| room.is_some_and(|room| rooms.contains(&room));
        let cells = self.cells.iter().zip(sides);
        let found = cells.filter(|(_, sides)| sides.iter().all(inside));
        found.map(|(cell, _)| *cell).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::State;
    use dwell_scene::navigation::NavConfig;

    /// Squares and sides give the same cells as a scan of all cells.
    #[test]
    fn goals_are_found_without_looking_at_all_cells() {
        let house = dwell_houses::builtin::build("studio").unwrap();
        let state = State::new(&house);
        let grid = NavGrid::build(&house, &state, &NavConfig::default()).unwrap();
        let ground = LargestIslandIndex::of(&grid);
        let all = || grid.walkable().filter(|cell| grid.island(*cell) == Some(0));
        let mut asked = 0;
        for object in house.objects.ids() {
            let bounds = house.object_bounds(&state, object).grown(1.2);
            let over = |cell: &NavCell| bounds.contains(grid.position(*cell).with_y(bounds.min.y));
            let found = ground.cells_around(&bounds);
            asked += found.len();
            let mut over_it: Vec<NavCell> = found.into_iter().filter(over).collect();
            over_it.sort_unstable();
            assert_eq!(over_it, all().filter(over).collect::<Vec<NavCell>>());
        }
        assert!(asked > 0 && asked < house.objects.len() * all().count());
        let edge = grid.config().cell_m;
        for room in house.rooms.ids() {
            let within = |cell: &NavCell| {
                let sides = [(-edge, 0.0), (edge, 0.0), (0.0, -edge), (0.0, edge)];
                sides.into_iter().all(|(dx, dz)| {
                    let at = grid.position(*cell) + Vec3::new(dx, 0.1, dz);
                    house.room_at(at) == Some(room)
                })
            };
            let expected: Vec<NavCell> = all().filter(within).collect();
            assert_eq!(ground.cells_in_rooms(&house, &[room]), expected);
        }
        assert!(ground.cells_in_rooms(&house, &[]).is_empty());
        assert!(ground.cells_around(&Aabb::EMPTY).is_empty());
    }
}
