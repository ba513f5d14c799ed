//! The direct sound, in sight or through walls.

use crate::bands::BAND_COUNT;
use crate::echogram::Path;
use crate::scene::AcousticScene;
use crate::tail::margin_m;
use dwell_scene::SurfaceOwner;
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::rays::RayScene;
use glam::Vec3;

/// Walls that sound passes through at most.
const MOST_WALLS: usize = 3;
/// Surfaces that are looked at between source and receiver.
const MOST_SURFACES: usize = 64;
/// Parallel faces of the structure that are no further apart than this are the two sides of one wall, m.
const THICKEST_WALL_M: f32 = 0.5;

/// One obstacle on the way.
struct Wall {
    owner: SurfaceOwner,
    normal: Vec3,
    /// Where the first of its faces is, m from the source.
    first_m: f32,
    /// The least energy that one of its materials lets pass.
    passed: [f32; BAND_COUNT],
}

/// The direct path; `None` when nothing gets through.
pub(super) fn direct(
    scene: &AcousticScene,
    rays: &RayScene,
    source: Vec3,
    receiver: Vec3,
) -> Option<Path> {
    let length_m = source.as_dvec3().distance(receiver.as_dvec3());
    let passed = if scene.config().transmission {
        through(scene, rays, source, receiver)?
    } else {
        let blocked = rays.occluded(&Ray::segment(source, receiver, 0.0), RayMask::EAR);
        (!blocked).then_some(([1.0; BAND_COUNT], 0))?
    };
    let (fractions, walls) = passed;
    let mut energy = super::spread(scene, length_m);
    for (e, fraction) in energy.iter_mut().zip(fractions) {
        *e *= f64::from(fraction);
    }
    if energy.iter().all(|e| *e == 0.0) {
        return None;
    }
    let departure = (receiver - source).normalize_or_zero();
    Some(Path {
        planes: Vec::new(),
        length_m,
        energy: energy.map(|e| e as f32),
        arrival: -departure,
        departure,
        walls: walls as u32,
        inverted: false,
    })
}

/// The energy that gets from `source` to `receiver` through what stands between, and how many walls that is.
fn through(
    scene: &AcousticScene,
    rays: &RayScene,
    source: Vec3,
    receiver: Vec3,
) -> Option<([f32; BAND_COUNT], usize)> {
    let whole = Ray::segment(source, receiver, 0.0);
    let mut near_m = 0.0;
    let mut walls: Vec<Wall> = Vec::new();
    for _ in 0..MOST_SURFACES {
        let Some(hit) = rays.closest(&whole.between(near_m, whole.far_m), RayMask::EAR) else {
            let fractions = walls.iter().fold([1.0; BAND_COUNT], |product, wall| {
                std::array::from_fn(|band| product[band] * wall.passed[band])
            });
            return Some((fractions, walls.len()));
        };
        near_m = hit.distance_m + margin_m(whole.at(hit.distance_m));
        let surface = rays.surface(&hit);
        let passed = scene.surface(surface.material).passed;
        let here = Wall {
            owner: surface.owner,
            normal: surface.normal,
            first_m: hit.distance_m,
            passed,
        };
        // Both faces of a solid, or both shells of a wall, are crossed by one sound: it counts once, by its better insulator.
        if let Some(wall) = walls.iter_mut().find(|wall| is_same(wall, &here)) {
            for (a, b) in wall.passed.iter_mut().zip(passed) {
                *a = a.min(b);
            }
        } else if walls.len() == MOST_WALLS {
            return None;
        } else {
            walls.push(here);
        }
        let blocks = |wall: &Wall| wall.passed.iter().all(|passed| *passed <= 0.0);
        if walls.iter().any(blocks) {
            return None;
        }
    }
    None
}

fn is_same(wall: &Wall, other: &Wall) -> bool {
    let near = other.first_m - wall.first_m <= THICKEST_WALL_M;
    match (wall.owner, other.owner) {
        (SurfaceOwner::Part(a), SurfaceOwner::Part(b)) => a == b,
        (SurfaceOwner::Structure(_), SurfaceOwner::Structure(_)) => {
            near && wall.normal.dot(other.normal).abs() > 0.94
        }
        _ => false,
    }
}
