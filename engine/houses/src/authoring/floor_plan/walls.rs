//! Walls of a storey as straight stretches between the same two rooms.

use super::grid::{Millimetres, PlanCell, PlanGrid};

/// A stretch of wall.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct WallSegment {
    /// The rectangle: x from, z from, x to, z to.
    pub(super) rect: [Millimetres; 4],
    /// True if it runs along x; else along z.
    pub(super) along_x: bool,
    /// The cells at smaller and at larger z (of one along x) or x.
    pub(super) sides: [PlanCell; 2],
    /// The room that it belongs to.
    pub(super) room: usize,
}

impl WallSegment {
    /// The ends along the wall.
    pub(super) fn span(&self) -> [Millimetres; 2] {
        let [x0, z0, x1, z1] = self.rect;
        if self.along_x { [x0, x1] } else { [z0, z1] }
    }

    /// The faces across the wall.
    pub(super) fn thickness_span(&self) -> [Millimetres; 2] {
        let [x0, z0, x1, z1] = self.rect;
        if self.along_x { [z0, z1] } else { [x0, x1] }
    }

    /// Returns whether it separates these two.
    pub(super) fn separates(&self, a: PlanCell, b: PlanCell) -> bool {
        self.sides == [a, b] || self.sides == [b, a]
    }
}

/// The run of wall that a cell belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum WallCellKind {
    /// In a wall along x, with the cells north and south of it.
    X([PlanCell; 2]),
    /// In a wall along z, with the cells west and east of it.
    Z([PlanCell; 2]),
    /// At a corner or a crossing.
    Corner,
}

/// All stretches of a storey, those along x first. `thickest`: walls beyond that thickness have no other side.
pub(super) fn wall_segments(grid: &PlanGrid, thickest: Millimetres) -> Vec<WallSegment> {
    let (columns, rows) = (grid.columns(), grid.rows());
    let mut runs = Vec::with_capacity(columns * rows);
    for j in 0..rows {
        for i in 0..columns {
            let wall = grid.cell(i, j) == PlanCell::Wall;
            runs.push(wall.then(|| wall_cell_kind(grid, i, j, thickest)));
        }
    }
    let run = |i: usize, j: usize| runs[j * columns + i];
    let mut found = Vec::new();
    for along_x in [true, false] {
        let (lines, cross) = if along_x {
            (columns, rows)
        } else {
            (rows, columns)
        };
        let mut open: Vec<WallSegment> = Vec::new();
        for line in 0..lines {
            let at = |k: usize| if along_x { (line, k) } else { (k, line) };
            // The wall segments of this line of cells across the wall.
            let mut slices: Vec<WallSegment> = Vec::new();
            for k in 0..cross {
                let (i, j) = at(k);
                let ((Some(WallCellKind::X(sides)), true) | (Some(WallCellKind::Z(sides)), false)) =
                    (run(i, j), along_x)
                else {
                    continue;
                };
                let rect = grid.rect(i, j);
                match slices.last_mut() {
                    Some(last) if last.sides == sides && touches(&last.rect, &rect, !along_x) => {
                        (last.rect[2], last.rect[3]) = (rect[2], rect[3]);
                    }
                    _ => slices.push(WallSegment {
                        rect,
                        along_x,
                        sides,
                        room: room_of(sides).or(grid.owner(i, j)).unwrap_or_default(),
                    }),
                }
            }
            for slice in slices {
                let before = open.iter_mut().find(|other| {
                    other.sides == slice.sides
                        && other.thickness_span() == slice.thickness_span()
                        && touches(&other.rect, &slice.rect, along_x)
                });
                match before {
                    Some(other) => (other.rect[2], other.rect[3]) = (slice.rect[2], slice.rect[3]),
                    None => open.push(slice),
                }
            }
        }
        found.append(&mut open);
    }
    for j in 0..rows {
        for i in 0..columns {
            if run(i, j) != Some(WallCellKind::Corner) {
                continue;
            }
            let around = |dj: usize, up: bool| {
                let j = if up { j.checked_sub(dj) } else { Some(j + dj) };
                j.map_or(PlanCell::Outside, |j| grid.cell(i, j))
            };
            found.push(WallSegment {
                rect: grid.rect(i, j),
                along_x: true,
                sides: [around(1, true), around(1, false)],
                room: grid.owner(i, j).unwrap_or_default(),
            });
        }
    }
    found
}

/// Returns whether one rectangle ends where the other begins, along x or along z.
fn touches(a: &[Millimetres; 4], b: &[Millimetres; 4], along_x: bool) -> bool {
    let axis = usize::from(!along_x);
    a[axis + 2] == b[axis]
}

/// The room at the larger coordinate, else at the smaller.
fn room_of(sides: [PlanCell; 2]) -> Option<usize> {
    sides.into_iter().rev().find_map(|side| match side {
        PlanCell::Room(room) => Some(room),
        _ => None,
    })
}

fn wall_cell_kind(grid: &PlanGrid, i: usize, j: usize, thickest: Millimetres) -> WallCellKind {
    let upright = cells_across_wall(&grid.zs, j, |j| grid.cell(i, j));
    let level = cells_across_wall(&grid.xs, i, |i| grid.cell(i, j));
    let fits = |(sides, thick): &([PlanCell; 2], Millimetres)| {
        *thick <= thickest && sides.iter().any(|side| matches!(side, PlanCell::Room(_)))
    };
    match (fits(&upright), fits(&level)) {
        (true, true) if upright.1 <= level.1 => WallCellKind::X(upright.0),
        (true, false) => WallCellKind::X(upright.0),
        (_, true) => WallCellKind::Z(level.0),
        (false, false) => WallCellKind::Corner,
    }
}

/// Returns the cells on both sides of the wall at a place of a line of cells, and their distance.
fn cells_across_wall(
    lines: &[Millimetres],
    at: usize,
    cell: impl Fn(usize) -> PlanCell,
) -> ([PlanCell; 2], Millimetres) {
    let mut low = at;
    while low > 0 && cell(low - 1) == PlanCell::Wall {
        low -= 1;
    }
    let mut high = at;
    while high + 2 < lines.len() && cell(high + 1) == PlanCell::Wall {
        high += 1;
    }
    let below = if low > 0 {
        cell(low - 1)
    } else {
        PlanCell::Outside
    };
    let above = if high + 2 < lines.len() {
        cell(high + 1)
    } else {
        PlanCell::Outside
    };
    ([below, above], lines[high + 1] - lines[low])
}
