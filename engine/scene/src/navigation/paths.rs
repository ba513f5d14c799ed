//! Shortest paths on the grid.

use super::grid::{Cell, NavGrid};
use glam::Vec3;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Geodesic distance from every cell to the nearest goal.
#[derive(Clone, Debug)]
pub struct DistanceField {
    /// m; infinite where no way leads. Shape (cell,).
    distance_m: Vec<f64>,
}

impl DistanceField {
    /// The distance of a cell, m; `None` where no way leads.
    pub fn at(&self, cell: Cell) -> Option<f64> {
        self.distance_m
            .get(cell.0 as usize)
            .copied()
            .filter(|d| d.is_finite())
    }
}

/// The eight cells around one: straight steps first.
const AROUND: [(isize, isize); 8] = [
    (1, 0),
    (-1, 0),
    (0, 1),
    (0, -1),
    (1, 1),
    (1, -1),
    (-1, 1),
    (-1, -1),
];

impl NavGrid {
    /// The cells one step away, with the length of that step over the ground, m. A diagonal needs both corners free.
    pub(super) fn neighbours(&self, cell: Cell) -> impl Iterator<Item = (Cell, f64)> + '_ {
        let (storey, x, z) = self.place(cell);
        let (width, depth) = (storey.columns.width, storey.columns.depth);
        let y = self.floor_y[cell.0 as usize];
        let edge = f64::from(self.config.cell_m);
        let step = self.config.step_m + 1e-4;
        let at = move |dx: isize, dz: isize| -> Option<Cell> {
            let (i, j) = (x.checked_add_signed(dx)?, z.checked_add_signed(dz)?);
            let next = Cell((storey.first + j * width + i) as u32);
            let free = i < width && j < depth && (self.floor_y[next.0 as usize] - y).abs() <= step;
            free.then_some(next)
        };
        AROUND.into_iter().filter_map(move |(dx, dz)| {
            let next = at(dx, dz)?;
            if dx != 0 && dz != 0 {
                at(dx, 0)?;
                at(0, dz)?;
                return Some((next, edge * std::f64::consts::SQRT_2));
            }
            Some((next, edge))
        })
    }

    /// Distances to the nearest of `goals` over the whole grid (Dijkstra).
    pub fn distance_field(&self, goals: &[Cell]) -> DistanceField {
        let mut distance_m = vec![f64::INFINITY; self.len()];
        let mut queue = BinaryHeap::new();
        for goal in goals.iter().filter(|goal| self.is_walkable(**goal)) {
            distance_m[goal.0 as usize] = 0.0;
            queue.push((Reverse(0_u64), *goal));
        }
        // Distances are at least 0, so that their bits sort as they do.
        while let Some((Reverse(bits), cell)) = queue.pop() {
            let here = f64::from_bits(bits);
            if here > distance_m[cell.0 as usize] {
                continue;
            }
            for (next, length) in self.neighbours(cell) {
                let there = here + length;
                if there < distance_m[next.0 as usize] {
                    distance_m[next.0 as usize] = there;
                    queue.push((Reverse(there.to_bits()), next));
                }
            }
        }
        DistanceField { distance_m }
    }

    /// The way down a distance field from `start` to its nearest goal, both included; `None` where no way leads.
    pub fn descend(&self, field: &DistanceField, start: Cell) -> Option<Vec<Cell>> {
        let mut here = start;
        let mut left = field.at(start)?;
        let mut way = vec![start];
        while left > 0.0 {
            let next = self
                .neighbours(here)
                .filter_map(|(cell, length)| Some((field.at(cell)? + length, cell)));
            let (_, cell) = next.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))?;
            let distance = field.at(cell)?;
            if distance >= left {
                return None;
            }
            (here, left) = (cell, distance);
            way.push(cell);
        }
        Some(way)
    }

    /// A shortest path between two walkable cells, both included.
    pub fn path(&self, start: Cell, goal: Cell) -> Option<Vec<Cell>> {
        self.descend(&self.distance_field(&[goal]), start)
    }

    /// Geodesic distance between two points, m: along the grid between their nearest cells (at most 0.5 m away).
    pub fn geodesic_m(&self, from: Vec3, to: Vec3) -> Option<f64> {
        let (start, goal) = (self.nearest(from, 0.5)?, self.nearest(to, 0.5)?);
        self.distance_field(&[goal]).at(start)
    }

    /// Whether the straight way between two cells stays on walkable cells without a step too high.
    pub fn is_straight_free(&self, from: Cell, to: Cell) -> bool {
        let (a, b) = (self.position(from), self.position(to));
        let pieces = ((b - a).length() / (self.config.cell_m * 0.25))
            .ceil()
            .max(1.0) as usize;
        let mut last = a.y;
        (0..=pieces).all(|k| {
            let point = a.lerp(b, k as f32 / pieces as f32);
            let reach = self.config.cell_m * 0.5 * std::f32::consts::SQRT_2 + self.config.step_m;
            let Some(cell) = self.nearest(Vec3::new(point.x, last, point.z), reach) else {
                return false;
            };
            let place = self.position(cell);
            let over = (place.x - point.x).abs().max((place.z - point.z).abs())
                <= self.config.cell_m * 0.5 + 1e-4;
            let steps = (place.y - last).abs() <= self.config.step_m + 1e-4;
            last = place.y;
            over && steps
        })
    }

    /// The corners of a path pulled tight: the fewest of its cells such that straight ways between them are free.
    pub fn corners(&self, path: &[Cell]) -> Vec<Cell> {
        let Some(&first) = path.first() else {
            return Vec::new();
        };
        let mut corners = vec![first];
        let mut from = 0;
        while from + 1 < path.len() {
            let mut to = from + 1;
            while to + 1 < path.len() && self.is_straight_free(path[from], path[to + 1]) {
                to += 1;
            }
            corners.push(path[to]);
            from = to;
        }
        corners
    }
}

#[cfg(test)]
mod tests {
    use crate::navigation::{Cell, NavConfig, NavGrid};
    use crate::{House, ShoeboxMaterials, State};
    use glam::Vec3;

    fn room() -> (House, State, NavGrid) {
        let house = House::shoebox([4.0, 2.5, 3.0], &ShoeboxMaterials::default()).unwrap();
        let state = State::new(&house);
        let grid = NavGrid::build(&house, &state, &NavConfig::default()).unwrap();
        (house, state, grid)
    }

    #[test]
    fn an_empty_room_is_walkable_up_to_the_radius_from_its_walls() {
        let (_, _, grid) = room();
        for cell in grid.walkable() {
            let p = grid.position(cell);
            if grid.island(cell) == Some(0) && p.y < 0.1 {
                assert!(p.x > 0.2 && p.x < 3.8 && p.z > 0.2 && p.z < 2.8, "{p}");
            }
        }
        let floor = grid
            .walkable()
            .filter(|cell| grid.position(*cell).y.abs() < 1e-3)
            .count();
        // 36 by 26 middles lie further than the radius from the walls; a wall on a cell's border may count to either side.
        assert!((34 * 24..=36 * 26).contains(&floor), "{floor} cells");
    }

    #[test]
    fn distances_equal_those_of_repeated_relaxation() {
        let (_, _, grid) = room();
        let goal = grid.nearest(Vec3::new(1.0, 0.0, 1.0), 0.3).unwrap();
        let field = grid.distance_field(&[goal]);
        // Bellman and Ford: relax every edge until nothing changes.
        let mut slow = vec![f64::INFINITY; grid.len()];
        slow[goal.0 as usize] = 0.0;
        loop {
            let mut changed = false;
            for cell in grid.walkable() {
                for (next, length) in grid.neighbours(cell) {
                    let through = slow[next.0 as usize] + length;
                    if through < slow[cell.0 as usize] {
                        slow[cell.0 as usize] = through;
                        changed = true;
                    }
                }
            }
            if !changed {
                break;
            }
        }
        for (k, expected) in slow.iter().enumerate() {
            let found = field.at(Cell(k as u32)).unwrap_or(f64::INFINITY);
            assert!(
                found == *expected || (found - expected).abs() < 1e-9,
                "cell {k}: {found} {expected}"
            );
        }
        let far = grid.nearest(Vec3::new(3.0, 0.0, 2.0), 0.3).unwrap();
        let way = grid.path(far, goal).unwrap();
        assert_eq!((way.first(), way.last()), (Some(&far), Some(&goal)));
        assert_eq!(grid.corners(&way).len(), 2);
    }
}
