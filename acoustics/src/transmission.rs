//! Transmission of sound through walls and doors.

use crate::bands::{BAND_COUNT, BandValues};
use crate::propagation_scene::PropagationScene;
use crate::ray_margin::ray_offset_m;
use dwell_scene::SurfaceOwner;
use dwell_scene::bvh::{Hit, Ray, RayMask};
use dwell_scene::interrupt;
use dwell_scene::rays::RayScene;
use glam::Vec3;

/// Most walls of a transmitted path.
pub(crate) const MAX_WALLS: usize = 3;
/// Most surfaces that are tested between source and receiver.
const MOST_SURFACES: usize = 64;
/// Largest distance of parallel faces of the structure that are the two sides of one wall, m.
const THICKEST_WALL_M: f32 = 0.5;

/// A wall on the path.
struct TransmittingWall {
    owner: SurfaceOwner,
    normal: Vec3,
    /// Distance of its first face from the source, m.
    first_m: f32,
    /// Transmitted energy of its best insulating material.
    passed: BandValues,
}

/// Returns the energy transmitted from `source` to `receiver` through all walls between, and their number.
pub(crate) fn transmitted_path(
    data: &PropagationScene,
    rays: &RayScene,
    source: Vec3,
    receiver: Vec3,
) -> Option<(BandValues, usize)> {
    let whole = Ray::segment(source, receiver, 0.0);
    let mut near_m = 0.0;
    let mut walls: Vec<TransmittingWall> = Vec::new();
    for _ in 0..MOST_SURFACES {
        interrupt::unwind_if_cancelled();
        let Some(hit) = rays.closest(&whole.with_range(near_m, whole.far_m), RayMask::EAR) else {
            let fractions = walls.iter().fold([1.0; BAND_COUNT], |product, wall| {
                std::array::from_fn(|band| product[band] * wall.passed[band])
            });
            return Some((fractions, walls.len()));
        };
        near_m = hit.distance_m + ray_offset_m(whole.point_at(hit.distance_m));
        let here = TransmittingWall::new(data, rays, &hit);
        // Both faces of a solid, or both shells of a wall, are one wall: it counts once, by its better insulator.
        if let Some(wall) = walls.iter_mut().find(|wall| wall.is_same(&here)) {
            wall.join(&here);
        } else if walls.len() == MAX_WALLS {
            return None;
        } else {
            walls.push(here);
        }
        let blocks = |wall: &TransmittingWall| wall.passed.iter().all(|passed| *passed <= 0.0);
        if walls.iter().any(blocks) {
            return None;
        }
    }
    None
}

/// The far side of a wall that a ray hits.
pub(crate) struct WallExit {
    /// Origin of the ray behind the wall.
    pub(crate) start: Vec3,
    /// Transmitted energy. Shape (band,).
    pub(crate) transmitted_energy: BandValues,
}

/// Returns the exit of `ray`, which hits a wall at `hit`; `None` where nothing is transmitted.
pub(crate) fn exit_behind_wall(
    data: &PropagationScene,
    rays: &RayScene,
    ray: &Ray,
    hit: &Hit,
) -> Option<WallExit> {
    let mut wall = TransmittingWall::new(data, rays, hit);
    let mut last_m = hit.distance_m;
    for _ in 0..MOST_SURFACES {
        interrupt::unwind_if_cancelled();
        if wall.passed.iter().all(|passed| *passed <= 0.0) {
            return None;
        }
        let near_m = last_m + ray_offset_m(ray.point_at(last_m));
        let rest = ray.with_range(near_m, hit.distance_m + THICKEST_WALL_M);
        let next = rays.closest(&rest, RayMask::EAR);
        match next.map(|next| (TransmittingWall::new(data, rays, &next), next.distance_m)) {
            Some((here, distance_m)) if wall.is_same(&here) => {
                wall.join(&here);
                last_m = distance_m;
            }
            _ => {
                return Some(WallExit {
                    start: ray.point_at(near_m),
                    transmitted_energy: wall.passed,
                });
            }
        }
    }
    None
}

impl TransmittingWall {
    fn new(data: &PropagationScene, rays: &RayScene, hit: &Hit) -> Self {
        let surface = rays.surface(hit);
        Self {
            owner: surface.owner,
            normal: surface.normal,
            first_m: hit.distance_m,
            passed: data.surface(surface.material).transmitted,
        }
    }

    /// Adds another face: the wall insulates as well as its better one.
    fn join(&mut self, face: &Self) {
        for (a, b) in self.passed.iter_mut().zip(face.passed) {
            *a = a.min(b);
        }
    }

    fn is_same(&self, other: &Self) -> bool {
        let near = other.first_m - self.first_m <= THICKEST_WALL_M;
        match (self.owner, other.owner) {
            (SurfaceOwner::Part(a), SurfaceOwner::Part(b)) => a == b,
            (SurfaceOwner::Structure(_), SurfaceOwner::Structure(_)) => {
                near && self.normal.dot(other.normal).abs() > 0.94
            }
            _ => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::AcousticConfig;
    use dwell_scene::{House, HouseData};
    use std::sync::Arc;

    #[test]
    fn a_call_is_stopped_at_every_surface() {
        let house = Arc::new(House::new(HouseData::default()).unwrap());
        let rays = RayScene::new(house.clone());
        let data = PropagationScene::new(house, AcousticConfig::full());
        let stopped = interrupt::interruptible(
            || true,
            || {
                std::thread::sleep(interrupt::INTERVAL);
                transmitted_path(&data, &rays, Vec3::ZERO, Vec3::ONE)
            },
        );
        assert!(stopped.is_err());
    }
}
