//! Open vessels: mugs, bowls, pots. They are hollow for eyes and for things that are put in.

use super::SolidMesh;
use super::revolve::{profile_point, surface};
use dwell_scene::{Collider, Pose};
use glam::Vec3;

/// Convex pieces around the wall.
const WALL_PIECES: usize = 8;

/// A body of revolution with a cavity. `outer`: (radius, height) in m from the middle of the bottom up to the rim;
/// `wall_m`: thickness of wall and bottom. It collides as its bottom and eight pieces of wall.
pub fn vessel(outer: &[(f32, f32)], wall_m: f32, segments: usize) -> SolidMesh {
    let floor = outer[0].1 + wall_m;
    let inner: Vec<(f32, f32)> = outer
        .iter()
        .map(|&(r, y)| ((r - wall_m).max(0.0), y.max(floor)))
        .collect();
    let mut profile = outer.to_vec();
    profile.extend(inner.iter().rev());
    let mesh = surface(&profile, segments);
    // The bottom: everything up to the cavity's floor. The wall: wedges between neighbouring outer and inner rings.
    let foot = outer
        .iter()
        .filter(|p| p.1 <= floor)
        .fold(0.0_f32, |r, p| r.max(p.0));
    let half_height = 0.5 * (floor - outer[0].1);
    let mut colliders = vec![Collider::Cylinder {
        part_from_cylinder: Pose::from_position(Vec3::Y * (outer[0].1 + half_height)),
        half_height,
        radius: foot,
    }];
    let rings: Vec<_> = outer
        .iter()
        .zip(&inner)
        .filter(|(o, _)| o.0 > 0.0)
        .collect();
    for pair in rings.windows(2) {
        if (pair[1].0.1 - pair[0].0.1).abs() < wall_m {
            continue;
        }
        for k in 0..WALL_PIECES {
            let corner = |p: &(f32, f32), k| profile_point(*p, k, WALL_PIECES);
            let points = pair
                .iter()
                .flat_map(|(o, i)| {
                    [
                        corner(o, k),
                        corner(o, k + 1),
                        corner(i, k),
                        corner(i, k + 1),
                    ]
                })
                .collect();
            colliders.push(Collider::Hull { points });
        }
    }
    SolidMesh::new(mesh, colliders)
}
