//! Columns of space above the cells of a grid, and their solid spans.

use super::clip::ClipPolygon;
use super::config::NavConfig;
use crate::bounds::Aabb;
use crate::interrupt::CancelPoller;
use crate::math;
use glam::{Vec2, Vec3};

/// Surfaces closer than this in height are one, m.
const TOUCHING_M: f32 = 1e-3;
/// Columns between checks for cancellation.
const COLUMNS_PER_CHECK: usize = 1 << 12;

/// A solid span of a column between two heights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct HeightSpan {
    pub(super) low: f32,
    pub(super) high: f32,
    /// The highest point of its triangles that are flat enough to walk on; minus infinity without one.
    pub(super) walkable_height: f32,
}

impl HeightSpan {
    const NONE: Self = Self {
        low: 0.0,
        high: 0.0,
        walkable_height: f32::NEG_INFINITY,
    };
}

/// Sorts spans and joins those that touch. The result depends on the set of them only, and joining joined spans again
/// changes nothing.
pub(super) fn merge_spans(spans: &mut Vec<HeightSpan>) {
    let kept = merge_spans_in_place(spans);
    spans.truncate(kept);
}

/// As [`merge_spans`]; the joined spans come first, and their number is returned.
fn merge_spans_in_place(spans: &mut [HeightSpan]) -> usize {
    spans.sort_by(|a, b| a.low.total_cmp(&b.low).then(a.high.total_cmp(&b.high)));
    let mut kept = 0_usize;
    for k in 0..spans.len() {
        let span = spans[k];
        match kept.checked_sub(1).map(|last| &mut spans[last]) {
            Some(last) if span.low <= last.high + TOUCHING_M => {
                last.high = last.high.max(span.high);
                last.walkable_height = last.walkable_height.max(span.walkable_height);
            }
            _ => {
                spans[kept] = span;
                kept += 1;
            }
        }
    }
    kept
}

/// The grid seen from above.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct GridFrame {
    /// The corner of column 0 at the lowest x and z, m.
    pub(super) origin: Vec2,
    pub(super) cell_m: f32,
    /// Columns along x.
    pub(super) width: usize,
    /// Columns along z.
    pub(super) depth: usize,
    /// The range of heights, m; geometry wholly below or above it is left out.
    heights: [f32; 2],
    /// Cosine of the steepest slope to walk on.
    flat: f32,
}

impl GridFrame {
    /// A frame over `bounds`, one cell wider on every side; without columns over an empty box.
    pub(super) fn new(bounds: &Aabb, heights: [f32; 2], config: &NavConfig) -> Self {
        let size = bounds.size();
        let count = |length: f32| {
            let cells = (length / config.cell_m).ceil() as usize + 2;
            if bounds.is_empty() { 0 } else { cells }
        };
        Self {
            origin: Vec2::new(bounds.min.x - config.cell_m, bounds.min.z - config.cell_m),
            cell_m: config.cell_m,
            width: count(size.x),
            depth: count(size.z),
            heights,
            // A slope of exactly that angle counts as flat.
            flat: math::cos(config.max_slope_rad) - 1e-4,
        }
    }

    /// The number of columns.
    pub(super) fn count(&self) -> usize {
        self.width * self.depth
    }

    /// Returns the columns that a range of coordinates along one axis touches; empty outside the grid.
    fn touched(&self, low: f32, high: f32, origin: f32, count: usize) -> std::ops::Range<usize> {
        let index = |value: f32| ((value - origin) / self.cell_m).floor();
        let first = index(low).max(0.0);
        let last = index(high).min(count as f32 - 1.0);
        if first > last {
            0..0
        } else {
            first as usize..last as usize + 1
        }
    }

    /// Calls `found` for every column that a triangle crosses, with its exact range of heights there.
    pub(super) fn rasterize_triangle(
        &self,
        corners: [Vec3; 3],
        mut found: impl FnMut(usize, HeightSpan),
    ) {
        let bounds = Aabb::from_points(corners);
        let [low, high] = self.heights;
        if bounds.is_empty() || bounds.max.y < low || bounds.min.y > high {
            return;
        }
        let xs = self.touched(bounds.min.x, bounds.max.x, self.origin.x, self.width);
        let zs = self.touched(bounds.min.z, bounds.max.z, self.origin.y, self.depth);
        if xs.is_empty() || zs.is_empty() {
            return;
        }
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        let is_flat = normal.y.abs() >= self.flat * normal.length();
        let span = |[low, high]: [f32; 2]| HeightSpan {
            low,
            high,
            walkable_height: if is_flat { high } else { f32::NEG_INFINITY },
        };
        let inside = |low: f32, high: f32, origin: f32, count: usize| {
            low >= origin && high <= origin + count as f32 * self.cell_m
        };
        if xs.len() == 1
            && zs.len() == 1
            && inside(bounds.min.x, bounds.max.x, self.origin.x, self.width)
            && inside(bounds.min.z, bounds.max.z, self.origin.y, self.depth)
        {
            // Fast path: most triangles of furniture lie in one column.
            found(
                zs.start * self.width + xs.start,
                span([bounds.min.y, bounds.max.y]),
            );
            return;
        }
        let triangle = ClipPolygon::new(&corners);
        // The floor of a hall is two triangles.
        let mut pace = CancelPoller::new(COLUMNS_PER_CHECK);
        for z in zs {
            let z_low = self.origin.y + z as f32 * self.cell_m;
            let row = triangle.clipped(2, z_low, z_low + self.cell_m);
            for x in xs.clone() {
                pace.count_one();
                let x_low = self.origin.x + x as f32 * self.cell_m;
                let piece = row.clipped(0, x_low, x_low + self.cell_m);
                if let Some(range) = piece.heights() {
                    found(z * self.width + x, span(range));
                }
            }
        }
    }
}

/// The spans of all columns, one column after the other.
#[derive(Clone, Debug, Default)]
pub(super) struct Heightfield {
    /// Offset of each column, and the end. Shape (column + 1,).
    first: Vec<u32>,
    spans: Vec<HeightSpan>,
}

impl Heightfield {
    /// Joins the spans of each of `count` columns; `raw`: columns and spans in any order.
    pub(super) fn new(count: usize, raw: &[(u32, HeightSpan)]) -> Self {
        let mut pace = CancelPoller::new(COLUMNS_PER_CHECK);
        // Sorted by counting.
        let mut ends = vec![0_usize; count + 1];
        for (column, _) in raw {
            pace.count_one();
            ends[*column as usize + 1] += 1;
        }
        for column in 0..count {
            ends[column + 1] += ends[column];
        }
        let mut spans = vec![HeightSpan::NONE; raw.len()];
        // Next free place of each column: in the end, where the column ends.
        for (column, span) in raw {
            pace.count_one();
            let next = &mut ends[*column as usize];
            spans[*next] = *span;
            *next += 1;
        }
        let mut first = Vec::with_capacity(count + 1);
        let (mut start, mut kept) = (0, 0);
        for end in &ends[..count] {
            pace.count_one();
            first.push(kept as u32);
            let joined = merge_spans_in_place(&mut spans[start..*end]);
            spans.copy_within(start..start + joined, kept);
            kept += joined;
            start = *end;
        }
        first.push(kept as u32);
        spans.truncate(kept);
        spans.shrink_to_fit();
        Self { first, spans }
    }

    /// Returns the spans of a column, from below.
    pub(super) fn at(&self, column: usize) -> &[HeightSpan] {
        &self.spans[self.first[column] as usize..self.first[column + 1] as usize]
    }

    /// Returns whether all columns are empty.
    pub(super) fn is_empty(&self) -> bool {
        self.spans.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interrupt::interruptible;
    use crate::random::{RandomKey, RandomStream};

    fn frame() -> GridFrame {
        let bounds = Aabb::new(Vec3::ZERO, Vec3::new(1.0, 2.0, 1.0));
        let config = NavConfig {
            cell_m: 0.25,
            ..NavConfig::default()
        };
        GridFrame::new(&bounds, [-1.0, 3.0], &config)
    }

    /// Against dense sampling: every sampled point of random triangles lies in its column's range.
    #[test]
    fn ranges_equal_what_sampling_finds() {
        let mut stream = RandomKey::root(3).stream();
        for _ in 0..50 {
            let corner = |s: &mut RandomStream| {
                Vec3::new(s.range(0.0, 1.0), s.range(0.0, 2.0), s.range(0.0, 1.0))
            };
            let corners = [
                corner(&mut stream),
                corner(&mut stream),
                corner(&mut stream),
            ];
            let frame = frame();
            let mut raw = Vec::new();
            frame.rasterize_triangle(corners, |column, span| raw.push((column as u32, span)));
            let columns = Heightfield::new(frame.count(), &raw);
            let steps = 200;
            for i in 0..=steps {
                for j in 0..=steps - i {
                    let (u, v) = (i as f32 / steps as f32, j as f32 / steps as f32);
                    let p = corners[0] * (1.0 - u - v) + corners[1] * u + corners[2] * v;
                    let x = ((p.x - frame.origin.x) / 0.25) as usize;
                    let z = ((p.z - frame.origin.y) / 0.25) as usize;
                    let spans = columns.at(z * frame.width + x);
                    let hit = spans
                        .iter()
                        .any(|s| p.y >= s.low - 1e-3 && p.y <= s.high + 1e-3);
                    assert!(hit, "{p} in {spans:?}");
                }
            }
        }
    }

    #[test]
    fn the_columns_of_one_large_triangle_can_be_stopped() {
        let bounds = Aabb::new(Vec3::ZERO, Vec3::new(400.0, 3.0, 400.0));
        let frame = GridFrame::new(&bounds, [-0.5, f32::INFINITY], &NavConfig::default());
        let corner = |x: f32, z: f32| Vec3::new(x, 0.0, z);
        let floor = [corner(0.0, 0.0), corner(400.0, 0.0), corner(0.0, 400.0)];
        let mut columns = 0;
        let stopped = interruptible(
            || true,
            || {
                frame.rasterize_triangle(floor, |_, _| columns += 1);
            },
        );
        assert!(stopped.is_err() && columns < frame.count() / 2, "{columns}");
    }

    #[test]
    fn what_lies_outside_fills_no_column() {
        let frame = frame();
        let beside = [
            Vec3::new(9.0, 0.0, 0.5),
            Vec3::new(9.1, 0.0, 0.5),
            Vec3::new(9.0, 1.0, 0.6),
        ];
        frame.rasterize_triangle(beside, |column, _| panic!("column {column}"));
        let above = beside.map(|p| p + Vec3::new(-8.5, 9.0, 0.0));
        frame.rasterize_triangle(above, |column, _| panic!("column {column}"));
    }

    #[test]
    fn columns_hold_what_fills_them_in_whatever_order_it_comes() {
        let mut stream = RandomKey::root(5).stream();
        let span = |stream: &mut RandomStream| {
            let low = stream.range(0.0, 3.0);
            let high = low + stream.range(0.0, 0.5);
            let flat = high - stream.range(0.0, 0.1);
            HeightSpan {
                low,
                high,
                walkable_height: flat,
            }
        };
        let count = 9;
        // The first and the last column stay empty.
        let raw: Vec<(u32, HeightSpan)> = (0..60)
            .map(|_| (1 + stream.below(count - 2) as u32, span(&mut stream)))
            .collect();
        let columns = Heightfield::new(count, &raw);
        for column in 0..count {
            let own = raw.iter().filter(|(at, _)| *at as usize == column);
            let mut own: Vec<HeightSpan> = own.map(|(_, span)| *span).collect();
            merge_spans(&mut own);
            assert_eq!(columns.at(column), own, "{column}");
        }
        let backwards: Vec<(u32, HeightSpan)> = raw.into_iter().rev().collect();
        let again = Heightfield::new(count, &backwards);
        assert_eq!((again.first, again.spans), (columns.first, columns.spans));
        assert!(Heightfield::new(0, &[]).is_empty() && Heightfield::new(3, &[]).at(2).is_empty());
    }

    #[test]
    fn joining_in_parts_equals_joining_at_once() {
        let mut stream = RandomKey::root(8).stream();
        for _ in 0..200 {
            let mut all: Vec<HeightSpan> = (0..12)
                .map(|_| {
                    let low = stream.range(0.0, 3.0);
                    let high = low + stream.range(0.0, 0.3);
                    HeightSpan {
                        low,
                        high,
                        walkable_height: high - 0.1,
                    }
                })
                .collect();
            let mut parts = all[..5].to_vec();
            merge_spans(&mut parts);
            parts.extend_from_slice(&all[5..]);
            merge_spans(&mut parts);
            merge_spans(&mut all);
            assert_eq!(parts, all);
        }
    }
}
