//! Walkable surfaces above each other in the columns, and their connections.

use super::config::NavConfig;
use super::heightfield::{GridFrame, HeightSpan};
use super::static_grid::{columns_around, standing_heights};
use crate::interrupt::{self, CancelPoller};
use glam::Vec3;

/// Surfaces between checks for cancellation.
const SURFACES_PER_CHECK: usize = 1 << 14;

/// No cell.
pub(super) const NO_CELL: u32 = u32::MAX;

/// A surface with clearance for the agent.
pub(super) const FREE: u8 = 1;
/// A free surface on a floor of the house.
pub(super) const ON_FLOOR: u8 = 2;
/// A free surface in a room, at most half a metre above its floor.
pub(super) const INDOORS: u8 = 4;
/// A surface under the leaf of a closed door that can be opened at a price.
pub(super) const DOORWAY: u8 = 8;

/// The columns beside one: east (+x), west, south (+z), north. Opposite directions differ in the last bit.
pub(super) const EAST: usize = 0;
pub(super) const WEST: usize = 1;
pub(super) const SOUTH: usize = 2;
pub(super) const NORTH: usize = 3;

/// Surfaces in layers: the lowest of each column in layer 0, the next one above it in layer 1, and so on. The number of a
/// surface is `layer * columns + column`, so that a column that changes renumbers no other.
#[derive(Clone, Debug, Default)]
pub(super) struct SurfaceLayers {
    /// Number of columns.
    pub(super) columns: usize,
    /// m; NaN where a column has no such layer. Shape (cell,).
    pub(super) height: Vec<f32>,
    /// [`FREE`] and so on.
    pub(super) flags: Vec<u8>,
    /// The free surfaces one step away in the four directions, [`NO_CELL`] without one. Links are mutual.
    pub(super) links: Vec<[u32; 4]>,
    /// Number of surfaces in each layer.
    used: Vec<usize>,
}

impl SurfaceLayers {
    pub(super) fn new(columns: usize) -> Self {
        Self {
            columns,
            ..Self::default()
        }
    }

    /// The surfaces of a column, from below.
    pub(super) fn cells_of(&self, column: usize) -> impl Iterator<Item = usize> + '_ {
        (0..self.used.len())
            .map(move |layer| layer * self.columns + column)
            .take_while(|cell| !self.height[*cell].is_nan())
    }

    /// Returns whether a surface is free.
    pub(super) fn is_free(&self, cell: usize) -> bool {
        self.flags[cell] & FREE != 0
    }

    /// Writes the heights at which the agent can stand upright in a column.
    pub(super) fn set_standing_heights(
        &mut self,
        column: usize,
        spans: &[HeightSpan],
        config: &NavConfig,
    ) {
        let mut heights = standing_heights(spans, config);
        let mut layer = 0;
        loop {
            let height = heights.next();
            if layer == self.used.len() {
                if height.is_none() {
                    break;
                }
                let len = (layer + 1) * self.columns;
                self.height.resize(len, f32::NAN);
                self.flags.resize(len, 0);
                self.links.resize(len, [NO_CELL; 4]);
                self.used.push(0);
            }
            let cell = layer * self.columns + column;
            self.used[layer] += usize::from(height.is_some());
            self.used[layer] -= usize::from(!self.height[cell].is_nan());
            self.height[cell] = height.unwrap_or(f32::NAN);
            self.flags[cell] = 0;
            self.links[cell] = [NO_CELL; 4];
            layer += 1;
        }
    }

    /// Drops empty layers at the top, so that the numbers depend on the present surfaces and not on earlier ones.
    pub(super) fn drop_empty_top_layers(&mut self) {
        while self.used.last() == Some(&0) {
            self.used.pop();
        }
        let len = self.used.len() * self.columns;
        self.height.truncate(len);
        self.flags.truncate(len);
        self.links.truncate(len);
    }

    /// Returns whether the agent has clearance on a surface: within its radius nothing stands between a step and its height
    /// above it, unless it gets up there step by step within that radius, as on stairs and slopes.
    pub(super) fn has_clearance<'a>(
        &self,
        cell: usize,
        frame: &GridFrame,
        config: &NavConfig,
        spans_at: impl Fn(usize) -> &'a [HeightSpan],
    ) -> bool {
        let (column, y) = (cell % self.columns, self.height[cell]);
        let (low, high) = (y + config.step_m, y + config.height_m);
        // The columns with something in the way, and the surface above it.
        let mut above: Vec<usize> = Vec::new();
        for (beside, _) in columns_around(frame, column, config.radius_m) {
            let in_the_way = |span: &&HeightSpan| span.high > low && span.low < high;
            let Some(last) = spans_at(beside).iter().rfind(in_the_way) else {
                continue;
            };
            let on_top = self
                .cells_of(beside)
                .find(|other| self.height[*other] == last.high);
            match on_top {
                Some(other) => above.push(other),
                None => return false,
            }
        }
        above.is_empty() || self.reaches_all(cell, frame, config, above)
    }

    /// Returns whether all of `goals` can be reached from `cell` by steps within the radius.
    fn reaches_all(
        &self,
        cell: usize,
        frame: &GridFrame,
        config: &NavConfig,
        mut goals: Vec<usize>,
    ) -> bool {
        let disk: Vec<usize> = columns_around(frame, cell % self.columns, config.radius_m)
            .map(|(column, _)| column)
            .collect();
        let mut reached = vec![cell];
        let mut next = 0;
        while let Some(&here) = reached.get(next) {
            next += 1;
            goals.retain(|goal| *goal != here);
            if goals.is_empty() {
                return true;
            }
            for way in 0..4 {
                let Some(column) = neighbour_column(frame, here % self.columns, way) else {
                    continue;
                };
                // Offsets are in order of z, then x, and so are column numbers.
                if disk.binary_search(&column).is_err() {
                    continue;
                }
                if let Some(there) = self.step_into(column, self.height[here], config, |_| true)
                    && !reached.contains(&there)
                {
                    reached.push(there);
                }
            }
        }
        false
    }

    /// Returns the allowed surface of a column that is nearest in height to `y`, no more than a step away; the lower of two.
    fn step_into(
        &self,
        column: usize,
        y: f32,
        config: &NavConfig,
        allowed: impl Fn(usize) -> bool,
    ) -> Option<usize> {
        let step = config.step_m + 1e-4;
        self.cells_of(column)
            .filter(|cell| allowed(*cell))
            .map(|cell| ((self.height[cell] - y).abs(), cell))
            .filter(|(apart, _)| *apart <= step)
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, cell)| cell)
    }

    /// Links the free surfaces of a column with those beside it, each with the nearest in height if that holds both ways.
    pub(super) fn link(&mut self, column: usize, frame: &GridFrame, config: &NavConfig) {
        let cells: Vec<usize> = self.cells_of(column).collect();
        for cell in cells {
            let mut links = [NO_CELL; 4];
            if self.is_free(cell) {
                for (way, link) in links.iter_mut().enumerate() {
                    let Some(column_there) = neighbour_column(frame, column, way) else {
                        continue;
                    };
                    let free = |cell: usize| self.is_free(cell);
                    let there = self.step_into(column_there, self.height[cell], config, free);
                    if let Some(there) = there
                        && self.step_into(column, self.height[there], config, free) == Some(cell)
                    {
                        *link = there as u32;
                    }
                }
            }
            self.links[cell] = links;
        }
    }

    /// Numbers connected surfaces, keeping only those connected with a floor of the house: no beds, no tops of walls. First
    /// comes the island with most surfaces in rooms, then the largest. Shape (cell,); [`NO_CELL`] where an agent cannot
    /// stand.
    pub(super) fn islands(&self) -> Vec<u32> {
        let mut island = vec![NO_CELL; self.height.len()];
        let mut found: Vec<(usize, usize, bool)> = Vec::new();
        let mut stack = Vec::new();
        let mut pace = CancelPoller::new(SURFACES_PER_CHECK);
        for start in 0..self.height.len() {
            if island[start] != NO_CELL || !self.is_free(start) {
                continue;
            }
            interrupt::unwind_if_cancelled();
            let label = found.len() as u32;
            let (mut indoors, mut size, mut kept) = (0, 0, false);
            island[start] = label;
            stack.push(start as u32);
            while let Some(cell) = stack.pop() {
                pace.count_one();
                let flags = self.flags[cell as usize];
                indoors += usize::from(flags & INDOORS != 0);
                kept |= flags & ON_FLOOR != 0;
                size += 1;
                for there in self.links[cell as usize] {
                    if there != NO_CELL && island[there as usize] == NO_CELL {
                        island[there as usize] = label;
                        stack.push(there);
                    }
                }
            }
            found.push((indoors, size, kept));
        }
        let mut order: Vec<usize> = (0..found.len()).filter(|k| found[*k].2).collect();
        order.sort_by_key(|k| (std::cmp::Reverse((found[*k].0, found[*k].1)), *k));
        let mut rank = vec![NO_CELL; found.len()];
        for (new, old) in order.into_iter().enumerate() {
            rank[old] = new as u32;
        }
        for label in island.iter_mut().filter(|label| **label != NO_CELL) {
            *label = rank[*label as usize];
        }
        island
    }
}

/// The column beside one in a direction.
pub(super) fn neighbour_column(frame: &GridFrame, column: usize, way: usize) -> Option<usize> {
    let x = column % frame.width;
    match way {
        EAST => (x + 1 < frame.width).then(|| column + 1),
        WEST => (x > 0).then(|| column - 1),
        SOUTH => Some(column + frame.width).filter(|there| *there < frame.count()),
        _ => column.checked_sub(frame.width),
    }
}

/// The middle of a surface, m.
pub(super) fn column_centre(frame: &GridFrame, column: usize, y: f32) -> Vec3 {
    let along = |k: usize| (k as f32 + 0.5) * frame.cell_m;
    Vec3::new(
        frame.origin.x + along(column % frame.width),
        y,
        frame.origin.y + along(column / frame.width),
    )
}
