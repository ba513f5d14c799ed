//! Panels of a plane: connected triangles, with their sizes.

use super::disjoint_sets::DisjointSets;
use super::{NO_PLANE, TRIANGLES_PER_CHECK};
use dwell_scene::Aabb;
use dwell_scene::interrupt::CancelPoller;
use glam::Vec3;
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// Distance of boxes within which triangles of one plane are one panel, m.
const GAP_M: f32 = 0.005;

/// The panels of a set of triangles.
#[derive(Debug)]
pub(super) struct PanelTable {
    /// The panel of each triangle, named by one of its triangles; triangles without a plane by themselves. Shape
    /// (triangle,).
    pub(super) of_triangle: Vec<usize>,
    /// The area of that panel, m²; 0 for triangles without a plane. Shape (triangle,).
    pub(super) area_m2: Vec<f32>,
}

/// Joins triangles to panels.
///
/// Contact is tested by axis-aligned boxes: panels that are oblique and close together may count as one.
pub(super) fn find_panels(corners: &[[Vec3; 3]], of_triangle: &[u32]) -> PanelTable {
    let boxes: Vec<Aabb> = corners
        .iter()
        .map(|corners| Aabb::from_points(corners.iter().copied()).grown(0.5 * GAP_M))
        .collect();
    let mut order: Vec<usize> = (0..corners.len())
        .filter(|k| of_triangle[*k] != NO_PLANE)
        .collect();
    order.sort_by(|a, b| {
        let plane = of_triangle[*a].cmp(&of_triangle[*b]);
        plane
            .then(boxes[*a].min.x.total_cmp(&boxes[*b].min.x))
            .then(a.cmp(b))
    });
    let mut sets = DisjointSets::new(corners.len());
    let mut pace = CancelPoller::new(TRIANGLES_PER_CHECK);
    let apart = join_equal(&order, &boxes, of_triangle, &mut sets);
    for (place, &a) in apart.iter().enumerate() {
        pace.count_one();
        // Boxes are sorted by their lower ends: later ones overlap until one begins after this one's end.
        for &b in &apart[place + 1..] {
            if of_triangle[b] != of_triangle[a] || boxes[b].min.x > boxes[a].max.x {
                break;
            }
            let (p, q) = (&boxes[a], &boxes[b]);
            if p.min.y <= q.max.y && q.min.y <= p.max.y && p.min.z <= q.max.z && q.min.z <= p.max.z
            {
                sets.join(a, b);
            }
        }
    }
    let roots: Vec<usize> = (0..corners.len()).map(|k| sets.root(k)).collect();
    let mut total = vec![0.0_f64; corners.len()];
    for &k in &order {
        total[roots[k]] += area_m2(&corners[k]);
    }
    PanelTable {
        area_m2: roots.iter().map(|root| total[*root] as f32).collect(),
        of_triangle: roots,
    }
}

/// Joins triangles of one plane whose boxes are equal, and returns one of each, in the order given: a triangle that touches
/// one of them touches all, so that coincident objects are not compared with each other.
fn join_equal(
    order: &[usize],
    boxes: &[Aabb],
    of_triangle: &[u32],
    sets: &mut DisjointSets,
) -> Vec<usize> {
    let key = |k: usize| {
        let numbers = [boxes[k].min, boxes[k].max].map(|p| p.to_array().map(f32::to_bits));
        (of_triangle[k], numbers)
    };
    let mut apart = Vec::with_capacity(order.len());
    let mut first = HashMap::with_capacity(order.len());
    for &k in order {
        match first.entry(key(k)) {
            Entry::Occupied(same) => sets.join(*same.get(), k),
            Entry::Vacant(place) => {
                place.insert(k);
                apart.push(k);
            }
        }
    }
    apart
}

/// Returns the area of a triangle, m².
pub(super) fn area_m2(corners: &[Vec3; 3]) -> f64 {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    0.5 * (b - a).cross(c - a).length()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f32, size: f32) -> [[Vec3; 3]; 2] {
        let p = |u: f32, v: f32| Vec3::new(x + u * size, 1.0, v * size);
        [
            [p(0.0, 0.0), p(1.0, 0.0), p(1.0, 1.0)],
            [p(0.0, 0.0), p(1.0, 1.0), p(0.0, 1.0)],
        ]
    }

    #[test]
    fn touching_triangles_are_one_panel_and_a_gap_parts_them() {
        let mut corners = Vec::new();
        // Two that share an edge, one a centimetre further on, one in another plane, one without any.
        corners.extend(square(0.0, 1.0));
        corners.extend(square(1.0, 1.0));
        corners.extend(square(2.01, 0.5));
        corners.extend(square(2.5, 0.1));
        let of_triangle = [0, 0, 0, 0, 0, 0, 1, NO_PLANE];
        let found = find_panels(&corners, &of_triangle).area_m2;
        for (k, wanted) in [2.0, 2.0, 2.0, 2.0, 0.25, 0.25, 0.005, 0.0]
            .into_iter()
            .enumerate()
        {
            assert!((found[k] - wanted).abs() < 1e-5, "{k}: {}", found[k]);
        }
    }

    /// Ten thousand copies of a panel at one place are one panel of all their area, and its neighbour belongs to it.
    #[test]
    fn panels_at_one_place_are_one() {
        let mut corners: Vec<[Vec3; 3]> = (0..10_000).flat_map(|_| square(0.0, 1.0)).collect();
        corners.extend(square(1.0, 1.0));
        corners.extend(square(2.01, 0.5));
        let found = find_panels(&corners, &vec![0; corners.len()]);
        let count = corners.len();
        assert!(found.of_triangle[..count - 2].iter().all(|root| *root == 0));
        assert_eq!(found.of_triangle[count - 2..], [count - 2; 2]);
        assert!((found.area_m2[0] - 10_001.0).abs() < 1e-2);
    }

    #[test]
    fn a_wall_of_many_triangles_with_loose_corners_is_one_panel() {
        let corners: Vec<[Vec3; 3]> = (0..40).flat_map(|k| square(0.1 * k as f32, 0.1)).collect();
        let found = find_panels(&corners, &vec![0; corners.len()]).area_m2;
        assert!(found.iter().all(|area| (area - 0.4).abs() < 1e-4));
    }
}
