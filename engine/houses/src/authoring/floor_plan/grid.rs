//! A storey as a grid of room, wall and air: the plan cut by all edges of rooms, in whole millimetres.

use std::collections::VecDeque;

use super::super::edit_errors::{check_range, invalid_field, prefix_field};
use super::data::{RoomPlan, StoreyPlan};
use crate::error::HousesError;

/// A length in whole millimetres.
pub(super) type Millimetres = i32;

/// Largest number of lines along x or z; cells are their product.
const MAX_LINES: usize = 800;
/// Smallest thickness of a wall.
const LEAST_WALL: Millimetres = 50;

/// Metres.
pub(super) fn metres(mm: Millimetres) -> f32 {
    mm as f32 / 1000.0
}

/// Whole millimetres of metres within 1 km.
pub(super) fn millimetres(field: &str, metres: f32) -> Result<Millimetres, HousesError> {
    Ok((check_range(field, metres, [-1000.0, 1000.0], "m")? * 1000.0).round() as Millimetres)
}

/// The contents of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum PlanCell {
    Room(usize),
    Wall,
    Outside,
}

/// A storey cut into cells.
#[derive(Debug)]
pub(super) struct PlanGrid {
    pub(super) xs: Vec<Millimetres>,
    pub(super) zs: Vec<Millimetres>,
    /// Cells in rows of growing x.
    cells: Vec<PlanCell>,
    /// The room whose slabs reach under and over each cell: its own, or the nearest one of a wall.
    owners: Vec<Option<usize>>,
}

impl PlanGrid {
    /// Cuts a storey. `cuts`: rectangles whose edges are lines too.
    ///
    /// # Errors
    /// [`HousesError::Spec`] for outlines that are none, rooms that overlap, and walls too thin to stand.
    pub(super) fn new(
        storey: &StoreyPlan,
        outer: Millimetres,
        cuts: &[[Millimetres; 4]],
    ) -> Result<Self, HousesError> {
        let mut outlines = Vec::new();
        for (k, room) in storey.rooms.iter().enumerate() {
            outlines.push(outline(room).map_err(prefix_field(format_args!("rooms[{k}]")))?);
        }
        let lines = |axis: usize| -> Result<Vec<Millimetres>, HousesError> {
            let corners = outlines.iter().flatten().map(|corner| corner[axis]);
            let mut lines: Vec<Millimetres> = corners
                .flat_map(|at| [at - outer, at, at + outer])
                .collect();
            lines.extend(cuts.iter().flat_map(|cut| [cut[axis], cut[axis + 2]]));
            lines.sort_unstable();
            lines.dedup();
            if lines.len() > MAX_LINES {
                let found = format!("{} different edges", lines.len());
                return Err(invalid_field(
                    "rooms",
                    found,
                    format!("at most {MAX_LINES} along an axis"),
                ));
            }
            Ok(lines)
        };
        let (xs, zs) = (lines(0)?, lines(1)?);
        let mut grid = Self {
            cells: Vec::with_capacity(xs.len() * zs.len()),
            owners: Vec::new(),
            xs,
            zs,
        };
        for j in 0..grid.rows() {
            let z = [grid.zs[j], grid.zs[j + 1]];
            // Where the outlines cross the middle of the row, each pair of crossings with a room between.
            let spans: Vec<Vec<Millimetres>> = outlines
                .iter()
                .map(|outline| crossings(outline, z[0]))
                .collect();
            let near: Vec<Vec<Millimetres>> = outlines
                .iter()
                .map(|outline| dilated_spans(outline, z, outer))
                .collect();
            for i in 0..grid.columns() {
                let x = grid.xs[i];
                let holds = |spans: &[Millimetres]| {
                    spans
                        .chunks_exact(2)
                        .any(|span| (span[0]..span[1]).contains(&x))
                };
                let mut rooms = (0..outlines.len()).filter(|k| holds(&spans[*k]));
                let cell = match (rooms.next(), rooms.next()) {
                    (Some(a), Some(b)) => return Err(overlapping_rooms_error(storey, a, b)),
                    (Some(room), None) => PlanCell::Room(room),
                    _ if near.iter().any(|spans| holds(spans)) => PlanCell::Wall,
                    _ => PlanCell::Outside,
                };
                grid.cells.push(cell);
            }
        }
        grid.check_walls(storey)?;
        grid.assign_wall_owners();
        Ok(grid)
    }

    pub(super) fn columns(&self) -> usize {
        self.xs.len().saturating_sub(1)
    }

    pub(super) fn rows(&self) -> usize {
        self.zs.len().saturating_sub(1)
    }

    /// Returns the cell at column and row; air beyond the grid.
    pub(super) fn cell(&self, i: usize, j: usize) -> PlanCell {
        if i >= self.columns() || j >= self.rows() {
            return PlanCell::Outside;
        }
        self.cells[j * self.columns() + i]
    }

    /// The rectangle of a cell.
    pub(super) fn rect(&self, i: usize, j: usize) -> [Millimetres; 4] {
        [self.xs[i], self.zs[j], self.xs[i + 1], self.zs[j + 1]]
    }

    /// Checks that walls thick enough separate the rooms.
    fn check_walls(&self, storey: &StoreyPlan) -> Result<(), HousesError> {
        for along_x in [true, false] {
            let (lines, cross, count) = if along_x {
                (self.rows(), self.columns(), &self.xs)
            } else {
                (self.columns(), self.rows(), &self.zs)
            };
            for line in 0..lines {
                // The last room on the line, and where it ended.
                let mut last: Option<(usize, usize)> = None;
                for k in 0..cross {
                    let cell = if along_x {
                        self.cell(k, line)
                    } else {
                        self.cell(line, k)
                    };
                    match (cell, last) {
                        (PlanCell::Room(room), Some((before, end)))
                            if end + 1 < k || before != room =>
                        {
                            let gap = count[k] - count[end + 1];
                            if gap < LEAST_WALL {
                                return Err(thin_wall_error(storey, before, room, gap));
                            }
                            last = Some((room, k));
                        }
                        (PlanCell::Room(room), _) => last = Some((room, k)),
                        (PlanCell::Outside, _) => last = None,
                        (PlanCell::Wall, _) => {}
                    }
                }
            }
        }
        Ok(())
    }

    /// Assigns each cell of a wall to the nearest room, counted in cells.
    fn assign_wall_owners(&mut self) {
        let (columns, rows) = (self.columns(), self.rows());
        let owner = |cell: &PlanCell| match cell {
            PlanCell::Room(room) => Some(*room),
            _ => None,
        };
        self.owners = self.cells.iter().map(owner).collect();
        let owned = (0..self.cells.len()).filter(|k| self.owners[*k].is_some());
        let mut open: VecDeque<usize> = owned.collect();
        while let Some(k) = open.pop_front() {
            let (i, j) = (k % columns, k / columns);
            let around = [
                (i > 0).then(|| k - 1),
                (j > 0).then(|| k - columns),
                (i + 1 < columns).then(|| k + 1),
                (j + 1 < rows).then(|| k + columns),
            ];
            for next in around.into_iter().flatten() {
                if self.cells[next] == PlanCell::Wall && self.owners[next].is_none() {
                    self.owners[next] = self.owners[k];
                    open.push_back(next);
                }
            }
        }
    }

    /// The room whose slabs reach under and over a cell.
    pub(super) fn owner(&self, i: usize, j: usize) -> Option<usize> {
        self.owners[j * self.columns() + i]
    }

    /// Cells for which `wanted` holds as rectangles, m, that do not overlap: cells of a row in one, equal rows in one.
    pub(super) fn rectangles(&self, wanted: impl Fn(usize, usize) -> bool) -> Vec<[f32; 4]> {
        let mut done: Vec<[Millimetres; 4]> = Vec::new();
        let mut open: Vec<[Millimetres; 4]> = Vec::new();
        for j in 0..self.rows() {
            let mut row: Vec<[Millimetres; 4]> = Vec::new();
            for i in 0..self.columns() {
                if !wanted(i, j) {
                    continue;
                }
                let rect = self.rect(i, j);
                match row.last_mut() {
                    Some(last) if last[2] == rect[0] => last[2] = rect[2],
                    _ => row.push(rect),
                }
            }
            let mut next = Vec::new();
            for mut rect in row {
                let same = open.iter().position(|above| {
                    [above[0], above[2], above[3]] == [rect[0], rect[2], rect[1]]
                });
                if let Some(above) = same {
                    rect[1] = open.swap_remove(above)[1];
                }
                next.push(rect);
            }
            done.append(&mut open);
            open = next;
        }
        done.append(&mut open);
        done.sort_unstable();
        done.into_iter().map(|rect| rect.map(metres)).collect()
    }
}

fn overlapping_rooms_error(storey: &StoreyPlan, a: usize, b: usize) -> HousesError {
    let names = [a, b].map(|k| storey.rooms[k].name.as_str());
    let found = format!("rooms {:?} and {:?} that overlap", names[0], names[1]);
    invalid_field(
        "rooms",
        found,
        "floors that do not overlap, with the thickness of a wall between them",
    )
}

fn thin_wall_error(storey: &StoreyPlan, a: usize, b: usize, gap: Millimetres) -> HousesError {
    let names = [a, b].map(|k| storey.rooms[k].name.as_str());
    let found = format!(
        "{:.3} m between rooms {:?} and {:?}",
        metres(gap),
        names[0],
        names[1]
    );
    invalid_field(
        "rooms",
        found,
        format!(
            "at least {} m: what is left between floors is wall",
            metres(LEAST_WALL)
        ),
    )
}

/// The corners of a room's floor.
fn outline(room: &RoomPlan) -> Result<Vec<[Millimetres; 2]>, HousesError> {
    let mut corners = Vec::new();
    for (k, [x, z]) in room.outline.iter().enumerate() {
        let field = format!("outline[{k}]");
        let corner = [millimetres(&field, *x)?, millimetres(&field, *z)?];
        if corners.last() != Some(&corner) {
            corners.push(corner);
        }
    }
    if corners.len() > 1 && corners.first() == corners.last() {
        corners.pop();
    }
    if corners.len() < 4 || corners.len() > 200 {
        let found = format!("{} different corners", corners.len());
        return Err(invalid_field("outline", found, "4 to 200"));
    }
    for (k, a) in corners.iter().enumerate() {
        let b = corners[(k + 1) % corners.len()];
        if a[0] != b[0] && a[1] != b[1] {
            let found = format!("an edge from {:?} to {:?}", a.map(metres), b.map(metres));
            return Err(invalid_field("outline", found, "edges along x or along z"));
        }
    }
    for (k, a) in corners.iter().enumerate() {
        for (l, c) in corners.iter().enumerate().skip(k + 1) {
            let (b, d) = (
                corners[(k + 1) % corners.len()],
                corners[(l + 1) % corners.len()],
            );
            let beside = l == k + 1 || (k == 0 && l + 1 == corners.len());
            if !beside && meet([*a, b], [*c, d]) {
                let found = "an outline that meets itself";
                return Err(invalid_field(
                    "outline",
                    found,
                    "edges that meet at their ends only",
                ));
            }
        }
    }
    let area: i64 = (0..corners.len())
        .map(|k| {
            let ([ax, az], [bx, bz]) = (corners[k], corners[(k + 1) % corners.len()]);
            i64::from(ax) * i64::from(bz) - i64::from(bx) * i64::from(az)
        })
        .sum();
    if area.abs() < 2 * 100_000 {
        let found = format!("{} m2", area.abs() as f32 / 2e6);
        return Err(invalid_field(
            "outline",
            found,
            "a floor of at least 0.1 m2",
        ));
    }
    Ok(corners)
}

/// Returns whether two edges along the axes have a point in common.
fn meet(a: [[Millimetres; 2]; 2], b: [[Millimetres; 2]; 2]) -> bool {
    (0..2).all(|axis| {
        let span = |edge: [[Millimetres; 2]; 2]| {
            (
                edge[0][axis].min(edge[1][axis]),
                edge[0][axis].max(edge[1][axis]),
            )
        };
        let ((a0, a1), (b0, b1)) = (span(a), span(b));
        a0 <= b1 && b0 <= a1
    })
}

/// Returns the crossings of an outline with the row of cells that begins at `z`: pairs of x with the room between.
fn crossings(outline: &[[Millimetres; 2]], z: Millimetres) -> Vec<Millimetres> {
    let mut found: Vec<Millimetres> = (0..outline.len())
        .filter_map(|k| {
            let (a, b) = (outline[k], outline[(k + 1) % outline.len()]);
            let (low, high) = (a[1].min(b[1]), a[1].max(b[1]));
            (low <= z && z < high).then_some(a[0])
        })
        .collect();
    found.sort_unstable();
    found
}

/// Returns the part of the row of cells from `z` to `z` within `outer` of the outline's edges: pairs of x.
fn dilated_spans(
    outline: &[[Millimetres; 2]],
    [z0, z1]: [Millimetres; 2],
    outer: Millimetres,
) -> Vec<Millimetres> {
    let edges = (0..outline.len()).filter_map(|k| {
        let (a, b) = (outline[k], outline[(k + 1) % outline.len()]);
        let (low, high) = (a[1].min(b[1]) - outer, a[1].max(b[1]) + outer);
        (low < z1 && z0 < high).then(|| [a[0].min(b[0]) - outer, a[0].max(b[0]) + outer])
    });
    edges.flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn room(name: &str, outline: &[[f32; 2]]) -> RoomPlan {
        RoomPlan {
            name: name.to_owned(),
            kind: None,
            outline: outline.to_vec(),
            height_m: None,
            floor: None,
            walls: None,
            ceiling: None,
        }
    }

    fn rect(name: &str, [x0, z0, x1, z1]: [f32; 4]) -> RoomPlan {
        room(name, &[[x0, z0], [x1, z0], [x1, z1], [x0, z1]])
    }

    fn grid(rooms: Vec<RoomPlan>) -> Result<PlanGrid, HousesError> {
        let storey = StoreyPlan {
            rooms,
            ..StoreyPlan::default()
        };
        PlanGrid::new(&storey, 200, &[])
    }

    fn area(rects: &[[f32; 4]]) -> f32 {
        rects
            .iter()
            .map(|[x0, z0, x1, z1]| (x1 - x0) * (z1 - z0))
            .sum()
    }

    #[test]
    fn floors_and_walls_take_their_areas() {
        let grid = grid(vec![
            rect("a", [0.0, 0.0, 4.0, 3.0]),
            rect("b", [4.1, 0.0, 6.0, 3.0]),
        ])
        .unwrap();
        let of = |wanted: PlanCell| area(&grid.rectangles(|i, j| grid.cell(i, j) == wanted));
        assert!((of(PlanCell::Room(0)) - 12.0).abs() < 1e-4);
        assert!((of(PlanCell::Room(1)) - 5.7).abs() < 1e-4);
        // All within 0.2 m of the floors: 6.4 by 3.4 m without the two floors.
        assert!((of(PlanCell::Wall) - (6.4 * 3.4 - 17.7)).abs() < 1e-3);
    }

    #[test]
    fn plans_that_cannot_stand_are_refused_by_name() {
        let a = || rect("a", [0.0, 0.0, 4.0, 3.0]);
        for (rooms, said) in [
            (
                vec![a(), rect("b", [3.0, 1.0, 6.0, 2.0])],
                "\"a\" and \"b\" that overlap",
            ),
            (
                vec![a(), rect("b", [4.02, 0.0, 6.0, 3.0])],
                "0.020 m between rooms \"a\" and \"b\"",
            ),
            (
                vec![a(), rect("b", [4.0, 0.0, 6.0, 3.0])],
                "0.000 m between rooms",
            ),
            (
                vec![room("c", &[[0.0, 0.0], [2.0, 0.0], [1.0, 2.0], [0.0, 2.0]])],
                "edges along x or along z",
            ),
            (
                vec![room("c", &[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0]])],
                "3 different corners",
            ),
            (vec![rect("c", [0.0, 0.0, f32::NAN, 1.0])], "outline[1]"),
        ] {
            let told = grid(rooms).unwrap_err().to_string();
            assert!(told.contains(said), "{told}");
        }
    }
}
