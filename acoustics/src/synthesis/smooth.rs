//! Smoothing of the tail's histogram.

use crate::bands::BAND_COUNT;
use crate::echogram::EnergyHistogram;

/// Half of a pass's window, over the time since the impulse.
const SPREAD: f64 = 0.04;
/// Two passes make the window a triangle, whose ends are inaudible.
const PASSES: usize = 2;

/// Returns the bins with every energy averaged over a window that grows with time: 40 ms to either side at half a second.
/// The sum over all bins is unchanged in every band.
///
/// Late bins hold the energy of few rays; unsmoothed, they flutter. An exponential decay keeps its slope.
pub(super) fn smooth(histogram: &EnergyHistogram) -> Vec<[f64; BAND_COUNT]> {
    let mut smoothed = histogram.bins.clone();
    for _ in 0..PASSES {
        smoothed = moving_average(&smoothed);
    }
    let (before, after) = (histogram.total(), total(&smoothed));
    for bin in &mut smoothed {
        for (band, energy) in bin.iter_mut().enumerate() {
            if after[band] > 0.0 {
                *energy *= before[band] / after[band];
            }
        }
    }
    smoothed
}

fn total(bins: &[[f64; BAND_COUNT]]) -> [f64; BAND_COUNT] {
    bins.iter().fold([0.0; BAND_COUNT], |sum, bin| {
        std::array::from_fn(|band| sum[band] + bin[band])
    })
}

/// Replaces every bin by the mean of those around it.
fn moving_average(bins: &[[f64; BAND_COUNT]]) -> Vec<[f64; BAND_COUNT]> {
    // Sums up to each bin, so that a window is one difference.
    let mut sums = vec![[0.0; BAND_COUNT]];
    let mut sum = [0.0; BAND_COUNT];
    for bin in bins {
        for (total, e) in sum.iter_mut().zip(bin) {
            *total += e;
        }
        sums.push(sum);
    }
    let around = |k: usize| {
        let half = ((SPREAD * k as f64) as usize).min(bins.len() - 1 - k);
        if half == 0 {
            return bins[k];
        }
        let (low, high) = (k - half, k + half + 1);
        let count = (high - low) as f64;
        // Differences of long sums may fall a rounding below zero.
        std::array::from_fn(|band| ((sums[high][band] - sums[low][band]) / count).max(0.0))
    };
    (0..bins.len()).map(around).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::random::RandomKey;

    fn decay(grain: f64) -> EnergyHistogram {
        let mut stream = RandomKey::root(1).stream();
        let bins = (0..250).map(|k| {
            let level = libm::exp(-0.1 * f64::from(k)) * (1.0 + grain * (stream.uniform() - 0.5));
            [level; BAND_COUNT]
        });
        EnergyHistogram {
            bin_s: 0.004,
            bins: bins.collect(),
            ..EnergyHistogram::default()
        }
    }

    #[test]
    fn energy_and_slope_stay() {
        let before = decay(0.0);
        let after = smooth(&before);
        let sum = |bins: &[[f64; BAND_COUNT]]| bins.iter().map(|bin| bin[4]).sum::<f64>();
        assert!((sum(&after) / sum(&before.bins) - 1.0).abs() < 1e-9);
        let slope = (after[60][4] / after[160][4]).ln() / 100.0;
        assert!((slope - 0.1).abs() < 4e-3, "{slope}");
    }

    #[test]
    fn grain_becomes_less() {
        let roughness = |bins: &[[f64; BAND_COUNT]]| {
            let pairs = bins[100..200].windows(2);
            pairs
                .map(|pair| (pair[1][4] / pair[0][4]).ln().abs())
                .sum::<f64>()
        };
        let grainy = decay(1.8);
        assert!(roughness(&smooth(&grainy)) < 0.5 * roughness(&grainy.bins));
    }
}
