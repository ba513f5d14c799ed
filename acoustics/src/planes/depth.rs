//! How far small panels stand from the walls behind them.

use super::{NO_PLANE, Plane, TRIANGLES_PER_CHECK, WALL_M2};
use dwell_scene::Aabb;
use dwell_scene::interrupt::Pace;
use glam::Vec3;

/// Walls further away than this are not looked for, m: only waves below 50 Hz would take both for one.
const FURTHEST_M: f64 = 1.0;
/// Cosine of the largest angle between a panel and its wall: 8 degrees.
const COS_ANGLE: f64 = 0.99;
/// How far a panel may reach beyond its wall, m.
const BEYOND_M: f32 = 0.01;

/// How far the panel of each triangle stands from the nearest parallel wall before or behind its middle, m; infinite where there
/// is none, and for walls. `panel_m2`: area of the panels. Shapes (triangle,).
pub(super) fn depths(
    corners: &[[Vec3; 3]],
    planes: &[Plane],
    of_triangle: &[u32],
    panel_m2: &[f32],
) -> Vec<f32> {
    // The box around all walls of each plane.
    let mut walls = vec![Aabb::EMPTY; planes.len()];
    for (k, corners) in corners.iter().enumerate() {
        if panel_m2[k] >= WALL_M2 {
            let wall = &mut walls[of_triangle[k] as usize];
            *wall = wall.union(&Aabb::from_points(*corners));
        }
    }
    let walls: Vec<(&Plane, Aabb)> = planes
        .iter()
        .zip(walls)
        .filter(|(_, bounds)| !bounds.is_empty())
        .map(|(plane, bounds)| (plane, bounds.grown(BEYOND_M)))
        .collect();
    let mut parallel: Vec<Option<Vec<usize>>> = vec![None; planes.len()];
    let mut pace = Pace::new(TRIANGLES_PER_CHECK);
    let depths = corners.iter().enumerate().map(|(k, corners)| {
        pace.turn();
        if of_triangle[k] == NO_PLANE || panel_m2[k] >= WALL_M2 {
            return f32::INFINITY;
        }
        let own = of_triangle[k] as usize;
        let parallel = parallel[own].get_or_insert_with(|| {
            let along = |wall: &Plane| wall.normal.dot(planes[own].normal).abs() > COS_ANGLE;
            (0..walls.len()).filter(|w| along(walls[*w].0)).collect()
        });
        let middle = corners.iter().sum::<Vec3>().as_dvec3() / 3.0;
        let distances = parallel.iter().filter_map(|w| {
            let (wall, bounds) = &walls[*w];
            let distance_m = wall.distance_m(middle);
            let opposite = middle - wall.normal * distance_m;
            let behind = distance_m.abs() <= FURTHEST_M && bounds.contains(opposite.as_vec3());
            behind.then_some(distance_m.abs())
        });
        distances.fold(f64::INFINITY, f64::min) as f32
    });
    depths.collect()
}

#[cfg(test)]
mod tests {
    use super::super::{cluster::cluster, panels};
    use super::*;

    fn square(at: Vec3, size_m: f32) -> [[Vec3; 3]; 2] {
        let p = |u: f32, v: f32| at + Vec3::new(u * size_m, v * size_m, 0.0);
        [
            [p(0.0, 0.0), p(1.0, 0.0), p(1.0, 1.0)],
            [p(0.0, 0.0), p(1.0, 1.0), p(0.0, 1.0)],
        ]
    }

    #[test]
    fn panels_know_the_wall_that_they_hang_at() {
        let mut corners = Vec::new();
        corners.extend(square(Vec3::ZERO, 3.0));
        // At the wall; before it; too far before it; beside it.
        corners.extend(square(Vec3::new(1.0, 1.0, 0.05), 0.5));
        corners.extend(square(Vec3::new(1.0, 1.0, -0.6), 0.5));
        corners.extend(square(Vec3::new(1.0, 1.0, 1.3), 0.5));
        corners.extend(square(Vec3::new(4.0, 1.0, 0.05), 0.5));
        let (planes, of_triangle) = cluster(&corners);
        let panel_m2 = panels::areas(&corners, &of_triangle);
        let found = depths(&corners, &planes, &of_triangle, &panel_m2);
        let far = f32::INFINITY;
        let wanted = [far, far, 0.05, 0.05, 0.6, 0.6, far, far, far, far];
        for (k, (found, wanted)) in found.into_iter().zip(wanted).enumerate() {
            assert!(
                found == wanted || (found - wanted).abs() < 1e-5,
                "{k}: {found}"
            );
        }
    }
}
