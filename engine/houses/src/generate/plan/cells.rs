//! Cells of a storey by room, and the walls between rooms.

use super::{GeneratedRoom, GridRect, GridSteps};

/// A straight stretch between the same two rooms (or a room and the outside).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct BoundarySegment {
    /// True if it runs along x (west to east); else along z.
    pub(crate) along_x: bool,
    /// Its position across: z of one along x, x of one along z.
    pub(crate) at: GridSteps,
    pub(crate) from: GridSteps,
    pub(crate) to: GridSteps,
    /// The rooms at smaller and at larger `at`; `None`: outside.
    pub(crate) sides: [Option<usize>; 2],
}

impl BoundarySegment {
    /// Returns whether it separates these two.
    pub(crate) fn separates(&self, a: Option<usize>, b: Option<usize>) -> bool {
        self.sides == [a, b] || self.sides == [b, a]
    }
}

/// A storey cut by all edges of its rooms.
#[derive(Clone, Debug)]
pub(crate) struct StoreyCells {
    lines: [Vec<GridSteps>; 2],
    /// The room of each cell, rows of growing x.
    rooms: Vec<Option<usize>>,
}

impl StoreyCells {
    pub(crate) fn new(rooms: &[GeneratedRoom]) -> Self {
        let lines = [0, 1].map(|axis| {
            let areas = rooms.iter().flat_map(|room| &room.areas);
            let mut lines: Vec<GridSteps> = areas.flat_map(|a| [a[axis], a[axis + 2]]).collect();
            lines.sort_unstable();
            lines.dedup();
            lines
        });
        let columns = lines[0].len().saturating_sub(1);
        let rows = lines[1].len().saturating_sub(1);
        let inside = |[x0, z0, x1, z1]: &GridRect, x: GridSteps, z: GridSteps| {
            (*x0..*x1).contains(&x) && (*z0..*z1).contains(&z)
        };
        let owner = |x: GridSteps, z: GridSteps| {
            rooms
                .iter()
                .position(|room| room.areas.iter().any(|area| inside(area, x, z)))
        };
        let mut owners = Vec::with_capacity(columns * rows);
        for z in &lines[1][..rows] {
            for x in &lines[0][..columns] {
                owners.push(owner(*x, *z));
            }
        }
        Self {
            lines,
            rooms: owners,
        }
    }

    fn columns(&self) -> usize {
        self.lines[0].len().saturating_sub(1)
    }

    /// The room at a cell; outside beyond the grid.
    fn room(&self, column: Option<usize>, row: Option<usize>) -> Option<usize> {
        let (column, row) = (column?, row?);
        if column >= self.columns() {
            return None;
        }
        self.rooms.get(row * self.columns() + column).copied()?
    }

    /// The cells of a room, each with the rooms to its west, north, east and south.
    pub(crate) fn cells_of_room(&self, room: usize) -> Vec<(GridRect, [Option<usize>; 4])> {
        let mut found = Vec::new();
        for (cell, owner) in self.rooms.iter().enumerate() {
            if *owner != Some(room) {
                continue;
            }
            let (i, j) = (cell % self.columns(), cell / self.columns());
            let (x, z) = (&self.lines[0], &self.lines[1]);
            let around = [
                self.room(i.checked_sub(1), Some(j)),
                self.room(Some(i), j.checked_sub(1)),
                self.room(Some(i + 1), Some(j)),
                self.room(Some(i), Some(j + 1)),
            ];
            found.push(([x[i], z[j], x[i + 1], z[j + 1]], around));
        }
        found
    }

    /// All stretches, those along x first, from north to south and west to east.
    pub(crate) fn boundaries(&self) -> Vec<BoundarySegment> {
        let mut runs = Vec::new();
        for along_x in [true, false] {
            let (along, across) = if along_x { (0, 1) } else { (1, 0) };
            for (k, at) in self.lines[across].iter().enumerate() {
                let mut open: Option<BoundarySegment> = None;
                for pair in 0..self.lines[along].len().saturating_sub(1) {
                    let side = |across: Option<usize>| {
                        if along_x {
                            self.room(Some(pair), across)
                        } else {
                            self.room(across, Some(pair))
                        }
                    };
                    let sides = [side(k.checked_sub(1)), side(Some(k))];
                    let (from, to) = (self.lines[along][pair], self.lines[along][pair + 1]);
                    match &mut open {
                        Some(run) if run.sides == sides => run.to = to,
                        _ => {
                            runs.extend(open.take().filter(|run| run.sides[0] != run.sides[1]));
                            open = Some(BoundarySegment {
                                along_x,
                                at: *at,
                                from,
                                to,
                                sides,
                            });
                        }
                    }
                }
                runs.extend(open.filter(|run| run.sides[0] != run.sides[1]));
            }
        }
        runs
    }
}
