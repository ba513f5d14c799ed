//! One ray's way through the house.

use super::{Chunk, Deposit, RAYS_PER_CHUNK, fibonacci_direction, margin_m};
use crate::bands::{BAND_COUNT, Banded};
use crate::scene::AcousticScene;
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::math::sin_cos;
use dwell_scene::random::{Key, Stream};
use dwell_scene::rays::RayScene;
use glam::{Quat, Vec3};
use std::f32::consts::{PI, TAU};
use std::ops::Range;

/// Shadow rays shorter than this count as so long, m: it bounds the variance that a near surface brings.
const NEAREST_M: f32 = 0.1;
/// No ray is followed further than this many reflections.
const MOST_REFLECTIONS: usize = 20_000;

/// What all rays of one trace have in common.
pub(super) struct Walk<'a> {
    pub(super) scene: &'a AcousticScene,
    pub(super) rays: &'a RayScene,
    pub(super) source: Vec3,
    pub(super) receiver: Vec3,
    pub(super) radius_m: f32,
    pub(super) turn: Quat,
    pub(super) bins_per_m: f32,
    pub(super) furthest_m: f32,
    pub(super) bin_count: usize,
    /// Energy re the start below which rays are thinned out.
    pub(super) roulette: f32,
}

impl Walk<'_> {
    /// Traces the rays of `range`, at most a chunk.
    pub(super) fn chunk(&self, range: Range<usize>, key: Key) -> Chunk {
        debug_assert!(range.len() <= RAYS_PER_CHUNK);
        let mut chunk = Chunk {
            bins: vec![Deposit::default(); self.bin_count],
            segments: 0,
            escaped: 0,
            length_m: 0.0,
        };
        let mut stream = key.stream();
        let count = self.scene.config().rays;
        for k in range {
            let direction = self.turn * fibonacci_direction(k, count);
            self.ray(direction, 1.0 / count as f32, &mut stream, &mut chunk);
        }
        chunk
    }

    /// Follows one ray that starts with `power`, the source's being 1.
    fn ray(&self, direction: Vec3, power: f32, stream: &mut Stream, chunk: &mut Chunk) {
        let images = self.scene.config().image_order;
        let mut ray = Ray::new(self.source, direction);
        let mut energy: Banded = [power; BAND_COUNT];
        let mut travelled_m = 0.0;
        let (mut scattered, mut specular_last, mut order) = (false, false, 0);
        for _ in 0..MOST_REFLECTIONS {
            let hit = self.rays.closest(&ray, RayMask::EAR);
            let reach_m = hit.map_or(f32::INFINITY, |hit| hit.distance_m);
            if specular_last
                && (scattered || order > images)
                && let Some((middle_m, chord_m)) = self.crossing(&ray, reach_m)
            {
                let volume = 4.0 / 3.0 * PI * self.radius_m * self.radius_m * self.radius_m;
                let factor = 4.0 * PI * chord_m / volume;
                self.deposit(
                    chunk,
                    travelled_m + middle_m,
                    &energy,
                    factor,
                    -ray.direction,
                );
            }
            let Some(hit) = hit else {
                chunk.escaped += 1;
                return;
            };
            chunk.segments += 1;
            chunk.length_m += f64::from(hit.distance_m);
            travelled_m += hit.distance_m;
            if travelled_m >= self.furthest_m {
                return;
            }
            let surface = self.rays.surface(&hit);
            let material = *self.scene.surface(surface.material);
            multiply(&mut energy, &material.kept);
            let point = ray.at(hit.distance_m);
            let normal = if surface.normal.dot(ray.direction) > 0.0 {
                -surface.normal
            } else {
                surface.normal
            };
            let start = point + normal * margin_m(point);
            if material.scatters {
                self.shine(
                    start,
                    normal,
                    travelled_m,
                    &energy,
                    &material.scattering,
                    chunk,
                );
            }
            let mean = energy.iter().sum::<f32>() / (BAND_COUNT as f32 * power);
            if mean < self.roulette {
                let survival = mean / self.roulette;
                if survival < 1e-3 || stream.uniform_f32() >= survival {
                    return;
                }
                energy = energy.map(|e| e / survival);
            }
            // The fraction of this ray's energy that is scattered: with it, both branches keep the sum over the bands, and no
            // band's weight can grow from reflection to reflection.
            let all: f32 = energy.iter().sum();
            let scattered_part: f32 = energy
                .iter()
                .zip(material.scattering)
                .map(|(e, s)| e * s)
                .sum();
            let scatter = (scattered_part / all).clamp(0.0, 1.0);
            if scatter > 0.0 && stream.uniform_f32() < scatter {
                multiply(&mut energy, &material.scattering.map(|s| s / scatter));
                ray = Ray::new(start, lambert(normal, stream));
                (scattered, specular_last) = (true, false);
            } else {
                let kept = 1.0 - scatter;
                multiply(&mut energy, &material.scattering.map(|s| (1.0 - s) / kept));
                let mirrored = ray.direction - 2.0 * ray.direction.dot(normal) * normal;
                ray = Ray::new(start, mirrored);
                specular_last = true;
                order += 1;
            }
        }
    }

    /// Counts what the surface at `start` scatters straight to the receiver.
    fn shine(
        &self,
        start: Vec3,
        normal: Vec3,
        travelled_m: f32,
        energy: &Banded,
        scattering: &Banded,
        chunk: &mut Chunk,
    ) {
        let way = self.receiver - start;
        let distance_m = way.length();
        let cosine = normal.dot(way) / distance_m;
        // A receiver on the very surface has no cosine (0 / 0).
        if cosine.is_nan() || cosine <= 0.0 || travelled_m + distance_m >= self.furthest_m {
            return;
        }
        let direction = way / distance_m;
        let shadow = Ray {
            origin: start,
            direction,
            near_m: 0.0,
            far_m: distance_m,
        };
        if self.rays.occluded(&shadow, RayMask::EAR) {
            return;
        }
        let nearest = distance_m.max(NEAREST_M);
        let mut share = *energy;
        multiply(&mut share, scattering);
        let factor = 4.0 * cosine / (nearest * nearest);
        self.deposit(chunk, travelled_m + distance_m, &share, factor, -direction);
    }

    fn deposit(&self, chunk: &mut Chunk, way_m: f32, energy: &Banded, factor: f32, from: Vec3) {
        if let Some(bin) = chunk.bins.get_mut((way_m * self.bins_per_m) as usize) {
            let mut all = 0.0;
            for (total, e) in bin.energy.iter_mut().zip(energy) {
                let share = e * factor;
                *total += share;
                all += share;
            }
            bin.all += all;
            bin.from += from * all;
        }
    }

    /// Where a ray crosses the receiver's sphere before `reach_m`: distance to the chord's middle, and its length, m.
    fn crossing(&self, ray: &Ray, reach_m: f32) -> Option<(f32, f32)> {
        let to_center = self.receiver - ray.origin;
        let along = to_center.dot(ray.direction);
        let miss_squared = (to_center - ray.direction * along).length_squared();
        let half = (self.radius_m * self.radius_m - miss_squared)
            .max(0.0)
            .sqrt();
        let (enter, leave) = ((along - half).max(0.0), (along + half).min(reach_m));
        (half > 0.0 && leave > enter).then_some((0.5 * (enter + leave), leave - enter))
    }
}

fn multiply(energy: &mut Banded, factors: &Banded) {
    for (e, factor) in energy.iter_mut().zip(factors) {
        *e *= factor;
    }
}

/// A direction above a surface with the density of Lambert's cosine law.
fn lambert(normal: Vec3, stream: &mut Stream) -> Vec3 {
    let u = stream.uniform_f32();
    let (s, c) = sin_cos(TAU * stream.uniform_f32());
    let (tangent, bitangent) = normal.any_orthonormal_pair();
    let r = u.sqrt();
    tangent * (r * c) + bitangent * (r * s) + normal * (1.0 - u).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The mean cosine of Lambert's law is 2/3, its mean square 1/2; five seeds, five standard errors.
    #[test]
    fn scattered_directions_follow_lambert() {
        let normal = Vec3::new(0.36, 0.48, 0.8);
        for seed in 0..5 {
            let mut stream = Key::root(seed).stream();
            let n = 40_000;
            let (mut first, mut second, mut across) = (0.0_f64, 0.0_f64, Vec3::ZERO);
            for _ in 0..n {
                let direction = lambert(normal, &mut stream);
                let cosine = f64::from(direction.dot(normal));
                assert!((direction.length() - 1.0).abs() < 1e-5);
                first += cosine;
                second += cosine * cosine;
                across += direction - normal * cosine as f32;
            }
            let n = f64::from(n);
            assert!((first / n - 2.0 / 3.0).abs() < 5.0 * (1.0 / 18.0 / n).sqrt());
            assert!((second / n - 0.5).abs() < 5.0 * (1.0 / 12.0 / n).sqrt());
            assert!(f64::from(across.length()) / n < 5.0 * (0.5 / n).sqrt());
        }
    }
}
