//! Exact straight lines over the grid.

use super::config::DoorPolicy;
use super::grid::{NavCell, NavGrid};
use super::layers::{DOORWAY, EAST, NO_CELL, NORTH, SOUTH, WEST};

/// A straight line between the middles of two cells.
#[derive(Clone, Copy, Debug)]
pub(super) struct StraightPath {
    pub(super) to: NavCell,
    /// Number of times that the path enters or leaves the doorway of a closed door.
    pub(super) door_crossings: u32,
    /// True if no step on the path is higher or lower.
    pub(super) level: bool,
    /// Its length over the ground, m.
    pub(super) length_m: f64,
}

/// Length of the pieces in which the ground is followed, m: over stairs one climbs the slope of their edges, not treads and
/// risers.
const STRIDE_M: f64 = 0.3;
/// The same in columns, where that is longer, so that each piece of a distance field is one.
const STRIDE_COLUMNS: f64 = 3.7;

impl NavGrid {
    /// Walks straight from the middle of a cell to the middle of the column `dx` and `dz` columns away, over every cell
    /// that the line touches; `None` where one is missing. A line through the corner of four cells needs both paths around
    /// it.
    ///
    /// # Source
    /// The integer form of J. Amanatides and A. Woo, Eurographics 1987, 3: which border comes next is decided exactly.
    pub(super) fn straight_path_to_offset(
        &self,
        from: NavCell,
        dx: isize,
        dz: isize,
    ) -> Option<StraightPath> {
        let link = |cell: u32, way: usize| {
            let there = self.layers.links[cell as usize][way];
            (there != NO_CELL).then_some(there)
        };
        let priced = self.config.doors == DoorPolicy::Priced;
        let doorway = |cell: u32| priced && self.layers.flags[cell as usize] & DOORWAY != 0;
        let height = |cell: u32| self.layers.height[cell as usize];
        let along_x = if dx > 0 { EAST } else { WEST };
        let along_z = if dz > 0 { SOUTH } else { NORTH };
        let (steps_x, steps_z) = (dx.abs(), dz.abs());
        // Lead of the next border across x over the next one across z, times both step counts, twice.
        let mut ahead = steps_x - steps_z;
        let (mut left_x, mut left_z) = (steps_x, steps_z);
        let (mut here, mut door_crossings, mut level) = (from.0, 0, true);
        let mut ground = ElevationProfile::new(
            self.horizontal_length_m(dx, dz),
            f64::from(self.config.cell_m),
        );
        while left_x > 0 || left_z > 0 {
            let there = if ahead == 0 && left_x > 0 && left_z > 0 {
                let (a, b) = (link(here, along_x)?, link(here, along_z)?);
                let there = link(a, along_z)?;
                if link(b, along_x)? != there {
                    return None;
                }
                let beside = !doorway(here) && !doorway(there) && (doorway(a) || doorway(b));
                door_crossings += 2 * u32::from(beside);
                (left_x, left_z) = (left_x - 1, left_z - 1);
                ahead += 2 * (steps_x - steps_z);
                there
            } else if ahead > 0 {
                left_x -= 1;
                ahead -= 2 * steps_z;
                link(here, along_x)?
            } else {
                left_z -= 1;
                ahead += 2 * steps_x;
                link(here, along_z)?
            };
            door_crossings += u32::from(doorway(here) != doorway(there));
            level &= (height(here) - height(there)).abs() < 1e-3;
            here = there;
            if !level {
                let left = (left_x + left_z) as f64 / (steps_x + steps_z) as f64;
                ground.reach(1.0 - left, f64::from(height(here) - height(from.0)));
            }
        }
        Some(StraightPath {
            to: NavCell(here),
            door_crossings,
            level,
            length_m: ground.length_m(level),
        })
    }

    /// Returns the straight line between two cells, if it is free.
    pub(super) fn straight_path_between(&self, from: NavCell, to: NavCell) -> Option<StraightPath> {
        if !self.is_walkable(from) || !self.is_walkable(to) {
            return None;
        }
        let (dx, dz) = self.offset(from, to);
        self.straight_path_to_offset(from, dx, dz)
            .filter(|crossing| crossing.to == to)
    }

    /// Returns the offset of `to` from `from`, in columns along x and z.
    pub(super) fn offset(&self, from: NavCell, to: NavCell) -> (isize, isize) {
        let width = self.ground.frame.width;
        let place = |cell: NavCell| {
            let column = cell.0 as usize % self.layers.columns;
            ((column % width) as isize, (column / width) as isize)
        };
        let ((x, z), (i, j)) = (place(from), place(to));
        (i - x, j - z)
    }

    /// Returns the length of a straight line on the plan, m.
    pub(super) fn horizontal_length_m(&self, dx: isize, dz: isize) -> f64 {
        let squared = dx * dx + dz * dz;
        f64::from(self.config.cell_m) * (squared as f64).sqrt()
    }

    /// Returns whether the straight line between the middles of two cells stays on walkable cells without a step too high:
    /// decided exactly, for every cell that the line touches.
    pub fn is_straight_free(&self, from: NavCell, to: NavCell) -> bool {
        self.straight_path_between(from, to).is_some()
    }

    /// Returns the cost of a straight line: its length over the ground, and half a door's price at each threshold, m.
    pub(super) fn cost_m(&self, crossing: &StraightPath) -> f64 {
        let price = 0.5 * f64::from(self.config.door_price_m);
        crossing.length_m + price * f64::from(crossing.door_crossings)
    }
}

/// The ground along a straight line, in strides.
struct ElevationProfile {
    plan_m: f64,
    strides: f64,
    /// End of the last stride, as a share of the path, and its height.
    last: [f64; 2],
    sum_m: f64,
}

impl ElevationProfile {
    fn new(plan_m: f64, cell_m: f64) -> Self {
        let stride = STRIDE_M.max(STRIDE_COLUMNS * cell_m);
        Self {
            plan_m,
            strides: (plan_m / stride).ceil().max(1.0),
            last: [0.0; 2],
            sum_m: 0.0,
        }
    }

    /// Extends the profile to a share of the path where the ground is `rise_m` above the start.
    fn reach(&mut self, share: f64, rise_m: f64) {
        let [begun, low] = self.last;
        if share * self.strides >= (begun * self.strides).floor() + 1.0 || share >= 1.0 {
            let (along, up) = ((share - begun) * self.plan_m, rise_m - low);
            self.sum_m += (along * along + up * up).sqrt();
            self.last = [share, rise_m];
        }
    }

    fn length_m(&self, level: bool) -> f64 {
        if level { self.plan_m } else { self.sum_m }
    }
}
