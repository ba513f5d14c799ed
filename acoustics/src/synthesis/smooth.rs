//! Less of the rays' grain in the tail.

use crate::bands::BAND_COUNT;
use crate::echogram::{Bin, Histogram};
use glam::DVec3;

/// Half of a pass's window over the time since the impulse.
const SPREAD: f64 = 0.04;
/// Two passes make the window a triangle, whose ends are not heard.
const PASSES: usize = 2;

/// The bins with every energy averaged over a window that grows with time: 40 ms to either side at half a second. The sum over
/// all bins stays as it was in every band.
///
/// Late bins hold the energy of few rays; heard as they are, they flutter. An exponential decay that is averaged so keeps its
/// slope.
pub(super) fn smooth(histogram: &Histogram) -> Vec<Bin> {
    let mut smoothed = histogram.bins.clone();
    for _ in 0..PASSES {
        smoothed = pass(&smoothed);
    }
    let (before, after) = (histogram.total(), total(&smoothed));
    for bin in &mut smoothed {
        for (band, energy) in bin.energy.iter_mut().enumerate() {
            if after[band] > 0.0 {
                *energy *= before[band] / after[band];
            }
        }
    }
    smoothed
}

fn total(bins: &[Bin]) -> [f64; BAND_COUNT] {
    bins.iter().fold([0.0; BAND_COUNT], |sum, bin| {
        std::array::from_fn(|band| sum[band] + bin.energy[band])
    })
}

/// Every bin becomes the mean of those around it.
fn pass(bins: &[Bin]) -> Vec<Bin> {
    // Sums up to each bin, so that a window is one difference.
    let mut energy = vec![[0.0; BAND_COUNT]];
    let mut from = vec![(DVec3::ZERO, 0.0)];
    let (mut sum, mut sum_from) = ([0.0; BAND_COUNT], (DVec3::ZERO, 0.0));
    for bin in bins {
        let all: f64 = bin.energy.iter().sum();
        for (total, e) in sum.iter_mut().zip(bin.energy) {
            *total += e;
        }
        sum_from.0 += bin.arrival.as_dvec3() * all;
        sum_from.1 += all;
        energy.push(sum);
        from.push(sum_from);
    }
    let around = |k: usize| {
        let half = ((SPREAD * k as f64) as usize).min(bins.len() - 1 - k);
        if half == 0 {
            return bins[k];
        }
        let (low, high) = (k - half, k + half + 1);
        let count = (high - low) as f64;
        // Differences of long sums may fall a rounding below zero.
        let mean = |band: usize| ((energy[high][band] - energy[low][band]) / count).max(0.0);
        let all = from[high].1 - from[low].1;
        let arrival = (from[high].0 - from[low].0) / all.max(1e-300);
        Bin {
            energy: std::array::from_fn(mean),
            arrival: arrival.as_vec3().clamp_length_max(1.0),
        }
    };
    (0..bins.len()).map(around).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::random::Key;
    use glam::Vec3;

    fn decay(grain: f64) -> Histogram {
        let mut stream = Key::root(1).stream();
        let bins = (0..250).map(|k| {
            let level = libm::exp(-0.1 * f64::from(k)) * (1.0 + grain * (stream.uniform() - 0.5));
            Bin {
                energy: [level; BAND_COUNT],
                arrival: Vec3::new(0.3, 0.0, 0.0),
            }
        });
        Histogram {
            bin_s: 0.004,
            bins: bins.collect(),
        }
    }

    #[test]
    fn energy_slope_and_direction_stay() {
        let before = decay(0.0);
        let after = smooth(&before);
        let sum = |bins: &[Bin]| bins.iter().map(|bin| bin.energy[4]).sum::<f64>();
        assert!((sum(&after) / sum(&before.bins) - 1.0).abs() < 1e-9);
        let slope = (after[60].energy[4] / after[160].energy[4]).ln() / 100.0;
        assert!((slope - 0.1).abs() < 4e-3, "{slope}");
        assert!((after[100].arrival - Vec3::new(0.3, 0.0, 0.0)).length() < 1e-5);
    }

    #[test]
    fn grain_becomes_less() {
        let roughness = |bins: &[Bin]| {
            let pairs = bins[100..200].windows(2);
            pairs
                .map(|pair| (pair[1].energy[4] / pair[0].energy[4]).ln().abs())
                .sum::<f64>()
        };
        let grainy = decay(1.8);
        assert!(roughness(&smooth(&grainy)) < 0.5 * roughness(&grainy.bins));
    }
}
