//! Shortened paths.

use super::grid::{NavCell, NavGrid};
use crate::ids::JointId;
use glam::Vec3;

/// Look-ahead on a path for straight pieces, in its cells: some 20 m in cells of 0.1 m.
const LOOK_AHEAD: usize = 64;
/// Most passes over all corners; a few suffice in houses.
const MOST_ROUNDS: usize = 32;
/// Largest distance of a point from a cell to be on the grid, m.
const NEAR_M: f32 = 0.5;

/// A path through a house, shortened to straight pieces.
#[derive(Clone, Debug, PartialEq)]
pub struct Route {
    /// Its corners on the ground, from the cell nearest to the start to the one nearest to the goal, m. Straight lines
    /// between them are free.
    pub points: Vec<Vec3>,
    /// Its length over the ground, m.
    pub length_m: f64,
    /// The doors that are not open and must be opened on the way, in order; only under
    /// [`Doors::Priced`](super::DoorPolicy::Priced).
    pub shut_doors: Vec<JointId>,
}

impl NavGrid {
    /// Returns the shortest path between two points, between their nearest cells (at most 0.5 m away), shortened to
    /// straight pieces; `None` off the grid or without a path.
    ///
    /// It is never shorter than the shortest path over the walkable cells; its corners lie on the middles of cells, and it
    /// passes obstacles on the side that [`DistanceField`](super::DistanceField) finds shortest.
    pub fn route(&self, from: Vec3, to: Vec3) -> Option<Route> {
        let (start, goal) = (self.nearest(from, NEAR_M)?, self.nearest(to, NEAR_M)?);
        let corners = self.corners(&self.path(start, goal)?);
        let points: Vec<Vec3> = corners.iter().map(|cell| self.position(*cell)).collect();
        let pieces = corners
            .windows(2)
            .filter_map(|ends| self.straight_path_between(ends[0], ends[1]));
        Some(Route {
            // A sum of nothing is -0.
            length_m: pieces.fold(0.0, |sum, piece| sum + piece.length_m),
            shut_doors: self.closed_doors_along(&corners),
            points,
        })
    }

    /// Returns the geodesic distance between two points, m: the length of [`NavGrid::route`].
    pub fn geodesic_m(&self, from: Vec3, to: Vec3) -> Option<f64> {
        self.route(from, to).map(|route| route.length_m)
    }

    /// Returns the corners of a shortened path: the cheapest choice of its cells such that straight lines between them are
    /// free, then each moved from cell to cell as long as that shortens the path.
    pub fn corners(&self, path: &[NavCell]) -> Vec<NavCell> {
        let mut corners = self.shortcut_path(path);
        for _ in 0..MOST_ROUNDS {
            if !self.tighten(&mut corners) {
                break;
            }
            corners = self.shortcut_path(&corners);
        }
        corners
    }

    /// Returns the cheapest path from the first to the last cell by straight pieces between its cells.
    fn shortcut_path(&self, path: &[NavCell]) -> Vec<NavCell> {
        let Some(last) = path.len().checked_sub(1) else {
            return Vec::new();
        };
        // The cost of each cell of the path from the first one, and the cell before it.
        let mut best = vec![(f64::INFINITY, 0_usize); path.len()];
        best[0].0 = 0.0;
        for k in 0..last {
            for next in k + 1..=last.min(k + LOOK_AHEAD) {
                if let Some(crossing) = self.straight_path_between(path[k], path[next]) {
                    let cost = best[k].0 + self.cost_m(&crossing);
                    // A tiny gain does not make a corner.
                    if cost < best[next].0 - 1e-9 || best[next].0.is_infinite() {
                        best[next] = (cost, k);
                    }
                }
            }
        }
        let mut chosen = vec![path[last]];
        let mut here = last;
        while here > 0 {
            here = if best[here].0.is_finite() {
                best[here].1
            } else {
                // Not a path of this grid: keep its cells as they are.
                here - 1
            };
            chosen.push(path[here]);
        }
        chosen.reverse();
        chosen
    }

    /// Moves each inner corner to the cell beside it that shortens the path most. Returns whether one moved.
    fn tighten(&self, corners: &mut [NavCell]) -> bool {
        let mut moved = false;
        for k in 1..corners.len().saturating_sub(1) {
            let (before, after) = (corners[k - 1], corners[k + 1]);
            let cost = |cell: NavCell| {
                let to = self.straight_path_between(before, cell)?;
                let on = self.straight_path_between(cell, after)?;
                Some(self.cost_m(&to) + self.cost_m(&on))
            };
            let Some(now) = cost(corners[k]) else {
                continue;
            };
            let around = (-1..=1).flat_map(|dz| (-1..=1).map(move |dx| (dx, dz)));
            let best = around
                .filter_map(|(dx, dz)| self.straight_path_to_offset(corners[k], dx, dz))
                .filter_map(|crossing| Some((cost(crossing.to)?, crossing.to)))
                .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            if let Some((cost, cell)) = best
                && cost < now - 1e-9
            {
                corners[k] = cell;
                moved = true;
            }
        }
        moved
    }
}
