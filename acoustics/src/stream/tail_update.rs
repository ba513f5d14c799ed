//! Reuse of the previous tail for a listener who moves.

use crate::config::AcousticConfig;
use crate::echogram::{Echogram, SPAN_COUNT};
use crate::tail::spans;

/// Distance over which early sound stays similar, m.
const NEAR_M: f64 = 0.3;
/// Share of its path length over which late sound stays similar: it has mixed.
const SIMILAR_SHARE: f64 = 0.3;

/// Least weight of the new rays, in their share: the reused tail comes from many updates.
const MIN_NEW_WEIGHT: f64 = 0.67;

/// Time before which sound has not mixed: it changes with every step, s.
const MIXED_S: f64 = 0.04;
/// Variation of a mixed tail's level between places in one room, as a logarithm of energies: 0.5 dB.
const PLACE_VARIATION: f64 = 0.115;
/// Difference that exceeds chance and place, in standard deviations of a normal distribution.
const OTHER_TAIL_DEVIATIONS: f64 = 5.0;
/// Difference from which the weight of the new increases with it.
const WEIGHT_DEVIATIONS: f64 = 3.0;
/// Relative error above which there are too few rays for a comparison.
const MAX_RELATIVE_ERROR: f64 = 0.5;

/// The previous tail, and the changes since.
pub(super) struct TailHistory<'a> {
    pub(super) previous: &'a Echogram,
    /// Distance that source and receiver have moved since, m.
    pub(super) moved_m: f64,
    /// The share of all rays that is traced anew.
    pub(super) share: f64,
    /// Identifies the update.
    pub(super) update: u64,
}

/// Returns the number of rays of an update that reuses the rest.
pub(super) fn partial_ray_count(config: &AcousticConfig, share: f64) -> usize {
    (config.rays as f64 * share).ceil() as usize
}

impl TailHistory<'_> {
    /// Returns the number of rays that are traced anew.
    pub(super) fn rays_to_trace(&self, config: &AcousticConfig) -> usize {
        partial_ray_count(config, self.share)
    }

    /// Returns the difference of `now` from the previous tail, where it has mixed, as a deviate of a normal distribution: a
    /// listener who walks through a door hears another tail, however short the distance.
    ///
    /// # Source
    /// The sum of squares of the spans' differences over their errors, made normal by E. B. Wilson, M. M. Hilferty, Proc. Natl. Acad.
    /// Sci. 17, 684 (1931).
    fn deviation_score(&self, now: &Echogram) -> f64 {
        let energies = |of: &Echogram| spans::span_energies(&of.tail);
        let (old, new) = (energies(self.previous), energies(now));
        let silent = |spans: &[f64]| spans.iter().all(|energy| *energy == 0.0);
        if silent(&old) != silent(&new) {
            return f64::INFINITY;
        }
        let (mut count, mut squares) = (0.0, 0.0);
        for span in spans::span_of(MIXED_S)..SPAN_COUNT {
            let error = |of: &Echogram| f64::from(of.ray_statistics.error_over_time[span]);
            let (before, after) = (error(self.previous), error(now));
            if old[span] > 0.0 && new[span] > 0.0 && before.max(after) <= MAX_RELATIVE_ERROR {
                let variance = before * before + after * after + PLACE_VARIATION * PLACE_VARIATION;
                squares += libm::log(new[span] / old[span]).powi(2) / variance;
                count += 1.0;
            }
        }
        if count == 0.0 {
            return 0.0;
        }
        let spread = 2.0 / (9.0 * count);
        (libm::cbrt(squares / count) - (1.0 - spread)) / spread.sqrt()
    }

    /// Mixes the previous tail into `now`: exponential averaging whose weight of the new grows with the distance moved, and
    /// for early sound more than for late.
    ///
    /// # Source
    /// The idea is that of temporal coherence in C. Schissler, D. Manocha, ACM TOG 36(2), 16 (2017), section 4.
    ///
    /// Returns `false` for another tail, which needs all rays.
    pub(super) fn blend_into(&self, now: &mut Echogram) -> bool {
        let before = &self.previous.tail;
        if before.bin_s != now.tail.bin_s
            || before.bins.len() != now.tail.bins.len()
            || before.bins_per_direction != now.tail.bins_per_direction
        {
            return false;
        }
        let surprise = self.deviation_score(now);
        if surprise > OTHER_TAIL_DEVIATIONS {
            return false;
        }
        let doubt = (1.0 - (WEIGHT_DEVIATIONS / surprise.max(WEIGHT_DEVIATIONS)).powi(2))
            .max(MIN_NEW_WEIGHT * self.share);
        let weight_at = |time_s: f64| {
            let reach_m = NEAR_M + SIMILAR_SHARE * now.speed_m_s * time_s;
            1.0 - (1.0 - doubt) * libm::exp(-self.moved_m / reach_m)
        };
        let (bin_s, per_direction) = (now.tail.bin_s, now.tail.bins_per_direction.max(1));
        let errors = &self.previous.ray_statistics.error_over_time;
        for (span, (error, old)) in now
            .ray_statistics
            .error_over_time
            .iter_mut()
            .zip(errors)
            .enumerate()
        {
            let weight = weight_at(spans::span_centre_s(span)) as f32;
            *error = libm::hypotf(weight * *error, (1.0 - weight) * old);
        }
        for (k, (bin, old)) in now.tail.bins.iter_mut().zip(&before.bins).enumerate() {
            let weight = weight_at((k as f64 + 0.5) * bin_s);
            for (e, old) in bin.iter_mut().zip(old) {
                *e = old + (*e - old) * weight;
            }
        }
        let pairs = now.tail.directions.iter_mut().zip(&before.directions);
        for (k, (cells, old)) in pairs.enumerate() {
            let weight = weight_at((k as f64 + 0.5) * bin_s * per_direction as f64) as f32;
            for (cell, old) in cells.energy.iter_mut().zip(&old.energy) {
                for (e, old) in cell.iter_mut().zip(old) {
                    *e = old + (*e - old) * weight;
                }
            }
        }
        true
    }
}
