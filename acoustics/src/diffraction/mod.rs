//! Sound that bends around edges: door frames, the ends of walls, tables, doors ajar.
//!
//! Where the source is out of sight, a path leads around each edge that hides it, or around two in turn; where it is in sight, edges
//! close to the straight line take some of it, so that nothing jumps at the border of the shadow. Waves that go around two sides of
//! an obstacle and come within a quarter of their length are one wave.

mod bend;
mod loss;

use crate::bands::BAND_COUNT;
use crate::echogram::Path;
use crate::images;
use crate::scene::AcousticScene;
use bend::{Bend, Frame};
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::rays::RayScene;
use glam::{DVec3, Vec3};

/// Ways that are this much longer than the straight line are not followed, m.
const LONGEST_DETOUR_M: f64 = 4.0;
/// Edges that are tried for one pair of points, those of the least detours.
const MOST_EDGES: usize = 64;
/// Pairs of edges that are tried.
const MOST_PAIRS: usize = 16;
/// Ways that are followed, the strongest first.
const MOST_WAYS: usize = 6;
/// Edges that are as close together and parallel are one rounded edge to sound, m.
const PROFILE_M: f64 = 0.3;
/// Rays to and from an edge keep this far off it, m: finer profiles of frames do not hide it.
const STAND_OFF_M: f64 = 0.02;
/// The detour up to which an edge takes anything of the sound beside it, in wavelengths.
const BESIDE_WAVES: f64 = 0.1;
/// Ways with less energy than this fraction of a free path's in all bands are dropped.
const FAINTEST: f64 = 1e-6;

/// One way around what hides the source.
struct Way {
    at: Vec<DVec3>,
    along: DVec3,
    detour_m: f64,
    /// Amplitude against a free path of its length. Shape (band,).
    amplitude: [f64; BAND_COUNT],
}

/// The paths from `source` around edges to `receiver`, which does not see it.
pub(crate) fn around_edges(
    scene: &AcousticScene,
    rays: &RayScene,
    source: Vec3,
    receiver: Vec3,
) -> Vec<Path> {
    let n_per_m = loss::per_metre(scene.config().air.speed_of_sound_m_s());
    let (from, to) = (source.as_dvec3(), receiver.as_dvec3());
    let sight = |a: DVec3, b: DVec3| {
        !rays.occluded(&Ray::segment(a.as_vec3(), b.as_vec3(), 0.0), RayMask::EAR)
    };
    let mut ways = Vec::new();
    let mut seen: Vec<(&Frame, &Bend, [bool; 2])> = Vec::new();
    let near = near_edges(scene, from, to, LONGEST_DETOUR_M, |bend| {
        bend.hidden && (bend.open[0] || bend.open[1])
    });
    for (frame, bend) in &near {
        let at = bend.at + frame.outward() * STAND_OFF_M;
        let sees = [
            bend.open[0] && sight(from, at),
            bend.open[1] && sight(at, to),
        ];
        if sees == [true; 2] {
            ways.push(Way {
                at: vec![bend.at],
                along: frame.along(),
                detour_m: bend.detour_m,
                amplitude: bend.passed(&n_per_m).map(f64::sqrt),
            });
        } else if sees != [false; 2] {
            seen.push((frame, bend, sees));
        }
    }
    let mut pairs = Vec::new();
    for (a, _, _) in seen.iter().filter(|(_, _, sees)| sees[0]) {
        for (b, _, _) in seen.iter().filter(|(_, _, sees)| sees[1]) {
            if a.is_parallel(b)
                && let Some(bend) = a.bend_twice(b, from, to)
                && bend.detour_m < LONGEST_DETOUR_M
            {
                pairs.push((*a, *b, bend));
            }
        }
    }
    pairs.sort_by(|(_, _, a), (_, _, b)| a.detour_m.total_cmp(&b.detour_m));
    for (a, b, bend) in pairs.into_iter().take(MOST_PAIRS) {
        let first = bend.at[0] + a.outward() * STAND_OFF_M;
        let second = bend.at[1] + b.outward() * STAND_OFF_M;
        if sight(from, first) && sight(first, second) && sight(second, to) {
            ways.push(Way {
                amplitude: bend.passed(&n_per_m).map(f64::sqrt),
                at: bend.at.to_vec(),
                along: a.along(),
                detour_m: bend.detour_m,
            });
        }
    }
    let mut ways = strongest(ways);
    unite(&mut ways, &n_per_m);
    ways.retain(|way| way.amplitude.iter().any(|a| a * a > FAINTEST));
    let straight_m = from.distance(to);
    let towards = |from: DVec3, to: DVec3| (to - from).normalize_or_zero().as_vec3();
    let paths = ways.into_iter().map(|way| {
        let length_m = straight_m + way.detour_m;
        let mut energy = images::spread(scene, length_m);
        for (e, amplitude) in energy.iter_mut().zip(way.amplitude) {
            *e *= amplitude * amplitude;
        }
        Path {
            planes: Vec::new(),
            length_m,
            energy: energy.map(|e| e as f32),
            arrival: towards(to, way.at[way.at.len() - 1]),
            departure: towards(from, way.at[0]),
            bends: way.at.iter().map(|at| at.as_vec3()).collect(),
            walls: 0,
            inverted: false,
        }
    });
    paths.collect()
}

/// What the edges beside the straight line leave of the sound from a `source` in sight. Shape (band,).
pub(crate) fn beside_edges(
    scene: &AcousticScene,
    rays: &RayScene,
    source: Vec3,
    receiver: Vec3,
) -> [f64; BAND_COUNT] {
    let n_per_m = loss::per_metre(scene.config().air.speed_of_sound_m_s());
    let (from, to) = (source.as_dvec3(), receiver.as_dvec3());
    let longest_m = BESIDE_WAVES * 2.0 / n_per_m[0];
    let near = near_edges(scene, from, to, longest_m, |bend| {
        !bend.hidden && bend.facing > 0.0 && bend.open == [true; 2]
    });
    let mut kept = [1.0; BAND_COUNT];
    let mut taken: Vec<(DVec3, DVec3)> = Vec::new();
    for (frame, bend) in &near {
        // Of the edges of one profile the nearest acts.
        if taken.iter().any(|(at, along)| {
            at.distance(bend.at) < PROFILE_M && along.dot(frame.along()).abs() > 0.9
        }) {
            continue;
        }
        let off = bend.at + frame.outward() * STAND_OFF_M;
        let hidden = [(from, off), (off, to)].into_iter().any(|(a, b)| {
            rays.occluded(&Ray::segment(a.as_vec3(), b.as_vec3(), 0.0), RayMask::EAR)
        });
        if hidden {
            continue;
        }
        taken.push((bend.at, frame.along()));
        for (kept, n_per_m) in kept.iter_mut().zip(n_per_m) {
            let lost = 1.0 - loss::passed(-n_per_m * bend.detour_m);
            *kept *= 1.0 - lost * bend.reach(n_per_m) * bend.facing;
        }
    }
    kept
}

/// The edges over which the way is at most `longest_m` longer and that are `wanted`, by their detours.
fn near_edges(
    scene: &AcousticScene,
    from: DVec3,
    to: DVec3,
    longest_m: f64,
    wanted: impl Fn(&Bend) -> bool,
) -> Vec<(Frame, Bend)> {
    let straight_m = from.distance(to);
    let mut near = Vec::new();
    for edge in scene.edges() {
        let [a, b] = edge.ends.map(|end| end.as_dvec3());
        let middle = 0.5 * (a + b);
        let least_m = from.distance(middle) + middle.distance(to) - a.distance(b);
        if least_m - straight_m > longest_m {
            continue;
        }
        let frame = Frame::new(edge);
        if let Some(bend) = frame.bend(from, to)
            && bend.detour_m <= longest_m
            && bend.at.distance(from) + bend.at.distance(to) - straight_m <= longest_m
            && wanted(&bend)
        {
            near.push((frame, bend));
        }
    }
    near.sort_by(|(_, a), (_, b)| a.detour_m.total_cmp(&b.detour_m));
    near.truncate(MOST_EDGES);
    near
}

/// The strongest ways, one of each profile.
fn strongest(mut ways: Vec<Way>) -> Vec<Way> {
    let power = |way: &Way| way.amplitude.iter().map(|a| a * a).sum::<f64>();
    ways.sort_by(|a, b| power(b).total_cmp(&power(a)));
    let mut kept: Vec<Way> = Vec::new();
    for way in ways {
        let same = |other: &Way| {
            let close = |a: &DVec3| other.at.iter().any(|b| a.distance(*b) < PROFILE_M);
            way.at.iter().any(close) && other.along.dot(way.along).abs() > 0.9
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

/// Adds, in each band, the waves that come within a quarter of their length of the strongest one to it.
fn unite(ways: &mut [Way], n_per_m: &[f64; BAND_COUNT]) {
    for (band, n_per_m) in n_per_m.iter().enumerate() {
        let amplitude = |way: &Way| way.amplitude[band];
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
        ways[main].amplitude[band] = sum.min(1.0);
    }
}
