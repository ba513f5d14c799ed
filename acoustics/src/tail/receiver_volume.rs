//! Receiver model of the ray tracer: a point for diffuse rain, and detection spheres around it for crossing rays.

use super::OPEN_AIR_M;
use crate::sphere_sequences::fibonacci_direction;
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::rays::RayScene;
use glam::Vec3;
use std::f64::consts::PI;

/// Ratio of consecutive radii of the spheres.
const STEP: f64 = 1.189_207_115_002_721;
/// Path length up to which the smallest sphere is used; for longer paths it grows with them, m: its solid angle seen from
/// the source stays constant.
const FIRST_M: f64 = 8.0;
/// Largest radius of a sphere over the cube root of the visible volume. With 0.35 energies between 20 and 500 ms are within
/// 0.2 dB of those of the smallest spheres (a studio, rooms of the apartment); 0.5 is half as far again.
const LARGEST: f64 = 0.35;

/// A detection sphere around a receiver.
#[derive(Clone, Copy, Debug)]
struct DetectionSphere {
    radius_m: f32,
    /// 4 pi over its volume visible from the receiver, 1/m³.
    factor: f32,
}

/// A receiver of the ray tracer.
#[derive(Clone, Debug)]
pub(super) struct DetectionVolume {
    pub(super) position: Vec3,
    balls: Vec<DetectionSphere>,
    /// Visible volume, m³.
    pub(super) visible_volume_m3: f64,
    /// True if the source is out of sight. Beside direct sound, transmitted sound is inaudible.
    pub(super) is_occluded: bool,
}

impl DetectionVolume {
    /// Probes the surroundings of `position` with `probes` rays.
    pub(super) fn new(
        rays: &RayScene,
        source: Vec3,
        position: Vec3,
        radius_m: f64,
        probes: usize,
    ) -> Self {
        let distances: Vec<f64> = (0..probes)
            .map(|k| {
                let ray = Ray::new(position, fibonacci_direction(k, probes));
                let hit = rays.closest(&ray, RayMask::EAR);
                f64::from(hit.map_or(OPEN_AIR_M, |hit| hit.distance_m))
            })
            .collect();
        let volume_within = |radius_m: f64| {
            let cubes = distances.iter().map(|d| d.min(radius_m).powi(3));
            4.0 / 3.0 * PI * cubes.sum::<f64>() / probes as f64
        };
        let seen_volume_m3 = volume_within(f64::INFINITY);
        let largest_m = (LARGEST * libm::cbrt(seen_volume_m3)).max(radius_m);
        let mut balls = Vec::new();
        let mut next_m = radius_m;
        while balls.is_empty() || next_m <= largest_m {
            balls.push(DetectionSphere {
                radius_m: next_m as f32,
                // A receiver inside a wall sees nothing.
                factor: (4.0 * PI / volume_within(next_m).max(1e-6)) as f32,
            });
            next_m *= STEP;
        }
        Self {
            position,
            balls,
            visible_volume_m3: seen_volume_m3,
            is_occluded: rays.occluded(&Ray::segment(source, position, 0.0), RayMask::EAR),
        }
    }

    /// Returns the radius of the largest sphere, m.
    pub(super) fn max_radius_m(&self) -> f64 {
        self.balls
            .last()
            .map_or(0.0, |ball| f64::from(ball.radius_m))
    }

    /// Returns the sphere for paths of `path_length_m`.
    fn sphere_at(&self, way_m: f32) -> DetectionSphere {
        let steps = libm::logf((way_m / FIRST_M as f32).max(1.0)) / libm::logf(STEP as f32);
        self.balls[(steps as usize).min(self.balls.len() - 1)]
    }

    /// Returns the segment of a ray, before `reach_m`, in the sphere for its path; `path_length_m` is the path's length at its origin.
    pub(super) fn sphere_crossing(
        &self,
        ray: &Ray,
        reach_m: f32,
        path_length_m: f32,
    ) -> Option<SphereCrossing> {
        let to_center = self.position - ray.origin;
        let along = to_center.dot(ray.direction);
        let miss_squared = (to_center - ray.direction * along).length_squared();
        let largest_m = self.balls.last()?.radius_m;
        if miss_squared >= largest_m * largest_m {
            return None;
        }
        let ball = self.sphere_at(path_length_m + along.max(0.0));
        let half = (ball.radius_m * ball.radius_m - miss_squared)
            .max(0.0)
            .sqrt();
        let (enter_m, leave_m) = ((along - half).max(0.0), (along + half).min(reach_m));
        (half > 0.0 && leave_m > enter_m).then_some(SphereCrossing {
            enter_m,
            leave_m,
            factor: ball.factor * (leave_m - enter_m),
        })
    }
}

/// The intersection of a ray with a sphere.
#[derive(Clone, Copy, Debug)]
pub(super) struct SphereCrossing {
    pub(super) enter_m: f32,
    pub(super) leave_m: f32,
    /// Ratio of the energy at the receiver to the ray's.
    pub(super) factor: f32,
}
