//! Relief of small panels over the walls behind and around them.

use super::panels::{self, PanelTable};
use super::{MIN_WALL_AREA_M2, NO_PLANE, Plane, TRIANGLES_PER_CHECK};
use dwell_scene::Aabb;
use dwell_scene::interrupt::CancelPoller;
use glam::{DVec3, Vec3};

/// Largest distance of a wall from its panels, m: only waves below 50 Hz would take both for one.
const FURTHEST_M: f32 = 1.0;
/// Cosine of the largest angle between a panel and its wall, 60 degrees: steeper panels are no part of a rough wall.
const LEAST_COS: f64 = 0.5;
/// Largest overhang of a panel beyond its wall, m.
const BEYOND_M: f32 = 0.01;

/// A wall, and the box around all its triangles.
struct RelievedWall<'a> {
    plane: &'a Plane,
    bounds: Aabb,
}

/// Returns the relief of each triangle's panel over the wall that it stands least out of, m, as in [`of_panel`]; infinite
/// where no wall is near, and for walls. Shape (triangle,).
pub(super) fn relief_depths_m(
    corners: &[[Vec3; 3]],
    planes: &[Plane],
    of_triangle: &[u32],
    panels: &PanelTable,
) -> Vec<f32> {
    let walls = walls(corners, planes, of_triangle, panels);
    let mut small: Vec<(usize, usize)> = (0..corners.len())
        .filter(|k| of_triangle[*k] != NO_PLANE && panels.area_m2[*k] < MIN_WALL_AREA_M2)
        .map(|k| (panels.of_triangle[k], k))
        .collect();
    small.sort_unstable();
    let mut reliefs = vec![f32::INFINITY; corners.len()];
    let mut pace = CancelPoller::new(TRIANGLES_PER_CHECK);
    let mut pieces = Vec::new();
    for panel in small.chunk_by(|a, b| a.0 == b.0) {
        pieces.clear();
        for (_, k) in panel {
            pace.count_one();
            pieces.push(corners[*k]);
        }
        let own = &planes[of_triangle[panel[0].1] as usize];
        let along = walls
            .iter()
            .filter(|wall| wall.plane.normal.dot(own.normal).abs() > LEAST_COS);
        let relief_m = panel_relief_m(&pieces, along);
        for (_, k) in panel {
            reliefs[*k] = relief_m;
        }
    }
    reliefs
}

/// Returns the walls of each plane that has any.
fn walls<'a>(
    corners: &[[Vec3; 3]],
    planes: &'a [Plane],
    of_triangle: &[u32],
    panels: &PanelTable,
) -> Vec<RelievedWall<'a>> {
    let mut bounds = vec![Aabb::EMPTY; planes.len()];
    for (k, corners) in corners.iter().enumerate() {
        if panels.area_m2[k] >= MIN_WALL_AREA_M2 {
            let wall = &mut bounds[of_triangle[k] as usize];
            *wall = wall.union(&Aabb::from_points(*corners));
        }
    }
    let walls = planes.iter().zip(bounds);
    walls
        .filter(|(_, bounds)| !bounds.is_empty())
        .map(|(plane, bounds)| RelievedWall { plane, bounds })
        .collect()
}

/// Returns the rms height of a surface of two equal halves, one a panel's and one a wall's, over their mean, m: half the
/// distance of a panel that is parallel to its wall. The smallest over the walls before or behind the panel's middle.
fn panel_relief_m<'a>(
    pieces: &[[Vec3; 3]],
    walls: impl Iterator<Item = &'a RelievedWall<'a>>,
) -> f32 {
    let areas = || pieces.iter().map(panels::area_m2);
    let area_m2: f64 = areas().sum();
    let centre = |piece: &[Vec3; 3]| piece.iter().sum::<Vec3>().as_dvec3() / 3.0;
    let weighted: DVec3 = areas().zip(pieces).map(|(a, p)| a * centre(p)).sum();
    let middle = weighted / area_m2;
    let heights = walls.filter_map(|RelievedWall { plane, bounds }| {
        let height_m = plane.distance_m(middle);
        let opposite = (middle - plane.normal * height_m).as_vec3();
        let near = height_m.abs() <= f64::from(FURTHEST_M);
        (near && bounds.grown(BEYOND_M).contains(opposite)).then(|| {
            // Over a triangle, the square of a height is on average that of its centre, and a twelfth of the squares of the
            // corners' heights over the centre.
            let spread = |piece: &[Vec3; 3]| {
                let own_m = plane.distance_m(centre(piece));
                let corners = piece.map(|p| (plane.distance_m(p.as_dvec3()) - own_m).powi(2));
                (own_m - height_m).powi(2) + corners.iter().sum::<f64>() / 12.0
            };
            let variance: f64 = areas().zip(pieces).map(|(a, p)| a * spread(p)).sum();
            (0.25 * height_m * height_m + variance / area_m2).sqrt()
        })
    });
    heights.fold(f64::INFINITY, f64::min) as f32
}

#[cfg(test)]
mod tests {
    use super::super::{cluster::cluster_coplanar, panels};
    use super::*;

    /// A square whose one side lies along x; `steep`: how much it rises over the other.
    fn square(at: Vec3, size_m: f32, steep: f32) -> [[Vec3; 3]; 2] {
        let p = |u: f32, v: f32| at + Vec3::new(u * size_m, v * size_m, v * size_m * steep);
        [
            [p(0.0, 0.0), p(1.0, 0.0), p(1.0, 1.0)],
            [p(0.0, 0.0), p(1.0, 1.0), p(0.0, 1.0)],
        ]
    }

    fn found(corners: &[[Vec3; 3]]) -> Vec<f32> {
        let (planes, of_triangle) = cluster_coplanar(corners);
        let panels = panels::find_panels(corners, &of_triangle);
        relief_depths_m(corners, &planes, &of_triangle, &panels)
    }

    fn check(corners: &[[Vec3; 3]], wanted: &[f32]) {
        for (k, (found, wanted)) in found(corners).chunks(2).zip(wanted).enumerate() {
            for found in found {
                assert!(
                    found == wanted || (found - wanted).abs() < 1e-5,
                    "{k}: {found}, {wanted}"
                );
            }
        }
    }

    #[test]
    fn panels_know_the_wall_that_they_hang_at() {
        let mut corners = Vec::new();
        corners.extend(square(Vec3::ZERO, 3.0, 0.0));
        // At the wall; before it; too far before it; beside it.
        corners.extend(square(Vec3::new(1.0, 1.0, 0.05), 0.5, 0.0));
        corners.extend(square(Vec3::new(1.0, 1.0, -0.6), 0.5, 0.0));
        corners.extend(square(Vec3::new(1.0, 1.0, 1.3), 0.5, 0.0));
        corners.extend(square(Vec3::new(4.0, 1.0, 0.05), 0.5, 0.0));
        let far = f32::INFINITY;
        check(&corners, &[far, 0.025, 0.3, far, far]);
    }

    /// The heights of a panel that stands in its wall, as one face of a fold does, are even from -h / 2 to h / 2: h / sqrt(12) rms.
    #[test]
    fn panels_that_lean_out_of_a_wall_are_as_rough_as_they_are_high() {
        let mut corners = Vec::new();
        corners.extend(square(Vec3::ZERO, 3.0, 0.0));
        // In the wall; before it; too steep.
        corners.extend(square(Vec3::new(1.0, 1.0, -0.2), 0.5, 0.8));
        corners.extend(square(Vec3::new(1.0, 1.0, 0.1), 0.5, 0.8));
        corners.extend(square(Vec3::new(1.0, 1.0, -0.5), 0.5, 2.0));
        let in_wall = 0.4 / 12.0_f32.sqrt();
        let before = (0.15_f32.powi(2) + in_wall.powi(2)).sqrt();
        check(&corners, &[f32::INFINITY, in_wall, before, f32::INFINITY]);
    }
}
