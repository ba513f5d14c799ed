//! What varies slowly in residuals beyond correlated noise: the power of their slow modes against an autoregression's.
//!
//! A learner sees what all episodes have in common. A gust, or whatever has another phase in each episode, is common to none:
//! it shows as power in slow modes of each episode. Noise that remembers has such power, too, by a law of its own.

use crate::error::CalibrationError;
use crate::experiment::{Experiment, ParameterIndex};
use crate::fit::FitResult;
use crate::median::median;
use dwell_scene::parallel::Threads;
use nalgebra::{DMatrix, DVector};
use serde::Serialize;

/// Outliers count as so many medians.
const OUTLIER_MEDIANS: f64 = 4.5;
/// Samples below which a sequence says nothing.
const SHORTEST: usize = 12;
/// Part of a mode that must be left beside nuisances.
const LEFT_OF_MODE: f64 = 0.5;
/// Largest correlation of neighbours that counts as one of noise, and the step of what is tried.
const MOST_CORRELATED: f64 = 0.95;
const CORRELATION_STEP: f64 = 0.025;
/// Correlation from which on what is left may as well be motion that was not modelled.
const LONGEST_MEMORY: f64 = 0.93;
/// Shares of noise without memory in noise with one: rounding and what is left of outliers.
const WHITE_SHARES: [f64; 4] = [0.0, 0.05, 0.1, 0.15];
/// Half periods in an episode up to which something is slow; each next one is twice as many.
const FEWEST_HALF_PERIODS: f64 = 3.0;
/// Part of all modes that may be slow ones.
const MOST_SLOW: f64 = 0.25;
/// Powers of slow modes that are tried, in those of the noise.
const LEAST_POWER: f64 = 0.05;
const POWER_RATIO: f64 = 1.5;
const POWERS: usize = 24;
/// The likelihood ratio above which noise is no explanation. By chance it exceeds 16 in one of 30,000 tests of one width and
/// channel; of three widths and six channels, in one of 2,000 cases.
const LEVEL: f64 = 16.0;
/// Share of the mean square below which what is slow is too little to matter.
const LEAST_SHARE: f64 = 0.02;

/// Slow variation within episodes that no noise of first order has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct SlowResidual {
    /// Its share of the mean square of the channel where it is most.
    pub share: f64,
    /// Twice the logarithm of the likelihood ratio against noise alone.
    pub likelihood_ratio: f64,
    /// The largest correlation of neighbours in the noise of a channel.
    pub correlation: f64,
}

impl SlowResidual {
    /// Returns whether it is systematic.
    pub(crate) fn is_structured(&self) -> bool {
        self.likelihood_ratio > LEVEL && self.share > LEAST_SHARE
    }

    /// Returns whether noise with a memory that noise may have is all that there is.
    pub(crate) fn is_noise(&self) -> bool {
        self.likelihood_ratio < LEVEL && self.correlation <= LONGEST_MEMORY
    }
}

/// The power spectrum of residuals: summed squares and their number by frequency.
#[derive(Clone, Debug, Default)]
struct Spectrum {
    /// (angle of a sample, summed squares, their number).
    bins: Vec<(f64, f64, f64)>,
    /// Half periods of a typical sequence in the highest bin.
    modes: f64,
}

/// One sequence of residuals: its modes beside nuisances, as (half periods, part of the mode, amplitude).
fn modes(residual: &[f64], nuisances: &DMatrix<f64>) -> Vec<(usize, f64, f64)> {
    let count = residual.len();
    let basis = orthonormal(nuisances);
    let residual = DVector::from_column_slice(residual);
    let mut found = Vec::with_capacity(count);
    for k in 0..count {
        let size = (if k == 0 { 1.0 } else { 2.0 } / count as f64).sqrt();
        let turn = std::f64::consts::PI * k as f64 / count as f64;
        let mode = DVector::from_fn(count, |n, _| size * libm::cos(turn * (n as f64 + 0.5)));
        let part = 1.0 - basis.tr_mul(&mode).norm_squared();
        if part > LEFT_OF_MODE {
            found.push((k, part, mode.dot(&residual)));
        }
    }
    found
}

/// An orthonormal basis of the columns that are not nothing.
fn orthonormal(columns: &DMatrix<f64>) -> DMatrix<f64> {
    let mut kept: Vec<DVector<f64>> = Vec::new();
    for column in columns.column_iter() {
        let size = column.norm();
        if size <= 0.0 {
            continue;
        }
        let mut rest = column / size;
        for _ in 0..2 {
            for other in &kept {
                rest -= other * other.dot(&rest);
            }
        }
        let left = rest.norm();
        if left > 1e-6 {
            kept.push(rest / left);
        }
    }
    DMatrix::from_fn(columns.nrows(), kept.len(), |r, c| kept[c][r])
}

impl Spectrum {
    /// Of sequences with their nuisances' columns.
    fn new(sequences: &[(Vec<f64>, DMatrix<f64>)]) -> Self {
        let mut sizes: Vec<f64> = sequences
            .iter()
            .flat_map(|(residual, _)| residual.iter().map(|r| r.abs()))
            .collect();
        let limit = OUTLIER_MEDIANS * median(&mut sizes);
        let mut lengths: Vec<f64> = sequences.iter().map(|(r, _)| r.len() as f64).collect();
        let typical = median(&mut lengths);
        let mut bins = vec![(0.0, 0.0, 0.0); typical as usize + 1];
        for (residual, nuisances) in sequences {
            let clipped: Vec<f64> = residual.iter().map(|r| r.clamp(-limit, limit)).collect();
            for (k, part, amplitude) in modes(&clipped, nuisances) {
                let place = (k as f64 / residual.len() as f64 * typical).round() as usize;
                let bin = &mut bins[place.min(typical as usize)];
                bin.1 += amplitude * amplitude / part;
                bin.2 += 1.0;
            }
        }
        for (k, bin) in bins.iter_mut().enumerate() {
            bin.0 = std::f64::consts::PI * k as f64 / typical.max(1.0);
        }
        bins.retain(|(_, _, count)| *count > 0.0);
        Self {
            bins,
            modes: typical,
        }
    }

    /// The best log likelihood of powers of this form, their scale fitted.
    ///
    /// # Source
    /// P. Whittle, Ark. Mat. 2, 423 (1953).
    fn log_likelihood(&self, power: impl Fn(f64) -> f64) -> f64 {
        let (mut sum, mut logs, mut count) = (0.0, 0.0, 0.0);
        for (angle, squares, number) in &self.bins {
            let power = power(*angle);
            sum += squares / power;
            logs += number * power.ln();
            count += number;
        }
        -0.5 * (count * (sum / count).max(f64::MIN_POSITIVE).ln() + logs + count)
    }

    /// Slow variation beside noise.
    fn slow(&self) -> SlowResidual {
        let count: f64 = self.bins.iter().map(|(_, _, number)| number).sum();
        if count < 60.0 {
            return SlowResidual::default();
        }
        let cutoffs: Vec<f64> = std::iter::successors(Some(FEWEST_HALF_PERIODS), |k| Some(2.0 * k))
            .take_while(|k| *k <= MOST_SLOW * self.modes)
            .map(|k| std::f64::consts::PI * (k + 0.5) / self.modes)
            .collect();
        let powers: Vec<f64> = std::iter::successors(Some(LEAST_POWER), |p| Some(p * POWER_RATIO))
            .take(POWERS)
            .collect();
        let (mut noise, mut best) = ((f64::NEG_INFINITY, 0.0), (f64::NEG_INFINITY, 0.0));
        let steps = (MOST_CORRELATED / CORRELATION_STEP).round() as usize;
        for step in 0..=steps {
            let correlation = CORRELATION_STEP * step as f64;
            for white in WHITE_SHARES {
                let of_noise = |angle: f64| noise_power(angle, correlation, white);
                let alone = self.log_likelihood(of_noise);
                if alone > noise.0 {
                    noise = (alone, correlation);
                }
                for cutoff in &cutoffs {
                    for power in &powers {
                        let slow = |angle: f64| if angle < *cutoff { *power } else { 0.0 };
                        let here = self.log_likelihood(|angle| of_noise(angle) + slow(angle));
                        if here > best.0 {
                            let part = |of: &dyn Fn(f64) -> f64| -> f64 {
                                self.bins.iter().map(|(a, _, n)| n * of(*a)).sum()
                            };
                            let (slow, all) = (part(&slow), part(&of_noise) + part(&slow));
                            best = (here, slow / all);
                        }
                    }
                }
            }
        }
        SlowResidual {
            share: best.1,
            likelihood_ratio: (2.0 * (best.0 - noise.0)).max(0.0),
            correlation: noise.1,
        }
    }
}

/// The power spectrum of an autoregression of first order with a share of white noise; its variance is 1.
fn noise_power(angle: f64, correlation: f64, white: f64) -> f64 {
    let c = correlation;
    (1.0 - white) * (1.0 - c * c) / (1.0 - 2.0 * c * libm::cos(angle) + c * c) + white
}

/// Slow variation of the residuals of fits, the largest of all channels.
pub(super) fn slow_residual(
    experiment: &dyn Experiment,
    fits: &[(&[usize], &FitResult)],
    threads: Threads,
) -> Result<SlowResidual, CalibrationError> {
    let own = experiment.episode_nuisances().len();
    let slots: Vec<ParameterIndex> = (0..own).map(ParameterIndex::Own).collect();
    let each: Vec<(usize, &FitResult, usize)> = fits
        .iter()
        .flat_map(|(set, fit)| set.iter().enumerate().map(|(k, e)| (*e, *fit, k)))
        .collect();
    let columns = threads.map(each.len(), |k| {
        let (episode, fit, _) = each[k];
        let at = fit.point.values(episode);
        let base = experiment.predict(episode, &at)?;
        experiment.derivatives(episode, &at, &base, &slots)
    });
    let columns = columns.into_iter().collect::<Result<Vec<_>, _>>()?;
    let channels = experiment.channels().len();
    let found = threads.map(channels, |channel| {
        let mut sequences = Vec::new();
        for ((episode, fit, row), columns) in each.iter().zip(&columns) {
            let data = &experiment.episodes()[*episode];
            let rows: Vec<usize> = (0..data.channel.len())
                .filter(|k| data.channel[*k] == channel)
                .collect();
            if rows.len() < SHORTEST {
                continue;
            }
            let residual = rows.iter().map(|k| fit.residuals[*row][*k]).collect();
            let part = DMatrix::from_fn(rows.len(), own, |r, c| {
                columns[(rows[r], c)] / data.sd[rows[r]]
            });
            sequences.push((residual, part));
        }
        if sequences.is_empty() {
            SlowResidual::default()
        } else {
            Spectrum::new(&sequences).slow()
        }
    });
    let correlation = found.iter().map(|f| f.correlation).fold(0.0, f64::max);
    let most = found
        .into_iter()
        .max_by(|a, b| a.likelihood_ratio.total_cmp(&b.likelihood_ratio));
    Ok(SlowResidual {
        correlation,
        ..most.unwrap_or_default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::random::RandomKey;

    /// Residuals of throws whose lines were fitted: noise with memory, outliers, and a gust of another phase in each.
    fn found(seed: u64, correlation: f64, gust: f64) -> SlowResidual {
        let mut stream = RandomKey::root(seed).stream();
        let sequences: Vec<(Vec<f64>, DMatrix<f64>)> = (0..20)
            .map(|_| {
                let count = 30 + stream.below(40);
                let phase = std::f64::consts::TAU * stream.uniform();
                let mut last = stream.normal();
                let noise: Vec<f64> = (0..count)
                    .map(|k| {
                        let fresh = (1.0 - correlation * correlation).sqrt();
                        last = correlation * last + fresh * stream.normal();
                        let outlier = if stream.uniform() < 0.01 { 20.0 } else { 0.0 };
                        let slow = gust * libm::sin(14.0 * k as f64 / 60.0 + phase);
                        last + outlier + slow
                    })
                    .collect();
                let line = DMatrix::from_fn(count, 2, |r, c| if c == 0 { 1.0 } else { r as f64 });
                let basis = orthonormal(&line);
                let noise = DVector::from_vec(noise);
                let left = &noise - &basis * basis.tr_mul(&noise);
                (left.iter().copied().collect(), line)
            })
            .collect();
        Spectrum::new(&sequences).slow()
    }

    #[test]
    fn noise_with_memory_is_quiet_and_gusts_are_not() {
        for correlation in [0.0, 0.3, 0.6, 0.8, 0.9] {
            for seed in 0..12 {
                let quiet = found(seed, correlation, 0.0);
                assert!(!quiet.is_structured(), "{correlation} {seed}: {quiet:?}");
            }
        }
        for (correlation, size) in [(0.0, 0.8), (0.0, 2.0)] {
            for seed in 0..12 {
                let gust = found(seed, correlation, size);
                assert!(gust.is_structured(), "{correlation} {seed}: {gust:?}");
            }
        }
    }
}
