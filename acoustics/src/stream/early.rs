//! Tracked early paths while source or listener move: gliding delays, which give the Doppler shift.

use super::delay_line::DelayedSegment;
use crate::echogram::PropagationPath;
use crate::synthesis::{PathFilter, strongest};
use serde::{Deserialize, Serialize};

/// Largest change of a gliding delay, as a fraction of the time: an eighth of the speed of sound.
const FASTEST: f64 = 0.125;
/// Distance of bends within which two paths bend around one edge, m: a bend slides along its edge as the listener walks.
const SAME_EDGE_M: f32 = 0.4;

/// A path at the end of a block.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct TrackedPath {
    pub(super) path: PropagationPath,
    /// Its filter at each channel. Shape (channel,).
    pub(super) wavelets: Vec<PathFilter>,
}

/// Returns the distance that the bends of a path have slid in a movement, m; `None` where two paths are not the same.
fn bend_displacement_m(a: &PropagationPath, b: &PropagationPath) -> Option<f32> {
    if a.planes != b.planes || a.diffraction_points.len() != b.diffraction_points.len() {
        return None;
    }
    let slid = a
        .diffraction_points
        .iter()
        .zip(&b.diffraction_points)
        .map(|(a, b)| a.distance(*b));
    let slid_m = slid.fold(0.0, f32::max);
    (slid_m < SAME_EDGE_M).then_some(slid_m)
}

/// Returns the tracked paths of a response: all direct ones, then the strongest reflections up to `most` in all.
pub(super) fn select_tracked_paths(paths: &[PropagationPath], most: usize) -> Vec<PropagationPath> {
    let (mut chosen, mut others): (Vec<&PropagationPath>, Vec<&PropagationPath>) = strongest(paths)
        .into_iter()
        .partition(|path| path.planes.is_empty());
    let power = |path: &PropagationPath| path.energy.iter().sum::<f32>();
    others.sort_by(|a, b| power(b).total_cmp(&power(a)));
    let left = most.saturating_sub(chosen.len());
    chosen.extend(others.into_iter().take(left));
    chosen.into_iter().cloned().collect()
}

/// The movement of a source's paths over one block.
pub(super) struct DelayInterpolation<'a> {
    /// Past samples of the source; the last ones are the block's.
    pub(super) history: &'a [f32],
    pub(super) rate_hz: f64,
    /// The weight of the new. Shape (sample,).
    pub(super) fade: &'a [f32],
}

impl DelayInterpolation<'_> {
    /// Adds the output of `old` paths as they become `new` ones to `out`. `out`: shape (channel, sample), flat.
    ///
    /// A path's delay changes linearly from one block's end to the next's, its filter is crossfaded; a path that is only in
    /// one of the two fades.
    pub(super) fn add(&self, old: &[TrackedPath], new: &[TrackedPath], out: &mut [f32]) {
        let size = self.fade.len();
        let mut left: Vec<&TrackedPath> = old.iter().collect();
        for path in new {
            let before = (0..left.len())
                .filter_map(|k| Some((k, bend_displacement_m(&left[k].path, &path.path)?)))
                .min_by(|a, b| a.1.total_cmp(&b.1))
                .map(|(k, _)| left.remove(k));
            for (channel, out) in out.chunks_exact_mut(size).enumerate() {
                let from = before.and_then(|one| one.wavelets.get(channel));
                self.channel(from, path.wavelets.get(channel), out);
            }
        }
        for path in left {
            for (wavelet, out) in path.wavelets.iter().zip(out.chunks_exact_mut(size)) {
                self.channel(Some(wavelet), None, out);
            }
        }
    }

    fn channel(&self, old: Option<&PathFilter>, new: Option<&PathFilter>, out: &mut [f32]) {
        let size = out.len();
        let delay = |wavelet: &PathFilter| wavelet.delay_s * self.rate_hz;
        if let (Some(a), Some(b)) = (old, new)
            && (delay(a) - delay(b)).abs() > FASTEST * size as f64
        {
            // No listener walks so fast: a jump has no glide.
            self.channel(Some(a), None, out);
            self.channel(None, Some(b), out);
            return;
        }
        // The future is unknown: ringing before the newest sample is left out.
        let early = |wavelet: &PathFilter| {
            (wavelet.pre_ringing_samples as f64 + 1.0 - delay(wavelet)).ceil()
        };
        let skip = [old, new].into_iter().flatten().map(early);
        let skip = skip.fold(0.0, f64::max) as usize;
        let late = |wavelet: &PathFilter| {
            let lead = wavelet.pre_ringing_samples.saturating_sub(skip);
            (delay(wavelet) - lead as f64).max(1.0)
        };
        let (from, to) = match (old, new) {
            (Some(a), Some(b)) => (late(a), late(b)),
            (Some(a), None) => (late(a), late(a)),
            (None, Some(b)) => (late(b), late(b)),
            (None, None) => return,
        };
        let passage = DelayedSegment::new(self.history, size, (from, to));
        let filtered = |wavelet: &PathFilter| {
            let skip = skip.min(wavelet.pre_ringing_samples);
            passage.filtered(&wavelet.response[skip..], wavelet.amplitude)
        };
        let (old, new) = (old.map(filtered), new.map(filtered));
        passage.add_crossfaded(old.as_deref(), new.as_deref(), self.fade, out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn followed(delay_s: f64) -> TrackedPath {
        TrackedPath {
            path: PropagationPath {
                planes: Vec::new(),
                diffraction_points: Vec::new(),
                length_m: 1.0,
                energy: [1.0; 8],
                arrival: glam::Vec3::X,
                departure: glam::Vec3::X,
                walls: 0,
                inverted: false,
            },
            wavelets: vec![PathFilter {
                response: vec![1.0],
                pre_ringing_samples: 0,
                amplitude: 0.5,
                delay_s,
            }],
        }
    }

    /// A gliding delay resamples: a tone comes out as the tone at the time it was emitted, within -70 dB.
    #[test]
    fn a_gliding_delay_resamples() {
        let (rate_hz, size) = (16_000.0, 800);
        let fade: Vec<f32> = (1..=size).map(|k| k as f32 / size as f32).collect();
        for frequency_hz in [200.0, 1000.0, 5000.0] {
            let omega = std::f64::consts::TAU * frequency_hz / rate_hz;
            let history: Vec<f32> = (0..4 * size)
                .map(|k| (omega * k as f64).sin() as f32)
                .collect();
            let glide = DelayInterpolation {
                history: &history,
                rate_hz,
                fade: &fade,
            };
            let (from, to) = (100.3, 97.9);
            let mut out = vec![0.0; size];
            glide.add(
                &[followed(from / rate_hz)],
                &[followed(to / rate_hz)],
                &mut out,
            );
            for (k, y) in out.iter().enumerate() {
                let delay = from + (to - from) * (k + 1) as f64 / size as f64;
                let wanted = 0.5 * (omega * ((3 * size + k) as f64 - delay)).sin();
                assert!(
                    (f64::from(*y) - wanted).abs() < 3e-4 * 0.5,
                    "{frequency_hz} {k}"
                );
            }
        }
    }

    /// Ears ring before their delay. Closer than that there is no time for it, and the pulse still comes at the right time.
    #[test]
    fn what_rings_early_is_left_out_where_it_would_be_of_the_future() {
        let mut history = vec![0.0; 300];
        history[250] = 1.0;
        let fade = vec![1.0; 100];
        let glide = DelayInterpolation {
            history: &history,
            rate_hz: 16_000.0,
            fade: &fade,
        };
        for delay in [3.0, 9.0, 30.0] {
            let mut path = followed(delay / 16_000.0);
            let wavelet = &mut path.wavelets[0];
            wavelet.pre_ringing_samples = 16;
            wavelet.response = vec![0.0; 20];
            wavelet.response[16] = 1.0;
            let mut out = vec![0.0; 100];
            glide.add(&[path.clone()], &[path], &mut out);
            let peak = (0..100).max_by(|a, b| out[*a].total_cmp(&out[*b]));
            assert_eq!(peak, Some(50 + delay as usize), "{delay}");
        }
    }

    /// Two paths around one corner, and then one: every old path is rendered once and ends.
    #[test]
    fn each_path_goes_on_as_one() {
        let history = vec![1.0; 300];
        let fade = vec![0.5; 100];
        let glide = DelayInterpolation {
            history: &history,
            rate_hz: 16_000.0,
            fade: &fade,
        };
        let around = |x: f32| {
            let mut path = followed(0.002);
            path.path.diffraction_points = vec![glam::Vec3::X * x];
            path
        };
        for (old, new, wanted) in [
            (vec![0.0, 0.2], vec![0.05, 0.25], 1.0),
            (vec![0.0, 0.2], vec![0.05], 0.75),
            (vec![0.0], vec![0.05, 0.25], 0.75),
        ] {
            let paths = |places: Vec<f32>| places.into_iter().map(around).collect::<Vec<_>>();
            let mut out = vec![0.0; 100];
            glide.add(&paths(old), &paths(new), &mut out);
            // Each path has half of the pressure; the weight of the new is a half.
            assert!(
                out.iter().all(|y| (y - wanted).abs() < 1e-4),
                "{wanted}: {}",
                out[0]
            );
        }
    }

    /// So close that the filter would reach into the future, it still plays, and nothing is out of bounds.
    #[test]
    fn the_shortest_delays_play() {
        let history: Vec<f32> = (0..300).map(|k| (0.05 * k as f32).sin()).collect();
        let fade = vec![1.0; 100];
        let glide = DelayInterpolation {
            history: &history,
            rate_hz: 16_000.0,
            fade: &fade,
        };
        for delay in [0.0, 1.0, 2.5, 7.0, 40.0, 1e4] {
            let mut out = vec![0.0; 100];
            let path = [followed(delay / 16_000.0)];
            glide.add(&path, &path, &mut out);
            let wanted = |k: usize| 0.5 * (0.05 * ((200 + k) as f64 - delay.max(1.0))).sin();
            for (k, y) in out.iter().enumerate() {
                let wanted = if delay > 1000.0 { 0.0 } else { wanted(k) };
                assert!((f64::from(*y) - wanted).abs() < 1e-3, "{delay} {k}");
            }
        }
    }
}
