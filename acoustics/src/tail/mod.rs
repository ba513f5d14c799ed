//! Late sound: rays from the source whose energy is counted at the receivers.
//!
//! Every path is counted by exactly one technique: purely specular paths up to the order of the images by
//! [`images`](crate::images); paths whose last reflection scatters by a shadow ray from that reflection to the receiver;
//! all others (last reflection specular, after a scattering one or beyond the order of the images) where they cross a ball
//! around the receiver.

mod listener;
pub(crate) mod spans;
mod walk;

use crate::bands::{BAND_COUNT, Banded};
use crate::directions::{CELL_COUNT, Directions};
use crate::echogram::{Histogram, SPAN_COUNT, TraceStatistics};
use crate::receiver::Source;
use crate::scene::AcousticScene;
use dwell_scene::math::sin_cos;
use dwell_scene::parallel::Threads;
use dwell_scene::random::{Key, Stream};
use dwell_scene::rays::RayScene;
use glam::{Quat, Vec3};
use listener::Listener;
use spans::Scatter;
use walk::Walk;

/// Rays that are traced and summed together, and split and end among themselves; a constant, so that sums do not depend on threads.
const RAYS_PER_CHUNK: usize = 64;
/// Chunks between two looks at the error.
const CHUNKS_PER_WAVE: usize = 32;
/// Bytes of the sums that are held at once.
const MOST_BYTES: usize = 64 << 20;
/// The chance that a ray that meets a wall also goes on behind it: over the hundred reflections of a ray less than 1, so that rays
/// behind walls behind walls do not become ever more.
const THROUGH: f32 = 0.005;
/// Rays that look around from a receiver, at most and at least.
const PROBES: (usize, usize) = (128, 512);
/// How far a probe that leaves the house counts, m.
const OPEN_AIR_M: f32 = 20.0;
/// Time over which directions are summed, s.
const DIRECTION_S: f64 = 0.02;

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
    on_sphere(y, k as f64 * 0.618_033_988_749_894_9)
}

/// Direction `k` of a sequence every beginning of which covers the sphere evenly.
///
/// # Source
/// M. Roberts, *The Unreasonable Effectiveness of Quasirandom Sequences* (2018): the additive recurrence of the plastic number,
/// mapped to the sphere by equal areas.
fn sequence_direction(k: usize, (u, v): (f64, f64)) -> Vec3 {
    let place = |start: f64, step: f64| {
        let x = start + k as f64 * step;
        x - x.floor()
    };
    let y = 1.0 - 2.0 * place(u, 0.754_877_666_246_692_7);
    on_sphere(y, place(v, 0.569_840_290_998_053_2))
}

/// The unit vector at height `y` and some turns about the vertical.
fn on_sphere(y: f64, turns: f64) -> Vec3 {
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

/// The energy tail at one receiver, and how it was found.
pub(crate) struct Late {
    pub(crate) histogram: Histogram,
    pub(crate) statistics: TraceStatistics,
}

/// What a chunk of rays brings, each ray of power 1.
struct Chunk {
    /// Shape (receiver, bin), flat.
    energy: Vec<Banded>,
    /// Shape (receiver, time, cell), flat.
    directions: Vec<Banded>,
    /// What each ray brings over time, with all that it splits into. Shape (receiver, ray of a chunk, span), flat but for the last.
    by_ray: Vec<[f32; SPAN_COUNT]>,
    segments: u64,
    escaped: u64,
    length_m: f64,
}

/// Sums over chunks at one receiver.
#[derive(Clone)]
struct Sums {
    energy: Vec<[f64; BAND_COUNT]>,
    directions: Vec<Banded>,
    /// Sum and sum of squares of the chunks' energies.
    moments: [[f64; BAND_COUNT]; 2],
    scatter: Scatter,
}

impl Sums {
    /// Standard error of the mean over the mean. Shape (band,).
    fn relative_error(&self, chunks: usize) -> [f64; BAND_COUNT] {
        let n = chunks as f64;
        std::array::from_fn(|band| {
            let (mean, square) = (self.moments[0][band] / n, self.moments[1][band] / n);
            if mean <= 0.0 || chunks < 2 {
                return 0.0;
            }
            ((square - mean * mean).max(0.0) / (n - 1.0)).sqrt() / mean
        })
    }
}

/// Traces the tails from `source` to `receivers`, all by the same `count` rays.
///
/// # Source
/// D. Schroeder, *Physically Based Real-Time Auralization of Interactive Virtual Environments*, RWTH Aachen (2011),
/// chapter 5 (diffuse rain), here in the limit of a small receiver.
pub(crate) fn trace(
    scene: &AcousticScene,
    rays: &RayScene,
    source: &Source,
    receivers: &[Vec3],
    count: usize,
    key: Key,
    threads: Threads,
) -> Vec<Late> {
    let config = scene.config();
    let speed = config.air.speed_of_sound_m_s();
    let bin_count = config.bin_count();
    let bins_per_direction = ((DIRECTION_S / config.bin_s).round() as usize).max(1);
    let times = bin_count.div_ceil(bins_per_direction);
    let probes = config.discovery_rays.clamp(PROBES.0, PROBES.1);
    let listeners = threads.map(receivers.len(), |k| {
        let (radius_m, source) = (config.receiver_radius_m, source.position());
        Listener::new(rays, source, receivers[k], radius_m, probes)
    });
    let hidden = listeners.iter().any(|listener| listener.hidden);
    let mut start = key.child("turn").stream();
    let (axis, pattern) = scene.effects().radiation(source, speed);
    let walk = Walk {
        scene,
        rays,
        source: source.position(),
        axis,
        pattern,
        listeners: &listeners,
        turn: random_rotation(&mut start),
        place: (start.uniform(), start.uniform()),
        bins_per_m: (1.0 / (speed * config.bin_s)) as f32,
        furthest_m: (speed * config.max_duration_s) as f32,
        bin_count,
        span_of_bin: spans::of_bins(bin_count, config.bin_s),
        bins_per_direction,
        times,
        roulette: libm::pow(10.0, -0.1 * config.roulette_db) as f32,
        through: if config.transmission && hidden {
            THROUGH
        } else {
            0.0
        },
    };
    let mut sums = vec![
        Sums {
            energy: vec![[0.0; BAND_COUNT]; bin_count],
            directions: vec![[0.0; BAND_COUNT]; times * CELL_COUNT],
            moments: [[0.0; BAND_COUNT]; 2],
            scatter: Scatter::default(),
        };
        receivers.len()
    ];
    let chunks = count.div_ceil(RAYS_PER_CHUNK);
    let bytes = receivers.len() * (bin_count + times * CELL_COUNT) * size_of::<Banded>();
    let at_once = (MOST_BYTES / bytes.max(1)).clamp(1, CHUNKS_PER_WAVE);
    let (mut segments, mut escaped, mut length_m) = (0, 0, 0.0);
    let mut first = 0;
    while first < chunks {
        // Pieces of a wave differ with memory, what is done with them does not.
        let wave_end = (first / CHUNKS_PER_WAVE + 1) * CHUNKS_PER_WAVE;
        let pieces = at_once.min(chunks.min(wave_end) - first);
        let done = threads.map(pieces, |k| {
            let start = (first + k) * RAYS_PER_CHUNK;
            let end = (start + RAYS_PER_CHUNK).min(count);
            walk.chunk(start..end, key.child("chunk").child((first + k) as u64))
        });
        for chunk in &done {
            segments += chunk.segments;
            escaped += chunk.escaped;
            length_m += chunk.length_m;
            for (receiver, sums) in sums.iter_mut().enumerate() {
                sums.add(chunk, receiver, bin_count, times);
            }
        }
        first += pieces;
        if config.max_error > 0.0 && first == wave_end {
            let worst = sums
                .iter()
                .flat_map(|sums| sums.relative_error(first))
                .fold(0.0, f64::max);
            if worst <= config.max_error {
                break;
            }
        }
    }
    let traced = (first * RAYS_PER_CHUNK).min(count);
    let statistics = TraceStatistics {
        rays: traced as u64,
        segments,
        escaped,
        mean_free_path_m: length_m / (segments.max(1)) as f64,
        ..TraceStatistics::default()
    };
    let decay = scene.air_decay_per_m();
    let late = sums.into_iter().zip(&listeners).map(|(sums, listener)| {
        let relative_error = sums.relative_error(first).map(|e| e as f32);
        let error_over_time = sums.scatter.relative_error(traced);
        let mut bins = sums.energy;
        for (k, bin) in bins.iter_mut().enumerate() {
            // All that arrives in a bin has come about equally far, so that air can be applied at the end.
            let way_m = (k as f64 + 0.5) * config.bin_s * speed;
            for (e, m) in bin.iter_mut().zip(decay) {
                *e *= libm::exp(-m * way_m) / traced.max(1) as f64;
            }
        }
        let cells = sums.directions.chunks_exact(CELL_COUNT);
        Late {
            histogram: Histogram {
                bin_s: config.bin_s,
                bins,
                bins_per_direction,
                directions: cells
                    .map(|cells| Directions {
                        energy: cells.to_vec(),
                    })
                    .collect(),
            },
            statistics: TraceStatistics {
                relative_error,
                error_over_time,
                receiver_radius_m: listener.largest_m(),
                seen_volume_m3: listener.seen_volume_m3,
                ..statistics
            },
        }
    });
    late.collect()
}

impl Sums {
    /// Adds what a chunk brought to receiver `receiver`.
    fn add(&mut self, chunk: &Chunk, receiver: usize, bins: usize, times: usize) {
        let mut all = [0.0; BAND_COUNT];
        let energy = &chunk.energy[receiver * bins..(receiver + 1) * bins];
        for (sum, bin) in self.energy.iter_mut().zip(energy) {
            for ((total, all), e) in sum.iter_mut().zip(&mut all).zip(bin) {
                *total += f64::from(*e);
                *all += f64::from(*e);
            }
        }
        for (band, all) in all.into_iter().enumerate() {
            self.moments[0][band] += all;
            self.moments[1][band] += all * all;
        }
        let rays = receiver * RAYS_PER_CHUNK..(receiver + 1) * RAYS_PER_CHUNK;
        self.scatter.add(&chunk.by_ray[rays]);
        let cells = times * CELL_COUNT;
        let directions = &chunk.directions[receiver * cells..(receiver + 1) * cells];
        for (sum, cell) in self.directions.iter_mut().zip(directions) {
            for (total, e) in sum.iter_mut().zip(cell) {
                *total += e;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_cover_the_sphere_evenly() {
        let n = 5000;
        let lattice: Vec<Vec3> = (0..n).map(|k| fibonacci_direction(k, n)).collect();
        let sequence: Vec<Vec3> = (0..n).map(|k| sequence_direction(k, (0.3, 0.8))).collect();
        for (directions, tolerance) in [
            (&lattice[..], 1e-3),
            (&sequence, 3e-3),
            (&sequence[..640], 1e-2),
        ] {
            let n = directions.len() as f32;
            let mean = directions.iter().sum::<Vec3>() / n;
            assert!(mean.length() < tolerance, "{mean}");
            for axis in [Vec3::X, Vec3::Y, Vec3::new(0.6, 0.0, 0.8)] {
                let second: f32 = directions.iter().map(|d| d.dot(axis).powi(2)).sum::<f32>() / n;
                assert!((second - 1.0 / 3.0).abs() < tolerance);
            }
        }
    }
}
