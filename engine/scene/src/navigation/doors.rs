//! Doors as edges between the islands of a grid.

use super::grid::{NavCell, NavGrid};
use super::obstacles::is_passable;
use super::static_grid::{columns_around, is_standing_blocked};
use crate::ids::JointId;

/// A door in the way of walking agents, as the grid has it.
#[derive(Clone, Debug, PartialEq)]
pub struct NavDoor {
    /// Its joint.
    pub joint: JointId,
    /// Openness when the grid was last updated, 0 to 1.
    pub openness: f32,
    /// True if it is open far enough to pass (0.8 and more).
    pub is_open: bool,
    /// The walkable cells under its closed leaf; none while the leaf or something else blocks them.
    pub cells: Vec<NavCell>,
    /// The islands beside it, in order: two, if it separates them now; one, if there is a path between its sides.
    pub islands: Vec<u32>,
}

impl NavGrid {
    /// Returns the doors in the way of walking agents, by joint.
    pub fn doors(&self) -> Vec<NavDoor> {
        (0..self.ground.doors.len()).map(|k| self.door(k)).collect()
    }

    fn door(&self, passage: usize) -> NavDoor {
        let openness = self.openness[passage];
        let mut islands: Vec<u32> = Vec::new();
        // Where an agent stands in front of the closed leaf, and a cell or two more for the grid's rounding.
        let reach = self.config.radius_m + 2.5 * self.config.cell_m;
        for (column, _) in &self.ground.doors[passage].closed_spans {
            for (beside, _) in columns_around(&self.ground.frame, *column as usize, reach) {
                let cells = self
                    .layers
                    .cells_of(beside)
                    .map(|cell| NavCell(cell as u32));
                let here = cells.filter(|cell| self.is_at_leaf_height(passage, *cell));
                islands.extend(here.filter_map(|cell| self.island(cell)));
            }
        }
        islands.sort_unstable();
        islands.dedup();
        NavDoor {
            joint: self.ground.doors[passage].joint,
            openness,
            is_open: is_passable(openness),
            cells: self.doorway(passage),
            islands,
        }
    }

    /// Returns whether an agent on `cell` is at the height of the door's leaf.
    fn is_at_leaf_height(&self, passage: usize, cell: NavCell) -> bool {
        let y = self.layers.height[cell.0 as usize];
        let leaf = &self.ground.doors[passage].closed_spans;
        leaf.iter()
            .any(|(_, span)| is_standing_blocked(std::slice::from_ref(span), y, &self.config))
    }

    /// Returns the walkable cells under the closed leaf of a door.
    fn doorway(&self, passage: usize) -> Vec<NavCell> {
        let mut cells = Vec::new();
        for (column, leaf) in &self.ground.doors[passage].closed_spans {
            for cell in self.layers.cells_of(*column as usize) {
                let y = self.layers.height[cell];
                let walkable = self.is_walkable(NavCell(cell as u32));
                if walkable && is_standing_blocked(std::slice::from_ref(leaf), y, &self.config) {
                    cells.push(NavCell(cell as u32));
                }
            }
        }
        cells.sort_unstable();
        cells.dedup();
        cells
    }

    /// Returns the closed doors that straight pieces between `corners` pass, in order.
    pub(super) fn closed_doors_along(&self, corners: &[NavCell]) -> Vec<JointId> {
        let crosses = |ends: &[NavCell]| {
            let crossing = self.straight_path_between(ends[0], ends[1]);
            crossing.is_some_and(|crossing| crossing.door_crossings > 0)
        };
        let mut passed: Vec<JointId> = Vec::new();
        for ends in corners.windows(2).filter(|ends| crosses(ends)) {
            let (a, b) = (self.position(ends[0]), self.position(ends[1]));
            let pieces = ((b - a).length() / (0.25 * self.config.cell_m))
                .ceil()
                .max(1.0) as usize;
            let mut met: Vec<(usize, JointId)> = Vec::new();
            for (k, passage) in self.ground.doors.iter().enumerate() {
                if is_passable(self.openness[k]) {
                    continue;
                }
                let doorway = self.doorway(k);
                let reach = self.config.cell_m;
                let at = (0..=pieces).find(|step| {
                    let point = a.lerp(b, *step as f32 / pieces as f32);
                    let near = |cell: &NavCell| {
                        let apart = self.position(*cell) - point;
                        apart.x.abs().max(apart.z.abs()) <= 0.5 * reach + 1e-4
                    };
                    doorway.iter().any(near)
                });
                met.extend(at.map(|step| (step, passage.joint)));
            }
            met.sort_unstable();
            for (_, joint) in met {
                if !passed.contains(&joint) {
                    passed.push(joint);
                }
            }
        }
        passed
    }
}
