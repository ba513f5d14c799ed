//! Tracing of rays through the house.

use super::receiver_volume::DetectionVolume;
use super::{RAYS_PER_CHUNK, RayChunkEnergy};
use crate::bands::{BAND_COUNT, BandValues};
use crate::directions::{CELL_COUNT, direction_cell};
use crate::directivity::TabulatedPattern;
use crate::echogram::SPAN_COUNT;
use crate::propagation_scene::PropagationScene;
use crate::ray_margin::ray_offset_m;
use crate::sphere_sequences::direction_in_sequence;
use crate::surface::ReflectedEnergy;
use crate::transmission;
use dwell_scene::bvh::{Hit, Ray, RayMask};
use dwell_scene::random::{RandomKey, RandomStream};
use dwell_scene::rays::RayScene;
use dwell_scene::{interrupt, math::sin_cos};
use glam::{Quat, Vec3};
use std::f32::consts::TAU;
use std::ops::Range;

/// Least length of shadow rays, m: it bounds the variance of near surfaces.
const NEAREST_M: f32 = 0.1;
/// Probability that a surface sends shadow rays through walls.
const WALL_SHADOW_RAY_PROBABILITY: f32 = 0.1;
/// Least area of walls and doors, m².
const WALL_M2: f32 = 0.5;
/// Most reflections of a ray.
const MOST_REFLECTIONS: usize = 20_000;
/// Least energy: its inverse is still finite.
const FAINTEST: f32 = 1e-30;
/// Distance between two tests of the spread of energies, m: about two reflections in a living room.
const STAGE_M: f32 = 5.0;

/// The inputs common to all rays of one trace.
pub(super) struct RayTracer<'a> {
    pub(super) data: &'a PropagationScene,
    pub(super) rays: &'a RayScene,
    pub(super) source: Vec3,
    /// The source's axis and its gains around it.
    pub(super) axis: Vec3,
    pub(super) pattern: TabulatedPattern,
    pub(super) listeners: &'a [DetectionVolume],
    pub(super) sequence_rotation: Quat,
    /// Offset of the sequence of directions.
    pub(super) sequence_offset: (f64, f64),
    pub(super) bins_per_m: f32,
    pub(super) max_distance_m: f32,
    pub(super) bin_count: usize,
    /// Shape (bin,).
    pub(super) span_of_bin: Vec<usize>,
    pub(super) bins_per_direction: usize,
    /// Entries of directions over time.
    pub(super) direction_time_bins: usize,
    /// Energy of a band in all rays of a chunk, re the start, below which it counts less and rays become fewer.
    pub(super) roulette_threshold: f32,
    /// Probability that a ray also goes on behind a wall; 0 without a receiver there.
    pub(super) wall_probability: f32,
}

/// Random streams: of rays that never went through a wall, and of all others.
struct RayRandom<'a> {
    own: &'a mut RandomStream,
    aside: &'a mut RandomStream,
}

impl RayRandom<'_> {
    fn stream_for(&mut self, one: &TracedRay) -> &mut RandomStream {
        if one.walls == 0 { self.own } else { self.aside }
    }
}

/// A ray with its energy and history.
#[derive(Clone)]
struct TracedRay {
    ray: Ray,
    energy: BandValues,
    /// Index of its original ray in the chunk.
    origin: usize,
    /// Number of reflections, those before splits included.
    reflections: usize,
    travelled_m: f32,
    /// Distance since the source or the last scattering, m.
    straight_m: f32,
    /// True if it was ever scattered, and if its last reflection was specular.
    scattered: bool,
    mirrored: bool,
    /// Number of specular reflections.
    order: usize,
    /// Number of walls that it passed.
    walls: usize,
}

impl RayTracer<'_> {
    /// Traces the rays of `range`, at most a chunk.
    pub(super) fn trace_chunk(&self, range: Range<usize>, key: RandomKey) -> RayChunkEnergy {
        debug_assert!(range.len() <= RAYS_PER_CHUNK);
        let receivers = self.listeners.len();
        let mut chunk = RayChunkEnergy {
            energy: vec![[0.0; BAND_COUNT]; receivers * self.bin_count],
            directions: vec![[0.0; BAND_COUNT]; receivers * self.direction_time_bins * CELL_COUNT],
            by_ray: vec![[0.0; SPAN_COUNT]; receivers * RAYS_PER_CHUNK],
            segments: 0,
            escaped: 0,
            length_m: 0.0,
        };
        let mut stream = key.stream();
        // Transmission has its own random stream, so that the rest is the same with and without it.
        let mut aside = key.child("walls").stream();
        let first = range.start;
        let start = range.map(|k| {
            let direction = self.sequence_rotation * direction_in_sequence(k, self.sequence_offset);
            let energy = self.pattern.gain(direction.dot(self.axis)).map(|g| g * g);
            TracedRay::new(Ray::new(self.source, direction), energy, k - first)
        });
        let mut beyond = Vec::new();
        let random = &mut RayRandom {
            own: &mut stream,
            aside: &mut aside,
        };
        let start = start.filter(|one| one.energy.iter().any(|e| *e > 0.0));
        let start = start.collect();
        self.trace_rays(start, random, &mut chunk, &mut beyond);
        while let Some(one) = beyond.pop() {
            self.trace_rays(vec![one], random, &mut chunk, &mut beyond);
        }
        chunk
    }

    /// Traces rays to their ends, stage by stage; rays behind walls are added to `beyond`.
    fn trace_rays(
        &self,
        mut rays: Vec<TracedRay>,
        random: &mut RayRandom<'_>,
        chunk: &mut RayChunkEnergy,
        beyond: &mut Vec<TracedRay>,
    ) {
        let Some(begin_m) = rays.first().map(|one| one.travelled_m) else {
            return;
        };
        let count = rays.len();
        let least = sum(&rays).map(|all| self.roulette_threshold * all);
        let mut worth = band_importance(&rays, &least);
        let mut next = Vec::with_capacity(count);
        for stage in 1_u16.. {
            let end_m = begin_m + f32::from(stage) * STAGE_M;
            let last = end_m >= self.max_distance_m;
            for one in rays.drain(..) {
                next.extend(self.follow(one, end_m, &worth, random, chunk, beyond));
            }
            let Some(one) = next.first() else { return };
            if last {
                return;
            }
            let place = random.stream_for(one).uniform_f32();
            worth = self::band_importance(&next, &least);
            resample(&next, count, &worth, place, &mut rays);
            next.clear();
        }
    }

    /// Traces one ray to its first reflection beyond `end_m`.
    fn follow(
        &self,
        mut one: TracedRay,
        end_m: f32,
        worth: &BandValues,
        random: &mut RayRandom<'_>,
        chunk: &mut RayChunkEnergy,
        beyond: &mut Vec<TracedRay>,
    ) -> Option<TracedRay> {
        let images = self.data.config().image_order;
        while one.travelled_m < end_m {
            interrupt::unwind_if_cancelled();
            if one.reflections == MOST_REFLECTIONS {
                return None;
            }
            let hit = self.rays.closest(&one.ray, RayMask::EAR);
            // Image sources are not transmitted.
            if one.mirrored && (one.scattered || one.order > images || one.walls > 0) {
                let reach_m = hit.map_or(f32::INFINITY, |hit| hit.distance_m);
                self.record_crossings(&one, reach_m, random.stream_for(&one), chunk);
            }
            let Some(hit) = hit else {
                // Behind an outer wall is the open air.
                chunk.escaped += u64::from(one.walls == 0);
                return None;
            };
            if one.walls == 0 {
                chunk.segments += 1;
                chunk.length_m += f64::from(hit.distance_m);
            }
            one.travelled_m += hit.distance_m;
            one.straight_m += hit.distance_m;
            if one.travelled_m >= self.max_distance_m {
                return None;
            }
            let surface = self.rays.surface(&hit);
            let material = self.data.surface(surface.material);
            if self.wall_probability > 0.0 && material.transmitted.iter().any(|p| *p > 0.0) {
                self.spawn_transmitted(&one, &hit, random.aside, beyond);
            }
            let point = one.ray.point_at(hit.distance_m);
            let cosine = surface.normal.dot(one.ray.direction);
            let normal = if cosine > 0.0 {
                -surface.normal
            } else {
                surface.normal
            };
            let scattering =
                self.data
                    .scattering(material, &hit, cosine.abs(), f64::from(one.straight_m));
            let parts = material.reflected_energy(cosine.abs(), &scattering);
            let start = point + normal * ray_offset_m(point);
            if scattering.iter().any(|s| *s > 0.0) {
                self.add_diffuse_rain(start, normal, &one, &parts.scattered, random.aside, chunk);
            }
            let stream = random.stream_for(&one);
            if !one.reflect(start, normal, &parts, worth, stream) {
                return None;
            }
        }
        Some(one)
    }

    /// Counts the energy that the surface at `start` scatters directly to the receivers.
    fn add_diffuse_rain(
        &self,
        start: Vec3,
        normal: Vec3,
        one: &TracedRay,
        scattered: &BandValues,
        aside: &mut RandomStream,
        chunk: &mut RayChunkEnergy,
    ) {
        let looks_through =
            self.wall_probability > 0.0 && aside.uniform_f32() < WALL_SHADOW_RAY_PROBABILITY;
        for (receiver, listener) in self.listeners.iter().enumerate() {
            if one.walls > 0 && !listener.is_occluded {
                continue;
            }
            let way = listener.position - start;
            let distance_m = way.length();
            let cosine = normal.dot(way) / distance_m;
            let way_m = one.travelled_m + distance_m;
            // A receiver on the surface itself has no cosine (0 / 0).
            if cosine.is_nan() || cosine <= 0.0 || way_m >= self.max_distance_m {
                continue;
            }
            let direction = way / distance_m;
            let shadow = Ray {
                origin: start,
                direction,
                near_m: 0.0,
                far_m: distance_m,
            };
            let mut share = one.energy;
            if self.rays.occluded(&shadow, RayMask::EAR) {
                if !(looks_through && listener.is_occluded) {
                    continue;
                }
                let (data, rays) = (self.data, self.rays);
                let passed = transmission::transmitted_path(data, rays, start, listener.position);
                let Some((passed, _)) = passed else {
                    continue;
                };
                multiply(&mut share, &passed.map(|p| p / WALL_SHADOW_RAY_PROBABILITY));
            }
            let nearest = distance_m.max(NEAREST_M);
            multiply(&mut share, scattered);
            // Lambert's law, 4 pi E s cos / (pi r²): the limit of diffuse rain for a small receiver.
            let factor = 4.0 * cosine / (nearest * nearest);
            let from = -direction;
            self.deposit(chunk, (receiver, one.origin), way_m, &share, factor, from);
        }
    }

    /// With a small probability, lets the transmitted sound go on behind a wall.
    fn spawn_transmitted(
        &self,
        one: &TracedRay,
        hit: &Hit,
        aside: &mut RandomStream,
        beyond: &mut Vec<TracedRay>,
    ) {
        if one.walls == transmission::MAX_WALLS || aside.uniform_f32() >= self.wall_probability {
            return;
        }
        // Furniture does not separate rooms.
        let panel = self.data.plane_table().panel(self.data.house(), hit);
        if panel.area_m2 < WALL_M2 {
            return;
        }
        let Some(exit) = transmission::exit_behind_wall(self.data, self.rays, &one.ray, hit) else {
            return;
        };
        let mut energy = one.energy;
        let passed = exit.transmitted_energy.map(|p| p / self.wall_probability);
        multiply(&mut energy, &passed);
        let inside_m = exit.start.distance(one.ray.point_at(hit.distance_m));
        beyond.push(TracedRay {
            ray: Ray::new(exit.start, one.ray.direction),
            energy,
            travelled_m: one.travelled_m + inside_m,
            straight_m: one.straight_m + inside_m,
            walls: one.walls + 1,
            ..*one
        });
    }

    /// Counts a ray where it crosses the detection spheres of receivers.
    fn record_crossings(
        &self,
        one: &TracedRay,
        reach_m: f32,
        stream: &mut RandomStream,
        chunk: &mut RayChunkEnergy,
    ) {
        // Drawn once, so that a receiver's energies do not depend on the others.
        let place = stream.uniform_f32();
        for (receiver, listener) in self.listeners.iter().enumerate() {
            if one.walls > 0 && !listener.is_occluded {
                continue;
            }
            let Some(crossing) = listener.sphere_crossing(
                &one.ray,
                reach_m - ray_offset_m(one.ray.origin),
                one.travelled_m,
            ) else {
                continue;
            };
            // Only the visible part of the sphere counts: one point of the segment represents it.
            let along = crossing.enter_m + place * (crossing.leave_m - crossing.enter_m);
            let point = one.ray.point_at(along);
            let sight = Ray::segment(listener.position, point, 0.0);
            if self.rays.occluded(&sight, RayMask::EAR) {
                continue;
            }
            let way_m = one.travelled_m + 0.5 * (crossing.enter_m + crossing.leave_m);
            let from = -one.ray.direction;
            let to = (receiver, one.origin);
            self.deposit(chunk, to, way_m, &one.energy, crossing.factor, from);
        }
    }

    fn deposit(
        &self,
        chunk: &mut RayChunkEnergy,
        (receiver, origin): (usize, usize),
        way_m: f32,
        energy: &BandValues,
        factor: f32,
        from: Vec3,
    ) {
        let bin = (way_m * self.bins_per_m) as usize;
        if bin >= self.bin_count {
            return;
        }
        let all = energy.iter().sum::<f32>() * factor;
        chunk.by_ray[receiver * RAYS_PER_CHUNK + origin][self.span_of_bin[bin]] += all;
        let time = receiver * self.direction_time_bins + bin / self.bins_per_direction;
        let cell = &mut chunk.directions[time * CELL_COUNT + direction_cell(from)];
        let bin = &mut chunk.energy[receiver * self.bin_count + bin];
        for ((total, cell), e) in bin.iter_mut().zip(cell).zip(energy) {
            *total += e * factor;
            *cell += e * factor;
        }
    }
}

/// Returns the energy of all rays. Shape (band,).
fn sum(rays: &[TracedRay]) -> BandValues {
    let mut sum = [0.0; BAND_COUNT];
    for one in rays {
        for (all, e) in sum.iter_mut().zip(&one.energy) {
            *all += e;
        }
    }
    sum
}

/// Returns the weight of energy in each band: all bands have weight 1, until they fall below their `least`. Shape (band,).
fn band_importance(rays: &[TracedRay], least: &BandValues) -> BandValues {
    let all = sum(rays);
    std::array::from_fn(|band| {
        let all = all[band].max(least[band]);
        if all > FAINTEST { 1.0 / all } else { 0.0 }
    })
}

/// Replaces the rays of `from` by rays of equal weight: strong ones split, weak ones end or represent others. `count`:
/// their number while no band is below its least; then there are fewer. While their weights are about equal, all stay as
/// they are. `place`: a random number, 0 to 1.
///
/// After some reflections, most energy is in a few rays. After splitting, they hit different surfaces.
///
/// # Source
/// G. Kitagawa, J. Comput. Graph. Stat. 5, 1 (1996), appendix: stratified resampling, here with equal distances ("systematic"); when
/// half of the effective number is lost: A. Kong, J. S. Liu, W. H. Wong, J. Am. Stat. Assoc. 89, 278 (1994).
fn resample(
    from: &[TracedRay],
    count: usize,
    worth: &BandValues,
    place: f32,
    into: &mut Vec<TracedRay>,
) {
    let weights = || from.iter().map(|one| one.weight(worth));
    let (all, squares): (f32, f32) = (weights().sum(), weights().map(|w| w * w).sum());
    let bands = worth.iter().filter(|worth| **worth > 0.0).count();
    if bands == 0 {
        return;
    }
    let each = bands as f32 / count as f32;
    // The full number, of which at least half are effective.
    if all > 0.99 * bands as f32 && all * all > 0.5 * count as f32 * squares {
        into.extend_from_slice(from);
        return;
    }
    // A mark at every `each` of the total weight, from a random offset on.
    let mut mark = place * each;
    let mut passed = 0.0;
    for (one, weight) in from.iter().zip(weights()) {
        passed += weight;
        while mark < passed && into.len() <= count {
            mark += each;
            let mut copy = one.clone();
            copy.energy = one.energy.map(|e| e * (each / weight));
            into.push(copy);
        }
    }
}

impl TracedRay {
    /// Ray `origin` of its chunk, at the source.
    fn new(ray: Ray, energy: BandValues, origin: usize) -> Self {
        Self {
            ray,
            energy,
            origin,
            reflections: 0,
            travelled_m: 0.0,
            straight_m: 0.0,
            scattered: false,
            mirrored: false,
            order: 0,
            walls: 0,
        }
    }

    /// Returns its weight.
    fn weight(&self, worth: &BandValues) -> f32 {
        self.energy
            .iter()
            .zip(worth)
            .map(|(e, worth)| e * worth)
            .sum()
    }

    /// Reflects the ray, scattered or specular; `false` where no energy is left.
    ///
    /// The scattered fraction of this ray's reflected energy is the probability: with it, both branches keep the sum over
    /// the bands, and no band's weight can grow from reflection to reflection.
    fn reflect(
        &mut self,
        start: Vec3,
        normal: Vec3,
        parts: &ReflectedEnergy,
        worth: &BandValues,
        stream: &mut RandomStream,
    ) -> bool {
        let part = |of: &BandValues| -> f32 {
            let energy = self.energy.iter().zip(worth).map(|(e, worth)| e * worth);
            energy.zip(of).map(|(e, part)| e * part).sum()
        };
        let (scattered, mirrored) = (part(&parts.scattered), part(&parts.specular));
        if scattered + mirrored <= 0.0 {
            return false;
        }
        self.reflections += 1;
        let scatter = (scattered / (scattered + mirrored)).clamp(0.0, 1.0);
        if scatter > 0.0 && stream.uniform_f32() < scatter {
            multiply(&mut self.energy, &parts.scattered.map(|s| s / scatter));
            self.ray = Ray::new(start, lambert(normal, stream));
            (self.scattered, self.mirrored, self.straight_m) = (true, false, 0.0);
        } else {
            let kept = 1.0 - scatter;
            multiply(&mut self.energy, &parts.specular.map(|m| m / kept));
            let direction = self.ray.direction;
            self.ray = Ray::new(start, direction - 2.0 * direction.dot(normal) * normal);
            self.mirrored = true;
            self.order += 1;
        }
        true
    }
}

fn multiply(energy: &mut BandValues, factors: &BandValues) {
    for (e, factor) in energy.iter_mut().zip(factors) {
        *e *= factor;
    }
}

/// Draws a direction above a surface with the density of Lambert's cosine law.
fn lambert(normal: Vec3, stream: &mut RandomStream) -> Vec3 {
    let u = stream.uniform_f32();
    let (s, c) = sin_cos(TAU * stream.uniform_f32());
    let (tangent, bitangent) = normal.any_orthonormal_pair();
    let r = u.sqrt();
    tangent * (r * c) + bitangent * (r * s) + normal * (1.0 - u).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ray of some energy in all bands.
    fn ray(energy: f32) -> TracedRay {
        let energy = std::array::from_fn(|band| energy * (1.0 + band as f32));
        TracedRay::new(Ray::new(Vec3::ZERO, Vec3::X), energy, 0)
    }

    /// Over all offsets, every ray's energy is reproduced, whether rays are split or thinned; equal ones stay as they are.
    #[test]
    fn resampling_keeps_what_every_ray_stands_for() {
        let from: Vec<TracedRay> = (0..16)
            .map(|k| TracedRay {
                origin: k,
                ..ray(if k == 3 { 40.0 } else { 0.1 + k as f32 })
            })
            .collect();
        let start = sum(&from);
        // All energy, and a tenth of it: the rays are as many, or about a tenth.
        for (least, many) in [(0.1, 16.0), (10.0, 1.6)] {
            let worth = band_importance(&from, &start.map(|all| least * all));
            let (mut found, mut rays) = ([0.0_f64; 16], 0);
            let places = 1000;
            for k in 0..places {
                let place = (k as f32 + 0.5) / places as f32;
                let mut into = Vec::new();
                resample(&from, 16, &worth, place, &mut into);
                rays += into.len();
                for one in into {
                    found[one.origin] += f64::from(one.energy[2]) / f64::from(places);
                }
            }
            assert!(
                (rays as f64 / f64::from(places) - many).abs() < 0.02,
                "{rays}"
            );
            for (found, one) in found.iter().zip(&from) {
                let wanted = f64::from(one.energy[2]);
                assert!((found / wanted - 1.0).abs() < 0.03, "{found} for {wanted}");
            }
        }
        let alike = vec![ray(1.0); 9];
        let mut into = Vec::new();
        resample(
            &alike,
            9,
            &band_importance(&alike, &[0.0; BAND_COUNT]),
            0.5,
            &mut into,
        );
        assert!(into.len() == 9 && into.iter().all(|one| one.energy == ray(1.0).energy));
    }

    /// Energy that is inaudible, and too small to divide by, counts as none.
    #[test]
    fn the_faintest_rays_end() {
        let mut into = Vec::new();
        let faint = vec![ray(1e-38); 4];
        let worth = band_importance(&faint, &[0.0; BAND_COUNT]);
        resample(&faint, 4, &worth, 0.5, &mut into);
        assert!(into.is_empty());
    }

    /// The mean cosine of Lambert's law is 2/3, its mean square 1/2; five seeds, five standard errors.
    #[test]
    fn scattered_directions_follow_lambert() {
        let normal = Vec3::new(0.36, 0.48, 0.8);
        for seed in 0..5 {
            let mut stream = RandomKey::root(seed).stream();
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
