//! Columns of space above the cells of a grid, and what fills them.

use crate::bounds::Aabb;
use glam::{Vec2, Vec3};

/// The grid seen from above, and for each cell the heights at which some triangle crosses its column.
#[derive(Clone, Debug)]
pub(super) struct Columns {
    pub(super) origin: Vec2,
    pub(super) cell_m: f32,
    /// Cells along x.
    pub(super) width: usize,
    /// Cells along z.
    pub(super) depth: usize,
    /// For each cell, disjoint `[low, high]` from below. Shape (depth, width).
    pub(super) spans: Vec<Vec<[f32; 2]>>,
}

impl Columns {
    /// Empty columns over `bounds`, one cell wider on every side.
    pub(super) fn new(bounds: &Aabb, cell_m: f32) -> Self {
        let size = bounds.size();
        let count = |length: f32| (length / cell_m).ceil() as usize + 2;
        let (width, depth) = (count(size.x), count(size.z));
        let origin = Vec2::new(bounds.min.x - cell_m, bounds.min.z - cell_m);
        Self {
            origin,
            cell_m,
            width,
            depth,
            spans: vec![Vec::new(); width * depth],
        }
    }

    /// Adds a triangle: its exact range of heights in every column it crosses, between `low_y` and `high_y`.
    pub(super) fn add_triangle(&mut self, corners: [Vec3; 3], low_y: f32, high_y: f32) {
        let bounds = Aabb::from_points(corners);
        if bounds.is_empty() || bounds.max.y < low_y || bounds.min.y > high_y {
            return;
        }
        let index = |value: f32, origin: f32, count: usize| {
            (((value - origin) / self.cell_m).floor().max(0.0) as usize).min(count - 1)
        };
        let (x0, x1) = (
            index(bounds.min.x, self.origin.x, self.width),
            index(bounds.max.x, self.origin.x, self.width),
        );
        let (z0, z1) = (
            index(bounds.min.z, self.origin.y, self.depth),
            index(bounds.max.z, self.origin.y, self.depth),
        );
        if x0 == x1 && z0 == z1 {
            // Most triangles of furniture.
            self.spans[z0 * self.width + x0].push([bounds.min.y, bounds.max.y]);
            return;
        }
        let triangle = Polygon::new(&corners);
        for z in z0..=z1 {
            let z_low = self.origin.y + z as f32 * self.cell_m;
            let row = if z0 == z1 {
                triangle
            } else {
                triangle.clipped(2, z_low, z_low + self.cell_m)
            };
            for x in x0..=x1 {
                let x_low = self.origin.x + x as f32 * self.cell_m;
                let inside = row.clipped(0, x_low, x_low + self.cell_m);
                if let Some(range) = inside.heights() {
                    self.spans[z * self.width + x].push(range);
                }
            }
        }
    }

    /// Sorts and joins the ranges of every column.
    pub(super) fn finish(&mut self) {
        for spans in &mut self.spans {
            spans.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
            let mut joined: Vec<[f32; 2]> = Vec::with_capacity(spans.len());
            for span in spans.iter() {
                match joined.last_mut() {
                    Some(last) if span[0] <= last[1] + 1e-3 => last[1] = last[1].max(span[1]),
                    _ => joined.push(*span),
                }
            }
            *spans = joined;
        }
    }
}

/// A convex polygon: a triangle cut by at most four planes has at most seven corners.
#[derive(Clone, Copy)]
struct Polygon {
    corners: [Vec3; 8],
    count: usize,
}

impl Polygon {
    fn new(corners: &[Vec3; 3]) -> Self {
        let mut polygon = Self {
            corners: [Vec3::ZERO; 8],
            count: 3,
        };
        polygon.corners[..3].copy_from_slice(corners);
        polygon
    }

    /// The part between two planes across an axis.
    fn clipped(&self, axis: usize, low: f32, high: f32) -> Self {
        self.half(axis, low, true).half(axis, high, false)
    }

    /// The part on one side of a plane across an axis (Sutherland and Hodgman, 1974).
    fn half(&self, axis: usize, at: f32, keep_above: bool) -> Self {
        let inside = |p: Vec3| {
            if keep_above {
                p[axis] >= at
            } else {
                p[axis] <= at
            }
        };
        let mut kept = Self {
            corners: [Vec3::ZERO; 8],
            count: 0,
        };
        for k in 0..self.count {
            let (a, b) = (
                self.corners[(k + self.count - 1) % self.count],
                self.corners[k],
            );
            if inside(a) != inside(b) {
                let t = ((at - a[axis]) / (b[axis] - a[axis])).clamp(0.0, 1.0);
                let mut crossing = a + (b - a) * t;
                crossing[axis] = at;
                kept.push(crossing);
            }
            if inside(b) {
                kept.push(b);
            }
        }
        kept
    }

    fn push(&mut self, corner: Vec3) {
        // Rounding cannot make more than eight corners of seven; one that did would change no height.
        if let Some(place) = self.corners.get_mut(self.count) {
            *place = corner;
            self.count += 1;
        }
    }

    /// The lowest and the highest corner's height; nothing when no corner is left.
    fn heights(&self) -> Option<[f32; 2]> {
        let heights = self.corners[..self.count].iter().map(|p| [p.y; 2]);
        heights.reduce(|[low, high], [y, _]| [low.min(y), high.max(y)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against dense sampling: every sampled point of random triangles lies in its column's range, and ranges are no
    /// wider than the samples show (within the sampling distance).
    #[test]
    fn ranges_equal_what_sampling_finds() {
        let mut stream = crate::random::Key::root(3).stream();
        for _ in 0..50 {
            let corner = |s: &mut crate::random::Stream| {
                Vec3::new(s.range(0.0, 1.0), s.range(0.0, 2.0), s.range(0.0, 1.0))
            };
            let corners = [
                corner(&mut stream),
                corner(&mut stream),
                corner(&mut stream),
            ];
            let mut columns = Columns::new(&Aabb::new(Vec3::ZERO, Vec3::new(1.0, 2.0, 1.0)), 0.25);
            columns.add_triangle(corners, -1.0, 3.0);
            columns.finish();
            let steps = 200;
            for i in 0..=steps {
                for j in 0..=steps - i {
                    let (u, v) = (i as f32 / steps as f32, j as f32 / steps as f32);
                    let p = corners[0] * (1.0 - u - v) + corners[1] * u + corners[2] * v;
                    let x = ((p.x - columns.origin.x) / 0.25) as usize;
                    let z = ((p.z - columns.origin.y) / 0.25) as usize;
                    let hit = columns.spans[z * columns.width + x]
                        .iter()
                        .any(|s| p.y >= s[0] - 1e-3 && p.y <= s[1] + 1e-3);
                    assert!(hit, "{p} in {:?}", columns.spans[z * columns.width + x]);
                }
            }
        }
    }
}
