//! Late sound: rays from the source whose energy is counted at the receiver.
//!
//! Every path is counted by exactly one technique: purely specular paths up to the order of the images by
//! [`images`](crate::images); paths whose last reflection scatters by a shadow ray from that reflection to the receiver;
//! all others (last reflection specular, after a scattering one or beyond the order of the images) where they cross a
//! small sphere around the receiver.

mod walk;

use crate::bands::{BAND_COUNT, Banded};
use crate::echogram::{Bin, Histogram, TraceStatistics};
use crate::scene::AcousticScene;
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::math::sin_cos;
use dwell_scene::parallel::Threads;
use dwell_scene::random::{Key, Stream};
use dwell_scene::rays::RayScene;
use glam::{Quat, Vec3};
use walk::Walk;

/// Rays that are traced and summed together; a constant, so that sums do not depend on threads.
const RAYS_PER_CHUNK: usize = 64;
/// Chunks whose sums are held at once.
const CHUNKS_PER_WAVE: usize = 64;
/// Rays that look around from the receiver.
const PROBES: usize = 128;
/// How far a probe that leaves the house counts, m.
const OPEN_AIR_M: f32 = 20.0;

/// How far a ray starts off the surface at `point`, m: more than what f32 loses there.
pub(crate) fn margin_m(point: Vec3) -> f32 {
    1e-4 * point.abs().max_element().max(1.0)
}

/// Direction `k` of `count` that cover the sphere evenly.
///
/// # Source
/// R. Swinbank, R. J. Purser, Q. J. R. Meteorol. Soc. 132, 1769 (2006): the Fibonacci lattice.
pub(crate) fn fibonacci_direction(k: usize, count: usize) -> Vec3 {
    let y = 1.0 - (2 * k + 1) as f64 / count.max(1) as f64;
    let turns = k as f64 * 0.618_033_988_749_894_9;
    let angle = std::f64::consts::TAU * (turns - turns.floor());
    let r = (1.0 - y * y).max(0.0).sqrt();
    Vec3::new(
        (r * libm::cos(angle)) as f32,
        y as f32,
        (r * libm::sin(angle)) as f32,
    )
}

/// A rotation, uniform over all.
///
/// # Source
/// K. Shoemake, Graphics Gems III (1992), p. 124.
fn random_rotation(stream: &mut Stream) -> Quat {
    let u = stream.uniform_f32();
    let (s1, c1) = sin_cos(std::f32::consts::TAU * stream.uniform_f32());
    let (s2, c2) = sin_cos(std::f32::consts::TAU * stream.uniform_f32());
    let (a, b) = ((1.0 - u).sqrt(), u.sqrt());
    Quat::from_xyzw(a * s1, a * c1, b * s2, b * c2).normalize()
}

/// The energy tail and how it was found.
pub(crate) struct Late {
    pub(crate) histogram: Histogram,
    pub(crate) statistics: TraceStatistics,
}

/// What a chunk of rays brings to a bin: energy per band, and over all bands with its direction.
#[derive(Clone, Copy, Default)]
struct Deposit {
    energy: Banded,
    from: Vec3,
    all: f32,
}

/// What a chunk of rays brings.
struct Chunk {
    bins: Vec<Deposit>,
    segments: u64,
    escaped: u64,
    length_m: f64,
}

/// Distances around the receiver: to the nearest surface, and the volume in sight.
fn look_around(rays: &RayScene, receiver: Vec3) -> (f64, f64) {
    let (mut nearest, mut cubes) = (f64::INFINITY, 0.0);
    for k in 0..PROBES {
        let ray = Ray::new(receiver, fibonacci_direction(k, PROBES));
        let hit = rays.closest(&ray, RayMask::EAR);
        let distance = f64::from(hit.map_or(OPEN_AIR_M, |hit| hit.distance_m));
        nearest = nearest.min(distance);
        cubes += distance * distance * distance;
    }
    let volume = 4.0 / 3.0 * std::f64::consts::PI * cubes / PROBES as f64;
    (nearest, volume)
}

/// Traces the tail from `source` to `receiver`.
///
/// # Source
/// D. Schroeder, *Physically Based Real-Time Auralization of Interactive Virtual Environments*, RWTH Aachen (2011),
/// chapter 5 (diffuse rain), here in the limit of a small receiver.
pub(crate) fn trace(
    scene: &AcousticScene,
    rays: &RayScene,
    source: Vec3,
    receiver: Vec3,
    key: Key,
    threads: Threads,
) -> Late {
    let config = scene.config();
    let speed = config.air.speed_of_sound_m_s();
    let bin_count = (config.max_duration_s / config.bin_s).ceil() as usize;
    let (nearest_m, seen_volume_m3) = look_around(rays, receiver);
    // A sphere that reached through a wall would count less than its volume.
    let radius_m = config.receiver_radius_m.min(0.9 * nearest_m).max(0.02);
    let walk = Walk {
        scene,
        rays,
        source,
        receiver,
        radius_m: radius_m as f32,
        turn: random_rotation(&mut key.child("turn").stream()),
        bins_per_m: (1.0 / (speed * config.bin_s)) as f32,
        furthest_m: (speed * config.max_duration_s) as f32,
        bin_count,
        roulette: libm::pow(10.0, -0.1 * config.roulette_db) as f32,
    };
    let chunks = config.rays.div_ceil(RAYS_PER_CHUNK);
    let mut energy = vec![[0.0_f64; BAND_COUNT]; bin_count];
    let mut from = vec![glam::DVec4::ZERO; bin_count];
    let mut statistics = TraceStatistics {
        rays: config.rays as u64,
        receiver_radius_m: radius_m,
        seen_volume_m3,
        ..TraceStatistics::default()
    };
    let mut length_m = 0.0;
    for first in (0..chunks).step_by(CHUNKS_PER_WAVE) {
        let count = CHUNKS_PER_WAVE.min(chunks - first);
        let done = threads.map(count, |k| {
            let start = (first + k) * RAYS_PER_CHUNK;
            let end = (start + RAYS_PER_CHUNK).min(config.rays);
            walk.chunk(start..end, key.child("chunk").child((first + k) as u64))
        });
        for chunk in done {
            statistics.segments += chunk.segments;
            statistics.escaped += chunk.escaped;
            length_m += chunk.length_m;
            for ((energy, from), deposit) in energy.iter_mut().zip(&mut from).zip(&chunk.bins) {
                for (total, e) in energy.iter_mut().zip(deposit.energy) {
                    *total += f64::from(e);
                }
                *from += deposit.from.as_dvec3().extend(f64::from(deposit.all));
            }
        }
    }
    statistics.mean_free_path_m = length_m / (statistics.segments.max(1)) as f64;
    let decay = scene.air_decay_per_m();
    let bins = energy
        .into_iter()
        .zip(from)
        .enumerate()
        .map(|(k, (mut energy, from))| {
            // All that arrives in a bin has come about equally far, so that air can be applied at the end.
            let way_m = (k as f64 + 0.5) * config.bin_s * speed;
            for (e, m) in energy.iter_mut().zip(decay) {
                *e *= libm::exp(-m * way_m);
            }
            let arrival = if from.w > 0.0 {
                (from.truncate() / from.w).as_vec3()
            } else {
                Vec3::ZERO
            };
            Bin { energy, arrival }
        })
        .collect();
    Late {
        histogram: Histogram {
            bin_s: config.bin_s,
            bins,
        },
        statistics,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fibonacci_directions_cover_the_sphere_evenly() {
        let n = 5000;
        let directions: Vec<Vec3> = (0..n).map(|k| fibonacci_direction(k, n)).collect();
        let mean = directions.iter().sum::<Vec3>() / n as f32;
        assert!(mean.length() < 1e-3);
        for axis in [Vec3::X, Vec3::Y, Vec3::new(0.6, 0.0, 0.8)] {
            let second: f32 =
                directions.iter().map(|d| d.dot(axis).powi(2)).sum::<f32>() / n as f32;
            assert!((second - 1.0 / 3.0).abs() < 1e-3);
        }
    }
}
