//! Reachability of every room, from what the generator knows: floors, open leaves and the boxes around
//! collision pieces below head height. A house need not be built for it, and it takes a tenth of what a
//! [`NavGrid`](dwell_scene::navigation::NavGrid) takes.
//!
//! Stricter than a `NavGrid` of cells of 10 cm for a walker of 0.2 m radius: where a square of half of 0.3 m passes, such a
//! grid has a cell free of what the square is free of. So a room that counts as reached here is reached there; tests hold it.

use super::furnish::{RoomFurniture, is_walking_obstacle, zone_of_box};
use super::openings::{HoleContents, WallHole, ZoneXz};
use super::plan::{GeneratedPlan, GeneratedStorey, StairwellPlan, StoreyCells, metres};
use super::rooms::GeneratedRoomKind;
use super::shell::free_floor;

/// Edge of a cell, m.
const CELL_M: f32 = 0.05;
/// Number of cells around one that must be free, too. With half of the cell itself 0.325 m, which leaves 0.3 m where a wall's face
/// lies within a cell.
const CLEAR: usize = 6;
/// Width of the frames on both sides of doorways, m.
const FRAME_M: f32 = 0.06;
/// Depth by which sills of windows stand out, m.
const SILL_M: f32 = 0.04;
/// Distance from the first step of stairs to the place before it, m.
const BEFORE_STAIRS_M: f32 = 0.45;
/// No room's floor.
const WALL: u16 = u16::MAX;
/// The floor of a doorway.
const DOORWAY: u16 = u16::MAX - 1;

/// A room of a plan: its storey and its place there.
pub(super) type RoomIndex = (usize, usize);

/// The rooms that a walker that opens doors cannot reach: those of which less than half of the walkable floor is connected
/// with the largest walkable floor of the storey. A storey from which one cannot get to the stairs has lost its hallway.
pub(super) fn unreachable_rooms(
    plan: &GeneratedPlan,
    holes: &[Vec<WallHole>],
    furnished: &[Vec<RoomFurniture>],
) -> Vec<RoomIndex> {
    let mut all = Vec::new();
    for (level, storey) in plan.storeys.iter().enumerate() {
        let mut map = OccupancyMap::new(storey, &holes[level], plan.stairs);
        for room in &furnished[level] {
            let boxes = room.pieces.iter().flat_map(|piece| &piece.boxes);
            for bounds in boxes.filter(|bounds| is_walking_obstacle(bounds)) {
                map.block(&zone_of_box(bounds));
            }
            // Someone may have opened a wardrobe.
            for piece in &room.pieces {
                let place = piece.pose.to_affine();
                for leaf in &piece.model.open_leaves {
                    map.block(&zone_of_box(&leaf.transformed(&place)));
                }
            }
        }
        let walk = map.mark_largest_region();
        let reached = map.reached_on(&walk, storey.rooms.len());
        let cut_off = plan.stairs.is_some_and(|stairs| {
            let ways = stair_access_points(&stairs, level, plan.storeys.len());
            ways.iter().any(|at| !map.is_near(*at, &walk))
        });
        for (room, reached) in reached.into_iter().enumerate() {
            let hallway = cut_off && storey.rooms[room].kind == GeneratedRoomKind::Hallway;
            if hallway || !reached {
                all.push((level, room));
            }
        }
    }
    all
}

/// Returns the number of rooms of a storey that are unreachable while they are empty.
pub(super) fn count_unreachable_when_empty(
    storey: &GeneratedStorey,
    holes: &[WallHole],
    stairs: Option<StairwellPlan>,
) -> usize {
    let reached = OccupancyMap::new(storey, holes, stairs).reached_rooms(storey.rooms.len());
    reached.into_iter().filter(|reached| !reached).count()
}

/// Returns the places before the flights that start or end on a storey.
fn stair_access_points(stairs: &StairwellPlan, level: usize, storeys: usize) -> Vec<[f32; 2]> {
    let [x0, z0, x1, z1] = stairs.area.map(metres);
    let size = [x1 - x0, z1 - z0];
    let along = |k: usize| stairs.climb[k] as f32;
    let place = |side: f32| {
        [0, 1].map(|k| {
            let middle = [0.5 * (x0 + x1), 0.5 * (z0 + z1)][k];
            let before = 0.5 * size[k] + BEFORE_STAIRS_M;
            middle - along(k) * before + side * 0.25 * size[k] * stairs.across[k] as f32
        })
    };
    let mut ways = Vec::new();
    if level + 1 < storeys {
        ways.push(place(-1.0));
    }
    if level > 0 {
        ways.push(place(1.0));
    }
    ways
}

/// The reachability of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum CellWalkability {
    No,
    Yes,
    /// On the largest walkable floor.
    Reached,
}

/// The floor of a storey in cells, row by row along z.
struct OccupancyMap {
    corner: [f32; 2],
    columns: usize,
    rows: usize,
    /// The room of each cell, [`WALL`] or [`DOORWAY`].
    room: Vec<u16>,
    blocked: Vec<bool>,
}

impl OccupancyMap {
    /// The bare storey with its doors wide open.
    fn new(storey: &GeneratedStorey, holes: &[WallHole], stairs: Option<StairwellPlan>) -> Self {
        let areas = || storey.rooms.iter().flat_map(|room| &room.areas);
        let edge = |k: usize, pick: fn(i32, i32) -> i32| {
            areas().map(|area| area[k]).reduce(pick).unwrap_or(0)
        };
        // One cell more on every side, which is never free.
        let corner = [0, 1].map(|k| metres(edge(k, i32::min)) - CELL_M);
        let count = |k: usize| {
            let far = metres(edge(k + 2, i32::max)) - corner[k];
            (far / CELL_M).ceil().max(0.0) as usize + 1
        };
        let (columns, rows) = (count(0), count(1));
        let mut map = Self {
            corner,
            columns,
            rows,
            room: vec![WALL; columns * rows],
            blocked: vec![false; columns * rows],
        };
        let cells = StoreyCells::new(&storey.rooms);
        for room in 0..storey.rooms.len() {
            for zone in free_floor(storey, &cells, room) {
                map.for_each_cell_in(&zone, |map, cell| map.room[cell] = room as u16);
            }
        }
        for hole in holes {
            let half = 0.5 * hole.wall_m(storey);
            if matches!(hole.contents, HoleContents::Window { .. }) {
                map.block(&hole.zone_in_front(1.0, half + SILL_M, 0.0));
                continue;
            }
            let frame = if hole.contents == HoleContents::Open {
                0.0
            } else {
                -FRAME_M
            };
            for side in [1.0, -1.0] {
                // A little farther than the wall's face, so that no cell's middle is left out between.
                let zone = hole.zone_in_front(side, half + 0.5 * CELL_M, frame);
                map.for_each_cell_in(&zone, |map, cell| {
                    if map.room[cell] == WALL {
                        map.room[cell] = DOORWAY;
                    }
                });
            }
            if let Some(leaf) = hole.open_leaf_zone() {
                map.block(&leaf);
            }
        }
        if let Some(stairs) = stairs {
            map.block(&stairs.area.map(metres));
        }
        map
    }

    fn range(&self, low: f32, high: f32, axis: usize) -> std::ops::Range<usize> {
        let limit = [self.columns, self.rows][axis];
        let from = low.max(0.0) as usize;
        let to = (high.max(0.0) as usize).min(limit);
        from.min(to)..to
    }

    /// Calls `each` for the cells whose centre lies in a zone.
    fn for_each_cell_in(&mut self, zone: &ZoneXz, mut each: impl FnMut(&mut Self, usize)) {
        let at = |value: f32, axis: usize| (value - self.corner[axis]) / CELL_M + 0.5;
        let columns = self.range(at(zone[0], 0), at(zone[2], 0), 0);
        let rows = self.range(at(zone[1], 1), at(zone[3], 1), 1);
        for row in rows {
            for column in columns.clone() {
                each(self, row * self.columns + column);
            }
        }
    }

    /// Blocks all cells that a zone touches.
    fn block(&mut self, zone: &ZoneXz) {
        let at = |value: f32, axis: usize| (value - self.corner[axis]) / CELL_M;
        let columns = self.range(at(zone[0], 0), at(zone[2], 0).ceil(), 0);
        let rows = self.range(at(zone[1], 1), at(zone[3], 1).ceil(), 1);
        for row in rows {
            let first = row * self.columns;
            self.blocked[first + columns.start..first + columns.end].fill(true);
        }
    }

    /// Returns the walkable cells: those with all cells around them floor and free.
    fn walkable(&self) -> Vec<bool> {
        // Number of free cells in a row (then in a column) up to here without a break.
        let free = |cell: usize| self.room[cell] != WALL && !self.blocked[cell];
        let wide = 2 * CLEAR + 1;
        let mut across = vec![false; self.room.len()];
        for row in 0..self.rows {
            let mut run = 0;
            for column in 0..self.columns {
                let cell = row * self.columns + column;
                run = if free(cell) { run + 1 } else { 0 };
                if run >= wide {
                    across[cell - CLEAR] = true;
                }
            }
        }
        let mut walkable = vec![false; self.room.len()];
        let mut runs = vec![0_usize; self.columns];
        for row in 0..self.rows {
            for (column, run) in runs.iter_mut().enumerate() {
                let cell = row * self.columns + column;
                *run = if across[cell] { *run + 1 } else { 0 };
                if *run >= wide {
                    walkable[cell - CLEAR * self.columns] = true;
                }
            }
        }
        walkable
    }

    /// The walkable cells, those of the largest connected floor marked.
    fn mark_largest_region(&self) -> Vec<CellWalkability> {
        let walkable = self.walkable();
        let mut walk: Vec<CellWalkability> = walkable
            .iter()
            .map(|yes| {
                if *yes {
                    CellWalkability::Yes
                } else {
                    CellWalkability::No
                }
            })
            .collect();
        let mut left = walkable;
        let mut best: Vec<usize> = Vec::new();
        for start in 0..left.len() {
            if !left[start] {
                continue;
            }
            left[start] = false;
            let mut island = vec![start];
            let mut next = 0;
            while let Some(&cell) = island.get(next) {
                next += 1;
                // The cells of the border are never walkable.
                for there in [cell - 1, cell + 1, cell - self.columns, cell + self.columns] {
                    if left[there] {
                        left[there] = false;
                        island.push(there);
                    }
                }
            }
            if island.len() > best.len() {
                best = island;
            }
        }
        for cell in best {
            walk[cell] = CellWalkability::Reached;
        }
        walk
    }

    /// For each room whether it is reached: no less than half of its walkable floor.
    fn reached_rooms(&self, rooms: usize) -> Vec<bool> {
        self.reached_on(&self.mark_largest_region(), rooms)
    }

    fn reached_on(&self, walk: &[CellWalkability], rooms: usize) -> Vec<bool> {
        let mut counts = vec![[0_usize; 2]; rooms];
        for (room, walk) in self.room.iter().zip(walk) {
            if let Some(count) = counts.get_mut(usize::from(*room)) {
                count[0] += usize::from(*walk != CellWalkability::No);
                count[1] += usize::from(*walk == CellWalkability::Reached);
            }
        }
        let is_reached = |[walkable, reached]: [usize; 2]| reached > 0 && reached * 2 >= walkable;
        counts.into_iter().map(is_reached).collect()
    }

    /// Returns whether a reached cell lies within a step of a place.
    fn is_near(&self, [x, z]: [f32; 2], walk: &[CellWalkability]) -> bool {
        let near_m = 0.25;
        let at = |value: f32, axis: usize| (value - self.corner[axis]) / CELL_M;
        let columns = self.range(at(x - near_m, 0), at(x + near_m, 0), 0);
        let rows = self.range(at(z - near_m, 1), at(z + near_m, 1), 1);
        rows.into_iter().any(|row| {
            let first = row * self.columns;
            let cells = &walk[first + columns.start..first + columns.end];
            cells.contains(&CellWalkability::Reached)
        })
    }
}
