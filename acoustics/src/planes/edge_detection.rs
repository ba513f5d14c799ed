//! Detection of the sharp edges of triangles.

use super::disjoint_sets::DisjointSets;
use super::edges::DiffractionEdge;
use super::{NO_PLANE, TRIANGLES_PER_CHECK};
use dwell_scene::interrupt::{self, CancelPoller};
use glam::{DVec3, Vec3};
use std::collections::HashMap;
use std::f32::consts::{PI, TAU};

/// Cell size of the grid in which equal corners are merged, m.
const WELD_M: f32 = 1e-4;
/// Shortest edge that diffracts, m.
const SHORTEST_M: f32 = 0.2;
/// Angle of a fold below which an edge counts as smooth, rad: 30 degrees.
const LEAST_FOLD_RAD: f32 = PI / 6.0;
/// Distance beside an edge at which its plane is looked for, m.
const BESIDE_M: f32 = 5e-3;
/// Largest bend of consecutive pieces of a straight edge: the cosine of 1 degree.
const STRAIGHT: f32 = 0.999_85;

/// Distance within which rims coincide, m.
const ON_LINE_M: f32 = 2e-3;
/// Size of the cells into which rims are sorted by points half a cell apart, m.
const CELL_M: f32 = 0.5;
/// Search radius around each of these points for its rim, m: so that none of its points is missed.
const PADDING_M: f32 = 0.25 * CELL_M + ON_LINE_M;

/// Sides that are sorted between checks for cancellation.
const SIDES_PER_CHECK: usize = 1 << 14;

/// A side of a triangle.
struct TriangleSide {
    key: [[i32; 3]; 2],
    ends: [Vec3; 2],
    plane: u32,
    /// From the edge into the triangle, unit length, perpendicular to the edge.
    into: Vec3,
}

fn weld(point: Vec3) -> [i32; 3] {
    (point / WELD_M).round().to_array().map(|x| x as i32)
}

/// A straight line that bounds a face.
struct FaceBoundarySegment {
    ends: [Vec3; 2],
    /// From the line into the face, unit length, perpendicular to the line.
    into: Vec3,
}

/// Returns the sharp edges of triangles that lie in planes.
///
/// A side that two triangles share, or that lies within another triangle of its plane (a T-junction), is no rim. Rims that
/// coincide are one edge, however their triangles are cut. A rim that lies within a face of another plane counts as that of
/// a sheet: rays later determine whether it is exposed.
///
/// # Determinism
/// Equal input, equal output.
pub(super) fn find_edges(corners: &[[Vec3; 3]], of_triangle: &[u32]) -> Vec<DiffractionEdge> {
    let kept = at_most_two_duplicates(corners);
    let of_triangle: Vec<u32> = kept.iter().map(|k| of_triangle[*k]).collect();
    let corners: Vec<[Vec3; 3]> = kept.into_iter().map(|k| corners[k]).collect();
    let sides = sides(&corners, &of_triangle);
    let cover = PlaneCoverage::new(&corners, &of_triangle);
    let (mut rims, mut edges) = (Vec::new(), Vec::new());
    let mut pace = CancelPoller::new(TRIANGLES_PER_CHECK);
    for group in sides.chunk_by(|a, b| a.key == b.key) {
        let folds = |side: &TriangleSide| {
            let mut others = group.iter();
            !others.any(|other| other.plane == side.plane && other.into.dot(side.into) < 0.0)
        };
        let open = group.iter().filter(|side| {
            pace.count_one();
            folds(side) && !cover.is_covered_beyond(side)
        });
        let into: Vec<Vec3> = open.map(|side| side.into).collect();
        let ends = group[0].ends;
        match into[..] {
            [] => {}
            // Its other faces may be cut elsewhere.
            [into] => rims.push(FaceBoundarySegment { ends, into }),
            _ => edges.extend(widest_gap(&ends, &into)),
        }
    }
    edges.extend(edges_from_face_boundaries(&rims));
    merge(&edges)
}

/// Returns the triangles to test: of equal ones the first two. Whether a side is shared or open needs no third, and
/// thousands of coincident objects are not compared with each other.
fn at_most_two_duplicates(corners: &[[Vec3; 3]]) -> Vec<usize> {
    let mut counts: HashMap<[[u32; 3]; 3], u8> = HashMap::with_capacity(corners.len());
    let mut kept = Vec::with_capacity(corners.len());
    for (k, triangle) in corners.iter().enumerate() {
        let count = counts
            .entry(triangle.map(|p| p.to_array().map(f32::to_bits)))
            .or_default();
        if *count < 2 {
            *count += 1;
            kept.push(k);
        }
    }
    kept
}

/// Returns the edges formed by rims.
fn edges_from_face_boundaries(rims: &[FaceBoundarySegment]) -> Vec<DiffractionEdge> {
    let cells = |point: Vec3| {
        let corners = (0..8).map(move |k| {
            let side = |axis: i32| {
                if k >> axis & 1 == 0 {
                    -PADDING_M
                } else {
                    PADDING_M
                }
            };
            point + Vec3::new(side(0), side(1), side(2))
        });
        corners.map(|p| (p / CELL_M).floor().to_array().map(|x| x as i32))
    };
    let mut pace = CancelPoller::new(TRIANGLES_PER_CHECK);
    let mut places = Vec::new();
    let mut own = Vec::new();
    for (k, rim) in rims.iter().enumerate() {
        pace.count_one();
        let [a, b] = rim.ends;
        let steps = (2.0 * a.distance(b) / CELL_M).ceil().max(1.0) as usize;
        for step in 0..=steps {
            let point = a.lerp(b, step as f32 / steps as f32);
            own.extend(cells(point));
        }
        // Mostly a few, many times.
        own.sort_unstable();
        own.dedup();
        places.extend(own.drain(..).map(|cell| (cell, k)));
    }
    places.sort_unstable();
    let mut edges = Vec::new();
    for (k, rim) in rims.iter().enumerate() {
        pace.count_one();
        let middle = rim.ends[0].lerp(rim.ends[1], 0.5);
        let cell = (middle / CELL_M).floor().to_array().map(|x| x as i32);
        let first = places.partition_point(|place| place.0 < cell);
        let near = places[first..].iter().take_while(|place| place.0 == cell);
        let mut into = Vec::new();
        let mut within = false;
        for (_, other) in near {
            let there = &rims[*other];
            if there.passes(middle) && there.is_parallel(rim) {
                into.push(there.into);
                // Of coincident rims the longest stays, of equal ones the first.
                let longer = there.length_m().total_cmp(&rim.length_m());
                within |= longer.is_gt() || (longer.is_eq() && *other < k);
            }
        }
        if !within {
            edges.extend(widest_gap(&rim.ends, &into));
        }
    }
    edges
}

impl FaceBoundarySegment {
    fn length_m(&self) -> f32 {
        self.ends[0].distance(self.ends[1])
    }

    fn along(&self) -> Vec3 {
        (self.ends[1] - self.ends[0]).normalize_or_zero()
    }

    fn is_parallel(&self, other: &Self) -> bool {
        self.along().dot(other.along()).abs() > STRAIGHT
    }

    /// Returns whether it passes through a point.
    fn passes(&self, point: Vec3) -> bool {
        let from_start = point - self.ends[0];
        let along_m = from_start.dot(self.along());
        let off_m = (from_start - self.along() * along_m).length();
        off_m < ON_LINE_M && along_m > -ON_LINE_M && along_m < self.length_m() + ON_LINE_M
    }
}

/// Returns all sides of triangles, those of equal ends together.
fn sides(corners: &[[Vec3; 3]], of_triangle: &[u32]) -> Vec<TriangleSide> {
    let mut sides = Vec::with_capacity(3 * corners.len());
    let mut pace = CancelPoller::new(TRIANGLES_PER_CHECK);
    for (triangle, plane) in corners.iter().zip(of_triangle) {
        pace.count_one();
        if *plane == NO_PLANE {
            continue;
        }
        for k in 0..3 {
            let mut ends = [triangle[k], triangle[(k + 1) % 3]];
            let mut key = ends.map(weld);
            if key[0] == key[1] {
                continue;
            }
            if key[1] < key[0] {
                key.swap(0, 1);
                ends.swap(0, 1);
            }
            let along = (ends[1] - ends[0]).normalize_or_zero();
            let inner = triangle[(k + 2) % 3] - ends[0];
            let into = (inner - along * along.dot(inner)).normalize_or_zero();
            sides.push(TriangleSide {
                key,
                ends,
                plane: *plane,
                into,
            });
        }
    }
    // Stable, so that triangles of one edge stay in order. In parts first, which only need to be merged then, so that a
    // large house is not sorted in one go.
    for part in sides.chunks_mut(SIDES_PER_CHECK) {
        interrupt::unwind_if_cancelled();
        part.sort_by_key(|side| side.key);
    }
    sides.sort_by_key(|side| side.key);
    sides
}

/// Returns the widest angle without a face around an edge, if it is wide enough to diffract.
fn widest_gap(ends: &[Vec3; 2], into: &[Vec3]) -> Option<DiffractionEdge> {
    let first = *into.first()?;
    let along = (ends[1] - ends[0]).normalize_or_zero();
    let second = along.cross(first);
    let angle = |v: &Vec3| {
        let angle = libm::atan2f(v.dot(second), v.dot(first));
        if angle < 0.0 { angle + TAU } else { angle }
    };
    let mut angles: Vec<f32> = into.iter().map(angle).collect();
    angles.sort_by(f32::total_cmp);
    let mut best = (0.0, 0.0);
    for (k, start) in angles.iter().enumerate() {
        let end = angles.get(k + 1).copied().unwrap_or(angles[0] + TAU);
        if end - start > best.1 {
            best = (*start, end - start);
        }
    }
    let (start, open_rad) = best;
    let middle = start + 0.5 * open_rad;
    let (sin, cos) = dwell_scene::math::sin_cos(middle);
    (open_rad > PI + LEAST_FOLD_RAD).then_some(DiffractionEdge {
        ends: *ends,
        outward_direction: first * cos + second * sin,
        air_angle_rad: open_rad,
    })
}

/// Joins pieces along a straight line, and keeps those that are long enough.
fn merge(pieces: &[DiffractionEdge]) -> Vec<DiffractionEdge> {
    let along = |edge: &DiffractionEdge| (edge.ends[1] - edge.ends[0]).normalize_or_zero();
    let mut ends: Vec<([i32; 3], usize)> = pieces
        .iter()
        .enumerate()
        .flat_map(|(k, edge)| edge.ends.map(|end| (weld(end), k)))
        .collect();
    ends.sort_unstable();
    let mut sets = DisjointSets::new(pieces.len());
    let mut pace = CancelPoller::new(TRIANGLES_PER_CHECK);
    for at in ends.chunk_by(|a, b| a.0 == b.0) {
        for (n, (_, a)) in at.iter().enumerate() {
            pace.count_one();
            for (_, b) in &at[n + 1..] {
                let (p, q) = (&pieces[*a], &pieces[*b]);
                if along(p).dot(along(q)).abs() > STRAIGHT
                    && p.outward_direction.dot(q.outward_direction) > 0.98
                    && (p.air_angle_rad - q.air_angle_rad).abs() < 0.2
                {
                    sets.join(*a, *b);
                }
            }
        }
    }
    let mut order: Vec<(usize, usize)> = (0..pieces.len()).map(|k| (sets.root(k), k)).collect();
    order.sort_unstable();
    let mut edges = Vec::new();
    for set in order.chunk_by(|a, b| a.0 == b.0) {
        let first = pieces[set[0].0];
        let direction = along(&first);
        let place = |point: &Vec3| direction.dot(*point - first.ends[0]);
        let points = || set.iter().flat_map(|(_, k)| pieces[*k].ends);
        let least = points().min_by(|a, b| place(a).total_cmp(&place(b)));
        let most = points().max_by(|a, b| place(a).total_cmp(&place(b)));
        if let (Some(a), Some(b)) = (least, most)
            && a.distance(b) >= SHORTEST_M
        {
            edges.push(DiffractionEdge {
                ends: [a, b],
                ..first
            });
        }
    }
    edges
}

/// Finds whether a plane continues beyond a side.
struct PlaneCoverage<'a> {
    corners: &'a [[Vec3; 3]],
    /// Triangles by plane and by their lowest x.
    order: Vec<(u32, f32, u32)>,
}

impl<'a> PlaneCoverage<'a> {
    fn new(corners: &'a [[Vec3; 3]], of_triangle: &[u32]) -> Self {
        let planes = of_triangle.iter().enumerate();
        let mut order: Vec<(u32, f32, u32)> = planes
            .filter(|(_, plane)| **plane != NO_PLANE)
            .map(|(k, plane)| {
                let [a, b, c] = corners[k];
                (*plane, a.x.min(b.x).min(c.x), k as u32)
            })
            .collect();
        order.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2)));
        Self { corners, order }
    }

    /// Returns whether most of the area beside a side belongs to other triangles of its plane.
    fn is_covered_beyond(&self, side: &TriangleSide) -> bool {
        let from = self.order.partition_point(|entry| entry.0 < side.plane);
        let to = self.order.partition_point(|entry| entry.0 <= side.plane);
        let covered = [0.2, 0.5, 0.8].into_iter().filter(|t| {
            let point = side.ends[0].lerp(side.ends[1], *t) - side.into * BESIDE_M;
            let begun = self.order[from..to].partition_point(|entry| entry.1 <= point.x + BESIDE_M);
            self.order[from..from + begun]
                .iter()
                .any(|entry| contains(&self.corners[entry.2 as usize], point))
        });
        covered.count() >= 2
    }
}

/// Returns whether a triangle contains a point that lies next to its plane.
fn contains(triangle: &[Vec3; 3], point: Vec3) -> bool {
    let far = |axis: usize| {
        let values = triangle.map(|corner| corner[axis]);
        let least = values[0].min(values[1]).min(values[2]);
        let most = values[0].max(values[1]).max(values[2]);
        point[axis] < least - BESIDE_M || point[axis] > most + BESIDE_M
    };
    if far(0) || far(1) || far(2) {
        return false;
    }
    let [a, b, c] = triangle.map(Vec3::as_dvec3);
    let point = point.as_dvec3();
    let normal = (b - a).cross(c - a);
    let inside = |a: DVec3, b: DVec3| (b - a).cross(point - a).dot(normal) >= 0.0;
    inside(a, b) && inside(b, c) && inside(c, a)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quad(p: [Vec3; 4]) -> [[Vec3; 3]; 2] {
        [[p[0], p[1], p[2]], [p[0], p[2], p[3]]]
    }

    fn grid(n: usize, at: impl Fn(f32, f32) -> Vec3) -> Vec<[Vec3; 3]> {
        let p = |i: usize, j: usize| at(i as f32 / n as f32, j as f32 / n as f32);
        let cells = (0..n * n).map(|k| (k / n, k % n));
        cells
            .flat_map(|(i, j)| quad([p(i, j), p(i + 1, j), p(i + 1, j + 1), p(i, j + 1)]))
            .collect()
    }

    fn lengths(edges: &[DiffractionEdge]) -> Vec<f32> {
        let mut lengths: Vec<f32> = edges
            .iter()
            .map(|edge| edge.ends[0].distance(edge.ends[1]))
            .collect();
        lengths.sort_by(f32::total_cmp);
        lengths
    }

    #[test]
    fn a_sheet_has_its_rim_however_it_is_cut() {
        for n in [1, 2, 7] {
            let sheet = grid(n, |u, v| Vec3::new(2.0 * u, 3.0 * v, 1.0));
            let edges = find_edges(&sheet, &vec![0; sheet.len()]);
            let found = lengths(&edges);
            for (found, wanted) in found.iter().zip([2.0, 2.0, 3.0, 3.0]) {
                assert!((found - wanted).abs() < 1e-5, "{n}: {edges:?}");
            }
            assert_eq!(edges.len(), 4);
            for edge in edges {
                assert!((edge.air_angle_rad - TAU).abs() < 1e-4);
                let middle = edge.ends[0].lerp(edge.ends[1], 0.5);
                let away = (middle - Vec3::new(1.0, 1.5, 1.0)).normalize();
                assert!(edge.outward_direction.dot(away) > 0.999, "{edge:?}");
            }
        }
    }

    #[test]
    fn a_box_has_twelve_edges_open_by_three_quarters() {
        let mut faces: Vec<[Vec3; 3]> = Vec::new();
        let mut planes = Vec::new();
        for axis in 0..3 {
            for side in [0.0, 1.0] {
                let face = grid(3, |u, v| {
                    let mut p = Vec3::ZERO;
                    p[axis] = side;
                    p[(axis + 1) % 3] = u;
                    p[(axis + 2) % 3] = v;
                    p
                });
                planes.extend(vec![planes.len() as u32; face.len()]);
                faces.extend(face);
            }
        }
        let edges = find_edges(&faces, &planes);
        assert_eq!(edges.len(), 12);
        for edge in edges {
            assert!((edge.air_angle_rad - 1.5 * PI).abs() < 1e-4);
            let middle = edge.ends[0].lerp(edge.ends[1], 0.5);
            let away = (middle - Vec3::splat(0.5)).normalize();
            assert!(edge.outward_direction.dot(away) > 0.999);
        }
    }

    /// Any number of coincident boxes from two on has the edges of two.
    #[test]
    fn copies_at_one_place_have_the_edges_of_two() {
        let one: Vec<[Vec3; 3]> = grid(2, |u, v| Vec3::new(u, v, 0.0))
            .into_iter()
            .chain(grid(1, |u, v| Vec3::new(0.0, u, v)))
            .collect();
        let planes: Vec<u32> = (0..one.len()).map(|k| u32::from(k >= 8)).collect();
        let times = |n: usize| {
            let corners: Vec<[Vec3; 3]> = (0..n).flat_map(|_| one.clone()).collect();
            find_edges(&corners, &planes.repeat(n))
        };
        assert!(!times(2).is_empty());
        assert_eq!(times(2), times(3));
        assert_eq!(times(2), times(2_000));
    }

    #[test]
    fn t_junctions_within_a_wall_are_no_edges() {
        let mut wall = grid(1, |u, v| Vec3::new(2.0 * u, 2.0 * v, 0.0));
        wall.extend(grid(3, |u, v| Vec3::new(2.0 + u, 2.0 * v, 0.0)));
        let edges = find_edges(&wall, &vec![0; wall.len()]);
        // The rim: two sides, and above and below either one piece or two.
        assert!(edges.len() <= 6);
        let between =
            |edge: &DiffractionEdge| edge.ends.iter().all(|end| (end.x - 2.0).abs() < 1e-3);
        assert!(!edges.iter().any(between), "{edges:?}");
    }

    #[test]
    fn folds_count_from_thirty_degrees_on_and_short_edges_not_at_all() {
        let folded = |degrees: f32| {
            let (sin, cos) = dwell_scene::math::sin_cos(degrees.to_radians());
            let mut roof = grid(1, |u, v| Vec3::new(u, v, 0.0));
            roof.extend(grid(1, |u, v| Vec3::new(-u * cos, v, -u * sin)));
            let edges = find_edges(&roof, &[0, 0, 1, 1]);
            let ridge =
                |edge: &&DiffractionEdge| edge.ends.iter().all(|end| end.x == 0.0 && end.z == 0.0);
            edges.iter().filter(ridge).count()
        };
        assert_eq!((folded(20.0), folded(40.0)), (0, 1));
        let small = grid(1, |u, v| 0.1 * Vec3::new(u, v, 0.0));
        assert!(find_edges(&small, &[0, 0]).is_empty());
    }
}
