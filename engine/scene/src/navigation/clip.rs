//! Clipping of triangles to columns.

use glam::Vec3;

/// A convex polygon: a triangle cut by at most four planes has at most seven corners.
#[derive(Clone, Copy)]
pub(super) struct ClipPolygon {
    corners: [Vec3; 8],
    count: usize,
}

impl ClipPolygon {
    pub(super) fn new(corners: &[Vec3; 3]) -> Self {
        let mut polygon = Self {
            corners: [Vec3::ZERO; 8],
            count: 3,
        };
        polygon.corners[..3].copy_from_slice(corners);
        polygon
    }

    /// Returns the part between two planes across an axis.
    pub(super) fn clipped(&self, axis: usize, low: f32, high: f32) -> Self {
        self.half(axis, low, true).half(axis, high, false)
    }

    /// Returns the part on one side of a plane across an axis.
    ///
    /// # Source
    /// I. E. Sutherland and G. W. Hodgman, Communications of the ACM 17, 32 (1974).
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

    /// Returns the lowest and the highest corner's height; `None` when no corner is left.
    pub(super) fn heights(&self) -> Option<[f32; 2]> {
        let heights = self.corners[..self.count].iter().map(|p| [p.y; 2]);
        heights.reduce(|[low, high], [y, _]| [low.min(y), high.max(y)])
    }
}
