//! Where fits of times begin: the stretch and the places of walls under which most echoes meet an image of the box.
//!
//! Images are those of an empty box in closed form, for speed; fits go on with the engine's paths.

use super::arrivals::{PickedArrivals, mismatch_s};
use crate::bundle::file::ResponseTimeOrigin;

/// Reflections of the images.
const ORDER: i32 = 4;
/// Stretches that are tried, and their step.
const MOST_STRETCH: f64 = 0.08;
const STRETCH_STEP: f64 = 0.002;
/// Places of walls that are tried, as shares of the edge, and their step, m.
const WALL_RANGE: [f64; 2] = [-0.25, 0.3];
const WALL_STEP_M: f64 = 0.04;
/// Places nearer to what is known are left to the fit.
const NEAR_M: f64 = 0.02;
/// Least distance of a moved wall from sources and microphones, m.
pub(super) const LEAST_DISTANCE_M: f64 = 0.1;

/// A recording in a box.
pub(super) struct BoxRecording<'a> {
    pub(super) source_m: [f64; 3],
    pub(super) receiver_m: [f64; 3],
    pub(super) picked: &'a PickedArrivals,
}

/// The lengths of the images' ways in a box from `low` to `high`, m, rising.
fn image_lengths_m(
    low: [f64; 3],
    high: [f64; 3],
    source: [f64; 3],
    receiver: [f64; 3],
) -> Vec<f64> {
    // Along an axis: distance from the receiver, and reflections.
    let axis = |k: usize| {
        let edge = high[k] - low[k];
        let mut all = Vec::new();
        for n in -ORDER..=ORDER {
            let even = source[k] + 2.0 * f64::from(n) * edge - receiver[k];
            all.push((even, 2 * n.abs()));
            let odd = 2.0 * low[k] - source[k] + 2.0 * f64::from(n) * edge - receiver[k];
            all.push((odd, (2 * n - 1).abs()));
        }
        all.retain(|(_, reflections)| *reflections <= ORDER);
        all
    };
    let (xs, ys, zs) = (axis(0), axis(1), axis(2));
    let mut lengths = Vec::new();
    for (x, nx) in &xs {
        for (y, ny) in &ys {
            for (z, nz) in &zs {
                if nx + ny + nz <= ORDER {
                    lengths.push((x * x + y * y + z * z).sqrt());
                }
            }
        }
    }
    lengths.sort_by(f64::total_cmp);
    lengths
}

/// The echoes' mismatch for these lengths and this speed, in squared seconds.
fn mismatch(
    recording: &BoxRecording<'_>,
    lengths_m: &[f64],
    speed_m_s: f64,
    times: ResponseTimeOrigin,
) -> f64 {
    let picked = recording.picked;
    let direct_s = lengths_m[0] / speed_m_s;
    // Without a known zero the direct sounds are laid over each other.
    let zero_s = match times {
        ResponseTimeOrigin::Absolute => 0.0,
        ResponseTimeOrigin::Relative | ResponseTimeOrigin::CommonOffset => {
            picked.direct_s - direct_s
        }
    };
    let predicted: Vec<f64> = lengths_m.iter().map(|l| zero_s + l / speed_m_s).collect();
    let off = |t_s: f64| mismatch_s(t_s, &predicted).powi(2);
    let own = mismatch_s(picked.direct_s, &predicted[..1]).powi(2);
    own + picked.echoes.iter().map(|echo| off(echo.t_s)).sum::<f64>()
}

/// The stretch of all times, against those of the box at `speed_m_s`, under which most echoes are met.
pub(super) fn best_stretch(
    recordings: &[BoxRecording<'_>],
    size_m: [f64; 3],
    speed_m_s: f64,
    times: ResponseTimeOrigin,
) -> f64 {
    let lengths: Vec<Vec<f64>> = recordings
        .iter()
        .map(|one| image_lengths_m([0.0; 3], size_m, one.source_m, one.receiver_m))
        .collect();
    let steps = (MOST_STRETCH / STRETCH_STEP).round() as i32;
    let total = |stretch: f64| -> f64 {
        let each = recordings.iter().zip(&lengths);
        each.map(|(one, lengths)| mismatch(one, lengths, speed_m_s / stretch, times))
            .sum()
    };
    let tried = (-steps..=steps).map(|k| 1.0 + f64::from(k) * STRETCH_STEP);
    tried
        .map(|stretch| (total(stretch), stretch))
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .map_or(1.0, |(_, stretch)| stretch)
}

/// How far out a side lies under which most echoes are met, m; `first`: it is the side at which `axis` begins.
pub(super) fn best_wall_offset_m(
    recordings: &[BoxRecording<'_>],
    size_m: [f64; 3],
    (axis, first): (usize, bool),
    speed_m_s: f64,
    times: ResponseTimeOrigin,
) -> Option<f64> {
    let total = |offset_m: f64| -> f64 {
        let (mut low, mut high) = ([0.0; 3], size_m);
        if first {
            low[axis] = -offset_m;
        } else {
            high[axis] += offset_m;
        }
        recordings
            .iter()
            .map(|one| {
                let lengths = image_lengths_m(low, high, one.source_m, one.receiver_m);
                mismatch(one, &lengths, speed_m_s, times)
            })
            .sum()
    };
    let least = -inward_clearance_m(recordings, size_m, (axis, first));
    let [from, to] = WALL_RANGE.map(|share| (share * size_m[axis] / WALL_STEP_M).round() as i32);
    let tried = (from..=to).map(|k| f64::from(k) * WALL_STEP_M);
    tried
        .filter(|offset| *offset >= least)
        .map(|offset| (total(offset), offset))
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, offset)| offset)
        .filter(|offset| offset.abs() > NEAR_M)
}

/// How far a side can move inwards before it meets a source or a microphone, m.
pub(super) fn inward_clearance_m(
    recordings: &[BoxRecording<'_>],
    size_m: [f64; 3],
    (axis, first): (usize, bool),
) -> f64 {
    let distances = recordings.iter().flat_map(|one| {
        [one.source_m, one.receiver_m].map(|point| {
            if first {
                point[axis]
            } else {
                size_m[axis] - point[axis]
            }
        })
    });
    (distances.fold(f64::INFINITY, f64::min) - LEAST_DISTANCE_M).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::super::setup::RoomSetup;
    use super::*;
    use crate::bundle::file::{RoomManifest, SurfaceManifest};
    use dwell_acoustics::{AcousticConfig, SoundSourcePose};
    use glam::Vec3;

    /// The closed form has the engine's paths.
    #[test]
    fn images_have_the_lengths_of_the_engines_paths() {
        let surfaces = crate::bundle::ROOM_SURFACES
            .map(|side| (side.to_owned(), SurfaceManifest::default()))
            .into();
        let size_m = [5.2, 2.7, 4.1];
        let config = AcousticConfig {
            rays: 0,
            image_order: ORDER as usize,
            discovery_rays: 0,
            ..AcousticConfig::full()
        };
        let stage = RoomSetup::of_box(
            &RoomManifest {
                size_m,
                surfaces,
                position_sd_m: None,
            },
            &[0.0; 6],
            config,
        )
        .unwrap();
        let (source, receiver) = ([1.0, 1.1, 1.4], [3.7, 1.6, 2.9]);
        let place = |p: [f64; 3]| Vec3::from_array(p.map(|x| x as f32));
        let paths = stage
            .scene
            .early_paths(
                &stage.rays,
                &SoundSourcePose::omni(place(source)),
                place(receiver),
            )
            .unwrap();
        let mut engine: Vec<f64> = paths.iter().map(|one| one.path.length_m).collect();
        engine.sort_by(f64::total_cmp);
        let images = image_lengths_m([0.0; 3], size_m, source, receiver);
        assert_eq!(engine.len(), images.len());
        for (a, b) in engine.iter().zip(&images) {
            assert!((a - b).abs() < 1e-4, "{a} {b}");
        }
    }
}
