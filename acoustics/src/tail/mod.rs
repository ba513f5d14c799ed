//! Late sound: rays from the source whose energy is detected at the receivers.
//!
//! Every path is counted by exactly one technique: purely specular paths up to the order of the images by
//! [`images`](crate::image_sources); paths whose last reflection scatters by a shadow ray from that reflection to the
//! receiver; all others (last reflection specular, after a scattering one or beyond the order of the images) where they
//! cross a detection sphere around the receiver.

mod ray_tracer;
mod receiver_volume;
pub(crate) mod spans;

use crate::bands::{BAND_COUNT, BandValues};
use crate::config::AcousticConfig;
use crate::directions::{CELL_COUNT, DirectionalEnergy};
use crate::echogram::{EnergyHistogram, RayStatistics, SPAN_COUNT};
use crate::propagation_scene::PropagationScene;
use crate::receiver::SoundSourcePose;
use dwell_scene::math::sin_cos;
use dwell_scene::parallel::Threads;
use dwell_scene::random::{RandomKey, RandomStream};
use dwell_scene::rays::RayScene;
use glam::{Quat, Vec3};
use ray_tracer::RayTracer;
use receiver_volume::DetectionVolume;
use serde::{Deserialize, Serialize};
use spans::SpanVariance;

/// Rays that are traced and summed together, and split and end among themselves; a constant, so that sums do not depend on threads.
const RAYS_PER_CHUNK: usize = 64;
/// Chunks between tests of the error.
const CHUNKS_PER_WAVE: usize = 32;
/// Most bytes of the sums in memory at once.
const MOST_BYTES: usize = 64 << 20;
/// Probability that a ray that hits a wall also goes on behind it: over the hundred reflections of a ray less than 1, so
/// that rays behind several walls do not multiply.
const TRANSMISSION_PROBABILITY: f32 = 0.005;
/// Rays that probe the surroundings of a receiver, at least and at most.
const PROBES: (usize, usize) = (128, 512);
/// Distance that a probe counts that leaves the house, m.
const OPEN_AIR_M: f32 = 20.0;
/// Interval over which directions are summed, s.
const DIRECTION_S: f64 = 0.02;

/// Returns a uniformly distributed rotation.
///
/// # Source
/// K. Shoemake, Graphics Gems III (1992), p. 124.
fn random_rotation(stream: &mut RandomStream) -> Quat {
    let u = stream.uniform_f32();
    let (s1, c1) = sin_cos(std::f32::consts::TAU * stream.uniform_f32());
    let (s2, c2) = sin_cos(std::f32::consts::TAU * stream.uniform_f32());
    let (a, b) = ((1.0 - u).sqrt(), u.sqrt());
    Quat::from_xyzw(a * s1, a * c1, b * s2, b * c2).normalize()
}

/// The energy tail at one receiver, and its statistics.
pub(crate) struct LateReverberation {
    pub(crate) histogram: EnergyHistogram,
    pub(crate) statistics: RayStatistics,
}

/// The energy received from a chunk of rays, each of power 1.
struct RayChunkEnergy {
    /// Shape (receiver, bin), flat.
    energy: Vec<BandValues>,
    /// Shape (receiver, time, cell), flat.
    directions: Vec<BandValues>,
    /// The energy from each ray over time, with all that it splits into. Shape (receiver, ray of a chunk, span), flat but for the last.
    by_ray: Vec<[f32; SPAN_COUNT]>,
    segments: u64,
    escaped: u64,
    length_m: f64,
}

/// Sums over chunks at one receiver.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct ReceiverSums {
    energy: Vec<[f64; BAND_COUNT]>,
    directions: Vec<BandValues>,
    /// Sum and sum of squares of the chunks' energies.
    moments: [[f64; BAND_COUNT]; 2],
    scatter: SpanVariance,
}

impl ReceiverSums {
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

/// The sums over the rays of a [`TailTrace`] so far.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct TraceProgress {
    /// Number of chunks traced.
    chunks: usize,
    /// Set once the error is small enough.
    converged: bool,
    segments: u64,
    escaped: u64,
    length_m: f64,
    /// Shape (receiver,).
    sums: Vec<ReceiverSums>,
}

impl TraceProgress {
    /// The state before the first ray.
    pub(crate) fn new(config: &AcousticConfig, receivers: usize) -> Self {
        let sums = ReceiverSums {
            energy: vec![[0.0; BAND_COUNT]; config.bin_count()],
            directions: vec![[0.0; BAND_COUNT]; direction_bin_count(config) * CELL_COUNT],
            moments: [[0.0; BAND_COUNT]; 2],
            scatter: SpanVariance::default(),
        };
        Self {
            chunks: 0,
            converged: false,
            segments: 0,
            escaped: 0,
            length_m: 0.0,
            sums: vec![sums; receivers],
        }
    }

    /// Returns the number of traced rays, in whole chunks.
    pub(crate) fn rays(&self) -> usize {
        self.chunks.saturating_mul(RAYS_PER_CHUNK)
    }

    /// Returns whether [`TailTrace::advance`] by `most` rays traces the last of `count`.
    pub(crate) fn ends_within(&self, count: usize, most: usize) -> bool {
        let left = count.div_ceil(RAYS_PER_CHUNK).saturating_sub(self.chunks);
        (most / RAYS_PER_CHUNK).max(1) >= left
    }

    /// Returns whether it is valid for one receiver: continuing from a damaged snapshot must not panic.
    pub(crate) fn is_valid(&self, config: &AcousticConfig) -> bool {
        let energy = |e: &f64| e.is_finite() && *e >= 0.0;
        let sums = |sums: &ReceiverSums| {
            let directions = sums.directions.iter().flatten();
            sums.energy.len() == config.bin_count()
                && sums.directions.len() == direction_bin_count(config) * CELL_COUNT
                && sums.energy.iter().flatten().all(energy)
                && directions.map(|e| f64::from(*e)).all(|e| energy(&e))
                && sums.moments.iter().flatten().all(energy)
                && sums.scatter.is_valid()
        };
        let all = u64::try_from(self.chunks).unwrap_or(u64::MAX) <= 1 << 40;
        self.sums.len() == 1
            && all
            && self.segments <= 1 << 60
            && self.escaped <= 1 << 60
            && energy(&self.length_m)
            && self.sums.iter().all(sums)
    }
}

/// Returns the bins that share one entry of directions.
fn bins_per_direction(config: &AcousticConfig) -> usize {
    ((DIRECTION_S / config.bin_s).round() as usize).max(1)
}

/// Returns the entries of directions over time.
fn direction_bin_count(config: &AcousticConfig) -> usize {
    config.bin_count().div_ceil(bins_per_direction(config))
}

/// The tails from one source to some receivers, all with the same rays.
pub(crate) struct TailTrace<'a> {
    data: &'a PropagationScene,
    rays: &'a RayScene,
    source: &'a SoundSourcePose,
    listeners: Vec<DetectionVolume>,
    /// Number of rays.
    count: usize,
    key: RandomKey,
    threads: Threads,
}

/// Traces the tails from `source` to `receivers`, all with the same `count` rays.
pub(crate) fn trace(
    data: &PropagationScene,
    rays: &RayScene,
    source: &SoundSourcePose,
    receivers: &[Vec3],
    count: usize,
    key: RandomKey,
    threads: Threads,
) -> Vec<LateReverberation> {
    let trace = TailTrace::new(data, rays, source, receivers, count, key, threads);
    let mut progress = TraceProgress::new(data.config(), receivers.len());
    trace.advance(&mut progress, usize::MAX);
    trace.finish(progress)
}

impl<'a> TailTrace<'a> {
    /// Probes the surroundings of the receivers.
    pub(crate) fn new(
        data: &'a PropagationScene,
        rays: &'a RayScene,
        source: &'a SoundSourcePose,
        receivers: &[Vec3],
        count: usize,
        key: RandomKey,
        threads: Threads,
    ) -> Self {
        let config = data.config();
        let probes = config.discovery_rays.clamp(PROBES.0, PROBES.1);
        let listeners = threads.map(receivers.len(), |k| {
            let (radius_m, source) = (config.receiver_radius_m, source.position());
            DetectionVolume::new(rays, source, receivers[k], radius_m, probes)
        });
        Self {
            data,
            rays,
            source,
            listeners,
            count,
            key,
            threads,
        }
    }

    /// Traces up to `most` more rays, whole chunks of them and at least one: returns `true` when all are traced. The result
    /// is the same to the bit in whatever pieces they are traced.
    ///
    /// # Source
    /// D. Schroeder, *Physically Based Real-Time Auralization of Interactive Virtual Environments*, RWTH Aachen (2011),
    /// chapter 5 (diffuse rain), here in the limit of a small receiver.
    pub(crate) fn advance(&self, progress: &mut TraceProgress, most: usize) -> bool {
        let (config, key) = (self.data.config(), self.key);
        let speed = config.air.speed_of_sound_m_s();
        let (bin_count, times) = (config.bin_count(), direction_bin_count(config));
        let hidden = self.listeners.iter().any(|listener| listener.is_occluded);
        let mut start = key.child("turn").stream();
        let (axis, pattern) = self
            .data
            .effects()
            .source_axis_and_pattern(self.source, speed);
        let walk = RayTracer {
            data: self.data,
            rays: self.rays,
            source: self.source.position(),
            axis,
            pattern,
            listeners: &self.listeners,
            sequence_rotation: random_rotation(&mut start),
            sequence_offset: (start.uniform(), start.uniform()),
            bins_per_m: (1.0 / (speed * config.bin_s)) as f32,
            max_distance_m: (speed * config.max_duration_s) as f32,
            bin_count,
            span_of_bin: spans::spans_of_bins(bin_count, config.bin_s),
            bins_per_direction: bins_per_direction(config),
            direction_time_bins: times,
            roulette_threshold: libm::pow(10.0, -0.1 * config.roulette_db) as f32,
            wall_probability: if config.transmission && hidden {
                TRANSMISSION_PROBABILITY
            } else {
                0.0
            },
        };
        let chunks = self.count.div_ceil(RAYS_PER_CHUNK);
        let more = (most / RAYS_PER_CHUNK).max(1);
        let end = chunks.min(progress.chunks.saturating_add(more));
        let bytes =
            self.listeners.len() * (bin_count + times * CELL_COUNT) * size_of::<BandValues>();
        let at_once = (MOST_BYTES / bytes.max(1)).clamp(1, CHUNKS_PER_WAVE);
        while progress.chunks < end && !progress.converged {
            let first = progress.chunks;
            // The pieces of a wave depend on memory, the results do not.
            let wave_end = (first / CHUNKS_PER_WAVE + 1) * CHUNKS_PER_WAVE;
            let pieces = at_once.min(end.min(wave_end) - first);
            let done = self.threads.map(pieces, |k| {
                let start = (first + k) * RAYS_PER_CHUNK;
                let end = (start + RAYS_PER_CHUNK).min(self.count);
                walk.trace_chunk(start..end, key.child("chunk").child((first + k) as u64))
            });
            for chunk in &done {
                progress.segments += chunk.segments;
                progress.escaped += chunk.escaped;
                progress.length_m += chunk.length_m;
                for (receiver, sums) in progress.sums.iter_mut().enumerate() {
                    sums.add(chunk, receiver, bin_count, times);
                }
            }
            progress.chunks += pieces;
            if config.max_error > 0.0 && progress.chunks == wave_end {
                let errors = progress.sums.iter();
                let errors = errors.flat_map(|sums| sums.relative_error(wave_end));
                progress.converged = errors.fold(0.0, f64::max) <= config.max_error;
            }
        }
        progress.chunks >= chunks || progress.converged
    }

    /// Returns the tails of all rays so far. Shape (receiver,).
    pub(crate) fn finish(&self, progress: TraceProgress) -> Vec<LateReverberation> {
        let config = self.data.config();
        let speed = config.air.speed_of_sound_m_s();
        let chunks = progress.chunks;
        let traced = chunks.saturating_mul(RAYS_PER_CHUNK).min(self.count);
        let statistics = RayStatistics {
            rays: traced as u64,
            segments: progress.segments,
            escaped: progress.escaped,
            mean_free_path_m: progress.length_m / (progress.segments.max(1)) as f64,
            ..RayStatistics::default()
        };
        let decay = self.data.air_decay_per_m();
        let both = progress.sums.into_iter().zip(&self.listeners);
        let late = both.map(|(sums, listener)| {
            let relative_error = sums.relative_error(chunks).map(|e| e as f32);
            let error_over_time = sums.scatter.relative_error(traced);
            let mut bins = sums.energy;
            for (k, bin) in bins.iter_mut().enumerate() {
                // All energy in a bin has travelled about equally far, so that absorption by air can be applied at the end.
                let way_m = (k as f64 + 0.5) * config.bin_s * speed;
                for (e, m) in bin.iter_mut().zip(decay) {
                    *e *= libm::exp(-m * way_m) / traced.max(1) as f64;
                }
            }
            let cells = sums.directions.chunks_exact(CELL_COUNT);
            LateReverberation {
                histogram: EnergyHistogram {
                    bin_s: config.bin_s,
                    bins,
                    bins_per_direction: bins_per_direction(config),
                    directions: cells
                        .map(|cells| DirectionalEnergy {
                            energy: cells.to_vec(),
                        })
                        .collect(),
                },
                statistics: RayStatistics {
                    relative_error,
                    error_over_time,
                    receiver_radius_m: listener.max_radius_m(),
                    visible_volume_m3: listener.visible_volume_m3,
                    ..statistics
                },
            }
        });
        late.collect()
    }
}

impl ReceiverSums {
    /// Adds a chunk's energy at receiver `receiver`.
    fn add(&mut self, chunk: &RayChunkEnergy, receiver: usize, bins: usize, times: usize) {
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
