//! Diffraction around edges: door frames, the ends of walls, tables, doors ajar.
//!
//! Where the source is out of sight, a path leads around each edge that hides it, or around two in turn. Edges that do not
//! hide it but are close to the straight line attenuate the sound, in sight or not, so that nothing jumps at the shadow
//! boundary. Waves that go around two sides of an obstacle and whose lengths differ by less than a quarter of their
//! wavelength are one wave.

mod edge_path;
mod insertion_loss;

use crate::bands::BAND_COUNT;
use crate::echogram::PropagationPath;
use crate::planes::DiffractionEdge;
use crate::propagation_scene::PropagationScene;
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::rays::RayScene;
use edge_path::{EdgeFrame, EdgePath};
use glam::{DVec3, Vec3};

/// Longest detour of a path over the straight line, m.
const LONGEST_DETOUR_M: f64 = 4.0;
/// Most edges that are tried for one pair of points, those that add least to the straight way.
const MOST_EDGES: usize = 64;
/// Ends of the ranges of least detours in which edges are tried, as shares of the longest.
const DETOUR_RANGES: [f64; 5] = [1.0 / 16.0, 1.0 / 8.0, 1.0 / 4.0, 1.0 / 2.0, 1.0];
/// Rounding of detours, m.
const DETOUR_ROUNDING_M: f64 = 1e-9;
/// Most pairs of edges that are tried.
const MOST_PAIRS: usize = 16;
/// Most paths, the strongest first.
const MOST_WAYS: usize = 6;
/// Distance within which parallel edges act as one rounded edge, m.
const PROFILE_M: f64 = 0.3;
/// Distance of rays from the edge that they lead to or from, m: finer profiles of frames do not hide it.
const STAND_OFF_M: f64 = 0.02;
/// Largest detour of an edge that attenuates the sound beside it, in wavelengths.
const BESIDE_WAVES: f64 = 0.1;
/// Paths with less energy than this fraction of a free path's in all bands are dropped.
const FAINTEST: f64 = 1e-6;

/// One path around an obstacle.
struct DiffractionPath {
    /// Points on edges, from the source on.
    touches: Vec<EdgePoint>,
    detour_m: f64,
    /// Amplitude over that of a free path of its length. Shape (band,).
    amplitude: [f64; BAND_COUNT],
}

/// The point at which a path touches an edge.
#[derive(Clone, Copy)]
struct EdgePoint {
    at: DVec3,
    along: DVec3,
    /// Offset from the straight line.
    aside: DVec3,
}

impl EdgePoint {
    fn new(frame: &EdgeFrame, at: DVec3, from: DVec3, to: DVec3) -> Self {
        let line = (to - from).normalize_or_zero();
        let there = at - from;
        Self {
            at,
            along: frame.direction(),
            aside: there - line * line.dot(there),
        }
    }

    /// Returns whether both belong to one profile: parallel, close together, and on one side of the straight line.
    fn is_same_profile(&self, other: &Self) -> bool {
        self.at.distance(other.at) < PROFILE_M
            && self.along.dot(other.along).abs() > 0.9
            && self.aside.dot(other.aside) > 0.0
    }
}

/// Returns the paths from `source` around edges to `receiver`, which is out of sight.
pub(crate) fn diffracted_paths(
    data: &PropagationScene,
    rays: &RayScene,
    source: Vec3,
    receiver: Vec3,
) -> Vec<PropagationPath> {
    let n_per_m = insertion_loss::fresnel_numbers_per_m(data.config().air.speed_of_sound_m_s());
    let (from, to) = (source.as_dvec3(), receiver.as_dvec3());
    let sight = |a, b| is_free(rays, a, b);
    let mut ways = Vec::new();
    let mut seen: Vec<(&EdgeFrame, &EdgePath, [bool; 2])> = Vec::new();
    let near = near_edges(data, from, to, LONGEST_DETOUR_M, |bend| {
        // A point within the solid of an edge may be reached over a second one.
        bend.ends_in_air[0] != bend.ends_in_air[1]
            || (bend.is_occluded && bend.ends_in_air == [true; 2])
    });
    for (frame, bend) in &near {
        let at = bend.point + frame.outward() * STAND_OFF_M;
        let sees = [
            bend.ends_in_air[0] && sight(from, at),
            bend.ends_in_air[1] && sight(at, to),
        ];
        if sees == [true; 2] && bend.is_occluded {
            ways.push(DiffractionPath {
                touches: vec![EdgePoint::new(frame, bend.point, from, to)],
                detour_m: bend.detour_m,
                amplitude: bend.transmitted_energy(&n_per_m).map(f64::sqrt),
            });
        } else if sees != [false; 2] {
            seen.push((frame, bend, sees));
        }
    }
    let mut pairs = Vec::new();
    for (a, _, _) in seen.iter().filter(|(_, _, sees)| sees[0]) {
        for (b, _, _) in seen.iter().filter(|(_, _, sees)| sees[1]) {
            if a.is_parallel(b)
                && let Some(bend) = a.doubly_diffracted_path(b, from, to)
                && bend.detour_m < LONGEST_DETOUR_M
            {
                pairs.push((*a, *b, bend));
            }
        }
    }
    pairs.sort_by(|(_, _, a), (_, _, b)| a.detour_m.total_cmp(&b.detour_m));
    for (a, b, bend) in pairs.into_iter().take(MOST_PAIRS) {
        let first = bend.points[0] + a.outward() * STAND_OFF_M;
        let second = bend.points[1] + b.outward() * STAND_OFF_M;
        if sight(from, first) && sight(first, second) && sight(second, to) {
            ways.push(DiffractionPath {
                amplitude: bend.transmitted_energy(&n_per_m).map(f64::sqrt),
                touches: vec![
                    EdgePoint::new(a, bend.points[0], from, to),
                    EdgePoint::new(b, bend.points[1], from, to),
                ],
                detour_m: bend.detour_m,
            });
        }
    }
    let mut ways = strongest_per_profile(ways);
    if ways.is_empty() {
        return Vec::new();
    }
    let touched: Vec<EdgePoint> = ways.iter().flat_map(|way| way.touches.clone()).collect();
    let kept = grazing_edge_transmission(data, rays, source, receiver, &touched);
    sum_coherent_paths(&mut ways, &n_per_m);
    for way in &mut ways {
        for (amplitude, kept) in way.amplitude.iter_mut().zip(kept) {
            *amplitude *= kept.sqrt();
        }
    }
    ways.retain(|way| way.amplitude.iter().any(|a| a * a > FAINTEST));
    let straight_m = from.distance(to);
    let towards = |from: DVec3, to: DVec3| (to - from).normalize_or_zero().as_vec3();
    let paths = ways.into_iter().map(|way| {
        let length_m = straight_m + way.detour_m;
        let mut energy = data.air_energy_loss(length_m);
        for (e, amplitude) in energy.iter_mut().zip(way.amplitude) {
            *e *= amplitude * amplitude;
        }
        PropagationPath {
            planes: Vec::new(),
            length_m,
            energy: energy.map(|e| e as f32),
            arrival: towards(to, way.touches[way.touches.len() - 1].at),
            departure: towards(from, way.touches[0].at),
            diffraction_points: way.touches.iter().map(|touch| touch.at.as_vec3()).collect(),
            walls: 0,
            inverted: false,
        }
    });
    paths.collect()
}

/// Returns the share of the sound from a `source` in sight that edges beside the straight line pass. Shape (band,).
pub(crate) fn line_of_sight_transmission(
    data: &PropagationScene,
    rays: &RayScene,
    source: Vec3,
    receiver: Vec3,
) -> [f64; BAND_COUNT] {
    grazing_edge_transmission(data, rays, source, receiver, &[])
}

/// Returns the share of the sound that edges close to the straight line pass that hide nothing, except those of profiles
/// that are `touched` anyway. Shape (band,).
fn grazing_edge_transmission(
    data: &PropagationScene,
    rays: &RayScene,
    source: Vec3,
    receiver: Vec3,
    touched: &[EdgePoint],
) -> [f64; BAND_COUNT] {
    let n_per_m = insertion_loss::fresnel_numbers_per_m(data.config().air.speed_of_sound_m_s());
    let (from, to) = (source.as_dvec3(), receiver.as_dvec3());
    let longest_m = BESIDE_WAVES * 2.0 / n_per_m[0];
    let near = near_edges(data, from, to, longest_m, |bend| {
        !bend.is_occluded && bend.forward_weight > 0.0 && bend.ends_in_air == [true; 2]
    });
    let mut kept = [1.0; BAND_COUNT];
    let mut taken = touched.to_vec();
    for (frame, bend) in &near {
        // Of the edges of one profile the nearest acts.
        let touch = EdgePoint::new(frame, bend.point, from, to);
        if taken.iter().any(|other| other.is_same_profile(&touch)) {
            continue;
        }
        let off = bend.point + frame.outward() * STAND_OFF_M;
        if !(is_free(rays, from, off) && is_free(rays, off, to)) {
            continue;
        }
        taken.push(touch);
        for (kept, n_per_m) in kept.iter_mut().zip(n_per_m) {
            let lost = 1.0 - insertion_loss::transmitted_energy(-n_per_m * bend.detour_m);
            *kept *= 1.0 - lost * bend.finite_length_factor(n_per_m) * bend.forward_weight;
        }
    }
    kept
}

fn is_free(rays: &RayScene, a: DVec3, b: DVec3) -> bool {
    !rays.occluded(&Ray::segment(a.as_vec3(), b.as_vec3(), 0.0), RayMask::EAR)
}

/// Returns the edges that are `wanted` and add at most `longest_m` to the straight way: of more than [`MOST_EDGES`] those that
/// add least. Sorted by the detour over their lines, which goes on beyond their ends.
///
/// A way over an edge is no shorter than one over its middle less its length. Edges are tried in the order of that bound, a
/// range of it at a time, until enough lie within the ranges tried.
fn near_edges(
    data: &PropagationScene,
    from: DVec3,
    to: DVec3,
    longest_m: f64,
    wanted: impl Fn(&EdgePath) -> bool,
) -> Vec<(EdgeFrame, EdgePath)> {
    let straight_m = from.distance(to);
    let added_m = |point: DVec3| from.distance(point) + point.distance(to) - straight_m;
    let bounds = data.edges().map(|edge| {
        let [a, b] = edge.ends.map(Vec3::as_dvec3);
        (added_m(0.5 * (a + b)) - a.distance(b), edge)
    });
    let bounds: Vec<(f64, &DiffractionEdge)> = bounds
        .filter(|(least_m, _)| *least_m <= longest_m)
        .collect();
    // What each adds, its place among the edges, its frame and path.
    let mut near: Vec<(f64, usize, EdgeFrame, EdgePath)> = Vec::new();
    let mut tried_m = f64::NEG_INFINITY;
    for range in DETOUR_RANGES {
        let upto_m = longest_m * range;
        let in_range = |least_m: f64| tried_m < least_m && least_m <= upto_m;
        for (k, (least_m, edge)) in bounds.iter().enumerate() {
            if !in_range(*least_m) {
                continue;
            }
            let frame = EdgeFrame::new(edge);
            if let Some(bend) = frame.diffracted_path(from, to)
                && bend.detour_m <= longest_m
                && added_m(bend.point) <= longest_m
                && wanted(&bend)
            {
                near.push((added_m(bend.point), k, frame, bend));
            }
        }
        tried_m = upto_m;
        let within = |one: &&(f64, usize, EdgeFrame, EdgePath)| one.0 < upto_m - DETOUR_ROUNDING_M;
        if near.iter().filter(within).count() >= MOST_EDGES {
            break;
        }
    }
    near.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    near.truncate(MOST_EDGES);
    near.sort_by(|a, b| a.3.detour_m.total_cmp(&b.3.detour_m).then(a.1.cmp(&b.1)));
    near.into_iter()
        .map(|(_, _, frame, bend)| (frame, bend))
        .collect()
}

/// Returns the strongest paths, one of each profile.
fn strongest_per_profile(mut ways: Vec<DiffractionPath>) -> Vec<DiffractionPath> {
    let power = |way: &DiffractionPath| way.amplitude.iter().map(|a| a * a).sum::<f64>();
    ways.sort_by(|a, b| power(b).total_cmp(&power(a)));
    let mut kept: Vec<DiffractionPath> = Vec::new();
    for way in ways {
        let same = |other: &DiffractionPath| {
            let near = |touch: &EdgePoint| {
                other
                    .touches
                    .iter()
                    .any(|there| there.is_same_profile(touch))
            };
            way.touches.iter().any(near)
        };
        if !kept.iter().any(same) {
            kept.push(way);
        }
        if kept.len() == MOST_WAYS {
            break;
        }
    }
    kept
}

/// Adds, in each band, the waves whose lengths differ by less than a quarter wavelength from the strongest one to it.
fn sum_coherent_paths(ways: &mut [DiffractionPath], n_per_m: &[f64; BAND_COUNT]) {
    for (band, n_per_m) in n_per_m.iter().enumerate() {
        let amplitude = |way: &DiffractionPath| way.amplitude[band];
        let strongest = (0..ways.len()).reduce(|a, b| {
            if amplitude(&ways[b]) > amplitude(&ways[a]) {
                b
            } else {
                a
            }
        });
        let Some(main) = strongest else { return };
        let mut sum = amplitude(&ways[main]);
        for k in (0..ways.len()).filter(|k| *k != main) {
            let apart_m = (ways[k].detour_m - ways[main].detour_m).abs();
            // Half a wavelength is one Fresnel number.
            let share = (1.0 - 2.0 * apart_m * n_per_m).max(0.0);
            sum += share * amplitude(&ways[k]);
            ways[k].amplitude[band] *= (1.0 - share * share).sqrt();
        }
        ways[main].amplitude[band] = sum;
        // Together they carry no more energy than a free path.
        let all = ways
            .iter()
            .map(|way| way.amplitude[band] * way.amplitude[band]);
        let all = all.sum::<f64>();
        if all > 1.0 {
            for way in ways.iter_mut() {
                way.amplitude[band] /= all.sqrt();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{EdgeFrame, LONGEST_DETOUR_M, MOST_EDGES, near_edges};
    use crate::AcousticConfig;
    use crate::propagation_scene::PropagationScene;
    use dwell_scene::random::RandomKey;
    use glam::{DVec3, Vec3};
    use std::sync::Arc;

    /// Against every edge tried, between 200 pairs of places in a furnished house.
    #[test]
    fn near_edges_are_those_that_add_least() {
        let (house, _) = dwell_houses::open("seed:2").unwrap();
        let bounds = house.data().rooms.iter().map(|room| room.bounds);
        let bounds = bounds.reduce(|a, b| a.union(&b)).unwrap();
        let data = PropagationScene::new(Arc::new(house), AcousticConfig::full());
        let mut stream = RandomKey::root(5).stream();
        let mut place = || {
            let share = Vec3::new(
                stream.uniform_f32(),
                stream.uniform_f32(),
                stream.uniform_f32(),
            );
            (bounds.min + share * (bounds.max - bounds.min)).as_dvec3()
        };
        let mut full = 0;
        for _ in 0..200 {
            let (from, to) = (place(), place());
            let added_m = |at: DVec3| from.distance(at) + at.distance(to) - from.distance(to);
            let paths = data
                .edges()
                .filter_map(|edge| EdgeFrame::new(edge).diffracted_path(from, to));
            let near = |longest_m: f64| {
                let near = near_edges(&data, from, to, longest_m, |_| true);
                let mut near: Vec<f64> = near.iter().map(|(_, path)| added_m(path.point)).collect();
                near.sort_by(f64::total_cmp);
                near
            };
            let all: Vec<_> = paths.collect();
            for longest_m in [0.2, 1.0, LONGEST_DETOUR_M] {
                let short = all.iter().filter(|path| path.detour_m <= longest_m);
                let added = short.map(|path| added_m(path.point));
                let mut added: Vec<f64> = added.filter(|added_m| *added_m <= longest_m).collect();
                added.sort_by(f64::total_cmp);
                added.truncate(MOST_EDGES);
                full += usize::from(added.len() == MOST_EDGES);
                assert_eq!(near(longest_m), added);
            }
        }
        assert!(full > 50, "{full}");
    }
}
