//! Time spans, each twice as long as the one before, for which the tail's error is given.

use crate::echogram::{EnergyHistogram, SPAN_COUNT};
use serde::{Deserialize, Serialize};

/// End of the first span, s.
const FIRST_S: f64 = 0.02;

/// Returns the span that contains `time_s`.
pub(crate) fn span_of(time_s: f64) -> usize {
    let mut end_s = FIRST_S;
    let mut span = 0;
    while time_s >= end_s && span + 1 < SPAN_COUNT {
        (end_s, span) = (2.0 * end_s, span + 1);
    }
    span
}

/// Returns the middle of span `span`, s; of the last one, as if it were as long as its beginning.
pub(crate) fn span_centre_s(span: usize) -> f64 {
    let end_s = FIRST_S * libm::exp2(span as f64);
    if span == 0 { 0.5 * end_s } else { 0.75 * end_s }
}

/// Returns the span of each of `count` bins of `bin_s`. Shape (bin,).
pub(super) fn spans_of_bins(count: usize, bin_s: f64) -> Vec<usize> {
    let middle_s = |k: usize| (k as f64 + 0.5) * bin_s;
    (0..count).map(|k| span_of(middle_s(k))).collect()
}

/// Returns the energy in each span, all bands together. Shape (span,).
pub(crate) fn span_energies(tail: &EnergyHistogram) -> [f64; SPAN_COUNT] {
    let mut sums = [0.0; SPAN_COUNT];
    let spans = spans_of_bins(tail.bins.len(), tail.bin_s);
    for (bin, span) in tail.bins.iter().zip(spans) {
        sums[span] += bin.iter().sum::<f64>();
    }
    sums
}

/// Sums over rays of their energy in each span, for the error of the mean.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct SpanVariance {
    sums: [f64; SPAN_COUNT],
    squares: [f64; SPAN_COUNT],
}

impl SpanVariance {
    /// Returns whether these are valid sums.
    pub(super) fn is_valid(&self) -> bool {
        let mut all = self.sums.iter().chain(&self.squares);
        all.all(|sum| sum.is_finite() && *sum >= 0.0)
    }

    /// Adds the energies of rays, each with all that it split into. Shape (ray, span).
    pub(super) fn add(&mut self, rays: &[[f32; SPAN_COUNT]]) {
        for ray in rays {
            for (k, energy) in ray.iter().enumerate() {
                let energy = f64::from(*energy);
                self.sums[k] += energy;
                self.squares[k] += energy * energy;
            }
        }
    }

    /// Returns the standard error of the mean of `rays` rays over the mean; 0 where nothing arrives.
    ///
    /// # Source
    /// H. P. Chan, T. L. Lai, Ann. Stat. 41, 2877 (2013), section 2: the energy of all descendants of a ray counts as its own.
    pub(super) fn relative_error(&self, rays: usize) -> [f32; SPAN_COUNT] {
        let n = rays as f64;
        std::array::from_fn(|k| {
            let (mean, square) = (self.sums[k] / n, self.squares[k] / n);
            if mean <= 0.0 || rays < 2 {
                return 0.0;
            }
            (((square - mean * mean).max(0.0) / (n - 1.0)).sqrt() / mean) as f32
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spans_double() {
        for (time_s, span) in [
            (0.0, 0),
            (0.019, 0),
            (0.02, 1),
            (0.079, 2),
            (0.08, 3),
            (0.65, 6),
            (100.0, 6),
        ] {
            assert_eq!(span_of(time_s), span, "{time_s}");
        }
        assert_eq!(spans_of_bins(4, 0.012), [0, 0, 1, 2]);
    }

    /// Ten rays of 1 and ten of 3: mean 2, standard deviation 1 (with 19 for 20: 1.026), so that the error is 0.229 of 2.
    #[test]
    fn the_error_is_that_of_a_mean() {
        let mut all = SpanVariance::default();
        for energy in [1.0, 3.0] {
            let mut ray = [0.0; SPAN_COUNT];
            ray[2] = energy;
            all.add(&[ray; 10]);
        }
        let error = all.relative_error(20);
        assert!((f64::from(error[2]) - 1.0 / 19.0_f64.sqrt() / 2.0).abs() < 1e-6);
        assert_eq!((error[1], error[3]), (0.0, 0.0));
    }
}
