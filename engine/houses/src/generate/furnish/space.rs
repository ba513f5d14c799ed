//! A room while it is furnished: its contents, the floor that must stay free, and its walkability.
//!
//! World x and z, heights above the room's floor. All tests are on boxes around collision pieces, so that accepted places are free
//! of overlap for sure.

use crate::generate::openings::{HoleContents, WallHole, ZoneXz, overlap};
use crate::generate::plan::{GeneratedStorey, StoreyCells, metres};
use crate::generate::shell::{floor_contains_zone, free_floor, half_wall_thickness_m};
use dwell_furniture::model_cache::CachedModel;
use dwell_scene::{Aabb, Pose};
use glam::Vec3;
use std::sync::Arc;

/// Overlap that is ignored, m.
const TOUCH_M: f32 = 0.0005;
/// Height below which obstacles are stepped over, m.
const STEP_M: f32 = 0.05;
/// Height from which on obstacles are walked under, m.
const HEAD_M: f32 = 1.9;
/// Edge of a cell of the walkable grid, m.
const CELL_M: f32 = 0.1;
/// Depth of the floor that stays free before doors, m.
const DOOR_FRONT_M: f32 = 0.7;

/// A straight stretch of wall as seen from its room.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WallSpan {
    /// True if it runs along x.
    pub(crate) along_x: bool,
    /// Coordinate of its face across the wall, m.
    pub(crate) face_m: f32,
    pub(crate) from_m: f32,
    pub(crate) to_m: f32,
    /// +1 when the room lies at larger coordinates across it, else -1.
    pub(crate) inward_sign: f32,
}

impl WallSpan {
    /// The yaw of a thing with its back to it, degrees.
    pub(crate) fn yaw_deg(&self) -> f32 {
        match (self.along_x, self.inward_sign > 0.0) {
            (true, true) => 0.0,
            (true, false) => 180.0,
            (false, true) => 90.0,
            (false, false) => -90.0,
        }
    }

    /// The point `along_m` along it and `off_m` before it.
    pub(crate) fn point(&self, along_m: f32, off_m: f32) -> Vec3 {
        let across = self.face_m + self.inward_sign * off_m;
        if self.along_x {
            Vec3::new(along_m, 0.0, across)
        } else {
            Vec3::new(across, 0.0, along_m)
        }
    }
}

/// Something that stands in the room.
#[derive(Clone, Debug)]
pub(crate) struct PlacedFurniture {
    pub(crate) model: Arc<CachedModel>,
    pub(crate) pose: Pose,
    pub(crate) boxes: Vec<Aabb>,
    pub(crate) bounds: Aabb,
    pub(crate) swept_boxes: Vec<Aabb>,
    /// The box around all swings.
    pub(crate) swept_bounds: Aabb,
    /// Floor that must stay free for its use.
    pub(crate) clearance_zones: Vec<ZoneXz>,
    /// The piece that it belongs to; the two may share free floor.
    pub(crate) anchor: Option<usize>,
    /// True if it hangs or stands before a window.
    at_window: bool,
}

impl PlacedFurniture {
    /// A thing at a pose; `pose` maps the model to the room.
    pub(crate) fn new(stock: &Arc<CachedModel>, pose: Pose) -> Self {
        let place = pose.to_affine();
        let moved = |boxes: &[Aabb]| {
            boxes
                .iter()
                .map(|b| b.transformed(&place))
                .collect::<Vec<_>>()
        };
        let around = |boxes: &[Aabb]| boxes.iter().fold(Aabb::EMPTY, |all, one| all.union(one));
        let boxes = moved(&stock.boxes);
        let swept_boxes = moved(&stock.swept_boxes);
        Self {
            bounds: around(&boxes),
            swept_bounds: around(&swept_boxes),
            boxes,
            swept_boxes,
            model: stock.clone(),
            pose,
            clearance_zones: Vec::new(),
            anchor: None,
            at_window: false,
        }
    }

    /// The same thing, which needs `front_m` of free floor before it.
    pub(crate) fn with_front_clearance(mut self, front_m: f32) -> Self {
        if front_m > 0.0 {
            let collider_bounds = self.model.collider_bounds;
            let (min, max) = (collider_bounds.min, collider_bounds.max);
            let front = Aabb::new(
                Vec3::new(min.x, 0.0, max.z),
                Vec3::new(max.x, 0.1, max.z + front_m),
            );
            self.clearance_zones
                .push(zone_of_box(&front.transformed(&self.pose.to_affine())));
        }
        self
    }

    /// The same thing, made for a window.
    pub(crate) fn for_window(mut self) -> Self {
        self.at_window = true;
        self
    }

    /// The same thing as a part of another.
    pub(crate) fn anchored_to(mut self, anchor: usize) -> Self {
        self.anchor = Some(anchor);
        self
    }
}

/// The floor under a box.
pub(crate) fn zone_of_box(bounds: &Aabb) -> ZoneXz {
    [bounds.min.x, bounds.min.z, bounds.max.x, bounds.max.z]
}

fn meets(a: &Aabb, b: &Aabb) -> bool {
    a.min.cmplt(b.max - TOUCH_M).all() && b.min.cmplt(a.max - TOUCH_M).all()
}

pub(crate) fn is_walking_obstacle(bounds: &Aabb) -> bool {
    bounds.max.y > STEP_M && bounds.min.y < HEAD_M
}

/// A room while it is furnished.
#[derive(Clone, Debug)]
pub(crate) struct RoomLayout {
    pub(crate) floor: Vec<ZoneXz>,
    pub(crate) wall_spans: Vec<WallSpan>,
    /// The holes of its walls; those of doors into it or out of it, too.
    pub(crate) holes: Vec<WallHole>,
    pub(crate) pieces: Vec<PlacedFurniture>,
    /// Windows and doors as boxes before their walls: nothing hangs or stands there.
    openings: Vec<Aabb>,
    /// Floor that must stay free for doors.
    keep: Vec<ZoneXz>,
    /// The stairs.
    void: Option<ZoneXz>,
    grid: ClearanceGrid,
}

/// The walkable floor of a room.
#[derive(Clone, Debug, Default)]
struct ClearanceGrid {
    corner: [f32; 2],
    columns: usize,
    rows: usize,
    free: Vec<bool>,
    /// Half of the width that must stay free, m.
    radius_m: f32,
    /// Cells before the doors.
    doors: Vec<usize>,
    /// True if some door has no such cell.
    shut: bool,
}

impl RoomLayout {
    /// An empty room; paths stay `2 * radius_m` wide where they start so.
    pub(crate) fn new(
        storey: &GeneratedStorey,
        cells: &StoreyCells,
        room: usize,
        holes: &[WallHole],
        void: Option<ZoneXz>,
        radius_m: f32,
    ) -> Self {
        let mut floor = free_floor(storey, cells, room);
        floor.retain(|zone| void.is_none_or(|void| !overlap(&void, zone)));
        let own: Vec<WallHole> = holes
            .iter()
            .copied()
            .filter(|hole| hole.room == room || hole.other_room == Some(room))
            .collect();
        let mut space = Self {
            floor,
            wall_spans: spans(storey, cells, room),
            holes: Vec::new(),
            pieces: Vec::new(),
            openings: Vec::new(),
            keep: Vec::new(),
            void: None,
            grid: ClearanceGrid::default(),
        };
        for hole in &own {
            let side = if hole.room == room { 1.0 } else { -1.0 };
            let wall = 0.5 * hole.wall_m(storey);
            if matches!(hole.contents, HoleContents::Window { .. }) {
                let [x0, z0, x1, z1] = hole.zone_in_front(side, wall + 0.06, 0.0);
                space.openings.push(Aabb::new(
                    Vec3::new(x0, hole.low_m - 0.03, z0),
                    Vec3::new(x1, hole.high_m, z1),
                ));
                continue;
            }
            space
                .keep
                .push(hole.zone_in_front(side, wall + DOOR_FRONT_M, 0.0));
            let [x0, z0, x1, z1] = hole.zone_in_front(side, wall + 0.06, 0.07);
            space.openings.push(Aabb::new(
                Vec3::new(x0, 0.0, z0),
                Vec3::new(x1, hole.high_m + 0.07, z1),
            ));
            if side > 0.0 {
                space.keep.extend(hole.swept_zone());
            }
        }
        if let Some([x0, z0, x1, z1]) = void {
            // Stairs need the floor before them.
            let front = DOOR_FRONT_M + 0.2;
            space
                .keep
                .push([x0 - front, z0 - front, x1 + front, z1 + front]);
        }
        space.holes = own;
        space.void = void;
        space.compute_walkable(room, storey, radius_m);
        space
    }

    /// Computes the walkable floor for paths of another width.
    pub(crate) fn compute_walkable(
        &mut self,
        room: usize,
        storey: &GeneratedStorey,
        radius_m: f32,
    ) {
        let corner = [0, 1].map(|k| self.floor.iter().map(|z| z[k]).fold(f32::MAX, f32::min));
        let far = [2, 3].map(|k| self.floor.iter().map(|z| z[k]).fold(f32::MIN, f32::max));
        let cells = |k: usize| ((far[k] - corner[k]) / CELL_M).ceil().max(0.0) as usize;
        let (columns, rows) = (cells(0), cells(1));
        let mut grid = ClearanceGrid {
            corner,
            columns,
            rows,
            free: vec![false; columns * rows],
            radius_m,
            doors: Vec::new(),
            shut: false,
        };
        for cell in 0..grid.free.len() {
            let [x, z] = grid.cell_centre(cell);
            let r = radius_m;
            grid.free[cell] = self.contains_zone(&[x - r, z - r, x + r, z + r]);
        }
        for piece in &self.pieces {
            for bounds in piece.boxes.iter().filter(|b| is_walking_obstacle(b)) {
                grid.block(&zone_of_box(bounds));
            }
        }
        let leaves = self.holes.iter().filter(|hole| hole.room == room);
        for leaf in leaves.filter_map(WallHole::open_leaf_zone) {
            grid.block(&leaf);
        }
        if let Some([x0, z0, x1, z1]) = self.void {
            let middle = [0.5 * (x0 + x1), 0.5 * (z0 + z1)];
            grid.doors.extend(grid.nearest_free(middle, f32::MAX));
        }
        for hole in &self.holes {
            if matches!(hole.contents, HoleContents::Window { .. }) {
                continue;
            }
            let side = if hole.room == room { 1.0 } else { -1.0 };
            let off = 0.5 * hole.wall_m(storey) + radius_m;
            let [x0, z0, x1, z1] = hole.zone_in_front(side, off, 0.0);
            let at = if hole.along_x {
                let across = hole.at_m + hole.inward_sign * side * off;
                [0.5 * (x0 + x1), across]
            } else {
                [hole.at_m + hole.inward_sign * side * off, 0.5 * (z0 + z1)]
            };
            match grid.nearest_free(at, 0.8) {
                Some(cell) => grid.doors.push(cell),
                None => grid.shut = true,
            }
        }
        self.grid = grid;
    }

    /// Returns whether all doors of the room are joined by paths of the chosen width.
    pub(crate) fn are_doors_connected(&self) -> bool {
        !self.grid.shut && self.grid.keeps_doors_joined(&[])
    }

    /// Returns whether a rectangle lies over the floor entirely.
    pub(crate) fn contains_zone(&self, rect: &ZoneXz) -> bool {
        floor_contains_zone(&self.floor, rect)
    }

    /// Returns whether a thing fits there: it touches nothing and blocks nothing.
    pub(crate) fn can_place(&self, piece: &PlacedFurniture) -> bool {
        let own = zone_of_box(&piece.bounds);
        if !self.contains_zone(&own) {
            return false;
        }
        let hits = |boxes: &[Aabb], around: &Aabb, bounds: &Aabb| {
            meets(around, bounds) && boxes.iter().any(|b| meets(b, bounds))
        };
        let open = || self.openings.iter();
        if !piece.at_window && open().any(|o| hits(&piece.boxes, &piece.bounds, o)) {
            return false;
        }
        // A thing above head height blocks no door.
        let low = piece.boxes.iter().filter(|b| b.min.y < 2.1);
        for bounds in low {
            if self
                .keep
                .iter()
                .any(|keep| overlap(keep, &zone_of_box(bounds)))
            {
                return false;
            }
        }
        if !piece.swept_boxes.is_empty() {
            let swept = zone_of_box(&piece.swept_bounds);
            if !self.contains_zone(&swept) || self.keep.iter().any(|keep| overlap(keep, &swept)) {
                return false;
            }
            if open().any(|o| hits(&piece.swept_boxes, &piece.swept_bounds, o)) {
                return false;
            }
        }
        for zone in &piece.clearance_zones {
            if !self.contains_zone(zone) {
                return false;
            }
        }
        for (k, other) in self.pieces.iter().enumerate() {
            if !are_compatible(piece, other, piece.anchor == Some(k)) {
                return false;
            }
        }
        self.leaves_paths(piece)
    }

    fn leaves_paths(&self, piece: &PlacedFurniture) -> bool {
        let blocking: Vec<ZoneXz> = piece
            .boxes
            .iter()
            .filter(|b| is_walking_obstacle(b))
            .map(zone_of_box)
            .collect();
        blocking.is_empty() || (!self.grid.shut && self.grid.keeps_doors_joined(&blocking))
    }

    /// Returns whether a small thing can lie there, on or (`inside`) in its host.
    pub(crate) fn can_place_on(&self, piece: &PlacedFurniture, host: usize, inside: bool) -> bool {
        self.pieces.iter().enumerate().all(|(k, other)| {
            let boxes = meets(&piece.bounds, &other.bounds)
                && piece
                    .boxes
                    .iter()
                    .any(|b| other.boxes.iter().any(|o| meets(b, o)));
            let own = inside && k == host;
            let swept_boxes = !own
                && meets(&piece.bounds, &other.swept_bounds)
                && piece
                    .boxes
                    .iter()
                    .any(|b| other.swept_boxes.iter().any(|o| meets(b, o)));
            // Its own lid or door opens as well.
            let opens = k == host
                || !meets(&piece.swept_bounds, &other.bounds)
                || !piece
                    .swept_boxes
                    .iter()
                    .any(|b| other.boxes.iter().any(|o| meets(b, o)));
            !boxes && !swept_boxes && opens
        }) && self.openings.iter().all(|o| !meets(&piece.bounds, o))
    }

    /// Adds a small thing, which blocks nothing.
    pub(crate) fn add_small_item(&mut self, piece: PlacedFurniture) {
        self.pieces.push(piece);
    }

    /// The point on the wall's inner face below the middle of a window, at the height of the floor.
    pub(crate) fn inner_face_point(&self, hole: &WallHole) -> Option<Vec3> {
        let middle = 0.5 * (hole.from_m + hole.to_m);
        let span = self.wall_spans.iter().find(|span| {
            span.along_x == hole.along_x
                && (span.face_m - hole.at_m).abs() < 0.15
                && (span.from_m..span.to_m).contains(&middle)
        })?;
        Some(span.point(middle, 0.0))
    }

    /// Adds a thing.
    pub(crate) fn add(&mut self, piece: PlacedFurniture) -> usize {
        for bounds in piece.boxes.iter().filter(|b| is_walking_obstacle(b)) {
            self.grid.block(&zone_of_box(bounds));
        }
        self.pieces.push(piece);
        self.pieces.len() - 1
    }
}

/// Returns whether two things leave each other alone; those that belong together may share free floor.
fn are_compatible(a: &PlacedFurniture, b: &PlacedFurniture, together: bool) -> bool {
    let touch = |p: &[Aabb], around_p: &Aabb, q: &[Aabb], around_q: &Aabb| {
        meets(around_p, around_q)
            && p.iter()
                .filter(|one| meets(one, around_q))
                .any(|one| q.iter().any(|other| meets(one, other)))
    };
    if touch(&a.boxes, &a.bounds, &b.boxes, &b.bounds)
        || touch(&a.swept_boxes, &a.swept_bounds, &b.boxes, &b.bounds)
        || touch(&a.boxes, &a.bounds, &b.swept_boxes, &b.swept_bounds)
    {
        return false;
    }
    let blocks = |p: &PlacedFurniture, q: &PlacedFurniture| {
        let mut low = p.boxes.iter().filter(|b| is_walking_obstacle(b));
        low.any(|b| {
            q.clearance_zones
                .iter()
                .any(|clear| overlap(clear, &zone_of_box(b)))
        })
    };
    together || (!blocks(a, b) && !blocks(b, a))
}

impl ClearanceGrid {
    fn cell_centre(&self, cell: usize) -> [f32; 2] {
        let (column, row) = (cell % self.columns, cell / self.columns);
        [
            self.corner[0] + (column as f32 + 0.5) * CELL_M,
            self.corner[1] + (row as f32 + 0.5) * CELL_M,
        ]
    }

    /// The cells whose middle lies in a rectangle grown by the radius.
    fn block(&mut self, zone: &ZoneXz) {
        let mut free = std::mem::take(&mut self.free);
        self.for_each_blocked_cell(zone, |cell| free[cell] = false);
        self.free = free;
    }

    fn for_each_blocked_cell(&self, zone: &ZoneXz, mut each: impl FnMut(usize)) {
        let cell = |value: f32, k: usize, count: usize| {
            (((value - self.corner[k]) / CELL_M).max(0.0) as usize).min(count)
        };
        let r = self.radius_m;
        let (c0, c1) = (
            cell(zone[0] - r + 0.5 * CELL_M, 0, self.columns),
            cell(zone[2] + r + 0.5 * CELL_M, 0, self.columns),
        );
        let (r0, r1) = (
            cell(zone[1] - r + 0.5 * CELL_M, 1, self.rows),
            cell(zone[3] + r + 0.5 * CELL_M, 1, self.rows),
        );
        for row in r0..r1 {
            for column in c0..c1 {
                each(row * self.columns + column);
            }
        }
    }

    fn nearest_free(&self, at: [f32; 2], within_m: f32) -> Option<usize> {
        let far = |cell: &usize| {
            let [x, z] = self.cell_centre(*cell);
            (x - at[0]).hypot(z - at[1])
        };
        (0..self.free.len())
            .filter(|cell| self.free[*cell])
            .min_by(|a, b| far(a).total_cmp(&far(b)))
            .filter(|cell| far(cell) <= within_m)
    }

    /// Returns whether all doors are on one free island when `zones` are blocked, too, and half of the free floor is on it.
    fn keeps_doors_joined(&self, zones: &[ZoneXz]) -> bool {
        let mut free = self.free.clone();
        for zone in zones {
            self.for_each_blocked_cell(zone, |cell| free[cell] = false);
        }
        let all = free.iter().filter(|free| **free).count();
        let Some(start) = self.doors.first().copied().or(free.iter().position(|f| *f)) else {
            return false;
        };
        let mut reached = 0;
        let mut stack = vec![start];
        while let Some(cell) = stack.pop() {
            if !free[cell] {
                continue;
            }
            free[cell] = false;
            reached += 1;
            let (column, row) = (cell % self.columns, cell / self.columns);
            if column > 0 {
                stack.push(cell - 1);
            }
            if column + 1 < self.columns {
                stack.push(cell + 1);
            }
            if row > 0 {
                stack.push(cell - self.columns);
            }
            if row + 1 < self.rows {
                stack.push(cell + self.columns);
            }
        }
        let blocked = |door: &usize| {
            free[*door]
                || zones.iter().any(|zone| {
                    let mut inside = false;
                    self.for_each_blocked_cell(zone, |cell| inside |= cell == *door);
                    inside
                })
        };
        reached * 5 >= all * 4 && reached > 0 && !self.doors.iter().any(blocked)
    }
}

/// The walls around a room, those that go on straight joined.
fn spans(storey: &GeneratedStorey, cells: &StoreyCells, room: usize) -> Vec<WallSpan> {
    let mut spans: Vec<WallSpan> = Vec::new();
    for run in cells.boundaries() {
        let inward = match run.sides {
            [_, Some(own)] if own == room => 1.0,
            [Some(own), _] if own == room => -1.0,
            _ => continue,
        };
        let other = if inward > 0.0 {
            run.sides[0]
        } else {
            run.sides[1]
        };
        // A railing is no wall.
        if other.is_none() && storey.rooms[room].kind.is_outside() {
            continue;
        }
        let half = half_wall_thickness_m(storey, room, other);
        let span = WallSpan {
            along_x: run.along_x,
            face_m: metres(run.at) + inward * half,
            from_m: metres(run.from),
            to_m: metres(run.to),
            inward_sign: inward,
        };
        let goes_on = spans.last_mut().filter(|last| {
            last.along_x == span.along_x
                && last.inward_sign.total_cmp(&span.inward_sign).is_eq()
                && (last.face_m - span.face_m).abs() < 1e-3
                && (last.to_m - span.from_m).abs() < 1e-3
        });
        if let Some(last) = goes_on {
            last.to_m = span.to_m;
        } else {
            spans.push(span);
        }
    }
    // Up to the faces of the walls across.
    let faces = spans.clone();
    for span in &mut spans {
        let near = |at: f32, side: f32| {
            faces
                .iter()
                .filter(|f| f.along_x != span.along_x && f.inward_sign.total_cmp(&side).is_eq())
                .map(|f| f.face_m)
                .find(|face| (face - at).abs() < 0.11)
        };
        span.from_m = near(span.from_m, 1.0).unwrap_or(span.from_m);
        span.to_m = near(span.to_m, -1.0).unwrap_or(span.to_m);
    }
    spans.retain(|span| span.to_m - span.from_m > 0.3);
    spans
}
