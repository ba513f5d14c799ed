//! Clustering of coplanar triangles into planes.

use super::TRIANGLES_PER_CHECK;
use dwell_scene::Aabb;
use dwell_scene::interrupt::CancelPoller;
use glam::{DVec3, Vec3};
use std::collections::BTreeMap;

/// Largest distance of a corner from its plane, m.
const OFFSET_M: f64 = 2e-3;
/// Cosine of the largest angle between a triangle and its plane: 1 degree.
const COS_ANGLE: f64 = 0.999_847_7;
/// Distance below which corners are one, m: flatter triangles than that have no plane.
const WELD_M: f64 = 1e-4;
/// Normals are sorted into cells of this width.
const CELL: f64 = 0.1;
/// Planes of one orientation are sorted into slots of this width, m.
const SLOT_M: f64 = 2.0 * OFFSET_M;

/// A mirror: all coplanar triangles together, whatever their material. It is two-sided.
#[derive(Clone, Debug, PartialEq)]
pub struct Plane {
    /// Unit length.
    pub normal: DVec3,
    /// `normal . x` of its points, m.
    pub offset_m: f64,
    /// Area of its triangles, m².
    pub area_m2: f64,
    /// The box around its triangles, m.
    pub bounds: Aabb,
}

impl Plane {
    /// Returns the signed distance of a point, m.
    pub fn distance_m(&self, point: DVec3) -> f64 {
        self.normal.dot(point) - self.offset_m
    }

    /// Returns the mirror image of a point.
    pub fn mirror(&self, point: DVec3) -> DVec3 {
        point - self.normal * (2.0 * self.distance_m(point))
    }
}

/// Clusters triangles into planes.
///
/// Returns the planes, the largest triangle's first, and the plane of each triangle; [`NO_PLANE`] for triangles without area.
///
/// # Determinism
/// Equal input, equal output: larger triangles come first, equal ones in order.
pub(super) fn cluster_coplanar(corners: &[[Vec3; 3]]) -> (Vec<Plane>, Vec<u32>) {
    let mut order: Vec<(usize, f64, DVec3)> = Vec::with_capacity(corners.len());
    let mut pace = CancelPoller::new(TRIANGLES_PER_CHECK);
    for (index, [a, b, c]) in corners.iter().enumerate() {
        pace.count_one();
        let (ab, ac) = ((*b - *a).as_dvec3(), (*c - *a).as_dvec3());
        let cross = ab.cross(ac);
        let longest = ab.length().max(ac.length()).max((ac - ab).length());
        // The height over the longest edge distinguishes slivers from triangles.
        if cross.is_finite() && cross.length() > WELD_M * longest {
            order.push((index, 0.5 * cross.length(), cross.normalize()));
        }
    }
    order.sort_by(|(i, a, _), (j, b, _)| b.total_cmp(a).then(i.cmp(j)));

    let mut planes: Vec<Plane> = Vec::new();
    let mut of_triangle = vec![super::NO_PLANE; corners.len()];
    let mut finder = PlaneFinder::default();
    for (index, area_m2, normal) in order {
        pace.count_one();
        // One of two opposite normals represents both.
        let first = normal.to_array().into_iter().find(|x| x.abs() > 1e-9);
        let normal = if first.is_some_and(|x| x < 0.0) {
            -normal
        } else {
            normal
        };
        let points = corners[index].map(Vec3::as_dvec3);
        let id = finder.find(&planes, normal, &points).unwrap_or_else(|| {
            let middle = (points[0] + points[1] + points[2]) / 3.0;
            planes.push(Plane {
                normal,
                offset_m: normal.dot(middle),
                area_m2: 0.0,
                bounds: Aabb::EMPTY,
            });
            finder.insert(&planes, planes.len() - 1);
            planes.len() - 1
        });
        let plane = &mut planes[id];
        plane.area_m2 += area_m2;
        for corner in &corners[index] {
            plane.bounds.add_point(*corner);
        }
        of_triangle[index] = id as u32;
    }
    (planes, of_triangle)
}

type NormalCell = [i32; 3];

/// Planes of equal orientation, by offset.
#[derive(Debug)]
struct ParallelPlanes {
    normal: DVec3,
    by_slot: BTreeMap<i64, Vec<usize>>,
}

/// Finds the plane of a triangle among those seen so far.
#[derive(Debug, Default)]
struct PlaneFinder {
    cells: BTreeMap<NormalCell, Vec<ParallelPlanes>>,
}

fn cell(normal: DVec3) -> NormalCell {
    normal.to_array().map(|x| (x / CELL).floor() as i32)
}

fn slot(offset_m: f64) -> i64 {
    (offset_m / SLOT_M).floor() as i64
}

impl PlaneFinder {
    fn find(&self, planes: &[Plane], normal: DVec3, points: &[DVec3; 3]) -> Option<usize> {
        let middle = (points[0] + points[1] + points[2]) / 3.0;
        let fits = |id: usize| {
            let plane = &planes[id];
            plane.normal.dot(normal).abs() > COS_ANGLE
                && points.iter().all(|p| plane.distance_m(*p).abs() < OFFSET_M)
        };
        // A normal near the border of its cell may have its plane in the next one, or, near the edge of the half of the
        // directions that represent both, on the other side.
        let mut best: Option<usize> = None;
        let mut seen: Vec<NormalCell> = Vec::with_capacity(4);
        for sign in [1.0, -1.0] {
            for corner in 0..8 {
                let near = |axis: usize| {
                    if corner >> axis & 1 == 0 {
                        -0.018
                    } else {
                        0.018
                    }
                };
                let place = cell(normal * sign + DVec3::new(near(0), near(1), near(2)));
                if seen.contains(&place) {
                    continue;
                }
                seen.push(place);
                for bundle in self.cells.get(&place).into_iter().flatten() {
                    if bundle.normal.dot(normal).abs() <= COS_ANGLE {
                        continue;
                    }
                    let here = slot(bundle.normal.dot(middle));
                    let ids = bundle.by_slot.range(here - 1..=here + 1);
                    for id in ids.flat_map(|(_, ids)| ids).copied() {
                        if best.is_none_or(|b| id < b) && fits(id) {
                            best = Some(id);
                        }
                    }
                }
            }
        }
        best
    }

    fn insert(&mut self, planes: &[Plane], id: usize) {
        let plane = &planes[id];
        let bundles = self.cells.entry(cell(plane.normal)).or_default();
        // A bundle's normals agree so well that over 10 km the offsets differ by less than a slot.
        let same = |bundle: &ParallelPlanes| (bundle.normal - plane.normal).length() < 1e-7;
        let place = bundles.iter().position(same).unwrap_or_else(|| {
            bundles.push(ParallelPlanes {
                normal: plane.normal,
                by_slot: BTreeMap::new(),
            });
            bundles.len() - 1
        });
        let slots = &mut bundles[place].by_slot;
        slots.entry(slot(plane.offset_m)).or_default().push(id);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(n: usize, at: impl Fn(f32, f32) -> Vec3) -> Vec<[Vec3; 3]> {
        let p = |i: usize, j: usize| at(i as f32 / n as f32, j as f32 / n as f32);
        (0..n * n)
            .flat_map(|k| {
                let (i, j) = (k / n, k % n);
                [
                    [p(i, j), p(i + 1, j), p(i + 1, j + 1)],
                    [p(i, j), p(i + 1, j + 1), p(i, j + 1)],
                ]
            })
            .collect()
    }

    #[test]
    fn a_split_wall_is_one_plane_and_a_parallel_one_another() {
        let mut triangles = grid(10, |u, v| Vec3::new(6.0 * u, 3.0 * v, 5.0));
        triangles.extend(grid(3, |u, v| Vec3::new(6.0 * u, 3.0 * v, 5.1)));
        let (planes, of_triangle) = cluster_coplanar(&triangles);
        assert_eq!(planes.len(), 2);
        assert!(of_triangle[..200].iter().all(|id| *id == of_triangle[0]));
        assert!(of_triangle[200..].iter().all(|id| *id != of_triangle[0]));
        assert!((planes[0].area_m2 - 18.0).abs() < 1e-4 && (planes[1].area_m2 - 18.0).abs() < 1e-4);
    }

    #[test]
    fn a_slanted_wall_with_rounded_corners_is_one_plane() {
        let turn = glam::Quat::from_rotation_y(0.7345);
        let at =
            |u: f32, v: f32| turn * Vec3::new(7.3 * u, 2.7 * v, 41.3) + Vec3::new(3.3, 0.1, -7.7);
        let (planes, _) = cluster_coplanar(&grid(12, at));
        assert_eq!(planes.len(), 1);
    }

    #[test]
    fn a_fold_of_two_degrees_is_two_planes_and_slivers_have_none() {
        let fold = f32::to_radians(2.0);
        let mut triangles = grid(2, |u, v| Vec3::new(u, v, 0.0));
        triangles.extend(grid(2, |u, v| {
            Vec3::new(-u * libm::cosf(fold), v, -u * libm::sinf(fold))
        }));
        triangles.push([Vec3::ZERO, Vec3::X, Vec3::new(0.5, 1e-6, 0.0)]);
        triangles.push([Vec3::ONE; 3]);
        let (planes, of_triangle) = cluster_coplanar(&triangles);
        assert_eq!(planes.len(), 2);
        assert_eq!(of_triangle[16..], [super::super::NO_PLANE; 2]);
    }

    #[test]
    fn a_mirror_image_lies_as_far_behind() {
        let (planes, _) = cluster_coplanar(&grid(1, |u, v| Vec3::new(6.0, 3.0 * u, 5.0 * v)));
        let image = planes[0].mirror(DVec3::new(1.2, 1.4, 1.5));
        assert!((image - DVec3::new(10.8, 1.4, 1.5)).length() < 1e-12);
    }
}
