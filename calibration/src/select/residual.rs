//! Residuals between measurement and simulation.

use super::learnable::LearnableResidual;
use super::quantum::rounding_sd;
use super::spectrum::SlowResidual;
use crate::experiment::{Experiment, ResidualStructure};
use crate::median::median;
use serde::Serialize;
use std::collections::BTreeMap;

/// The residuals of one channel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChannelResidual {
    /// The channel.
    pub channel: String,
    /// Its unit.
    pub unit: String,
    /// Number of residuals.
    pub count: usize,
    /// Effective number of independent residuals, by their autocorrelation.
    pub effective_count: f64,
    /// Correlation of residuals with the next one.
    pub autocorrelation: f64,
    /// Mean of measured minus simulated, in the unit.
    pub bias: f64,
    /// Root of the mean square, in the unit.
    pub rms: f64,
    /// Standard deviation of the noise, in the unit: declared, or estimated from differences of neighbours.
    pub noise_sd: f64,
    /// True if the bundle (or theory) states the noise.
    pub noise_known: bool,
    /// Mean square over the noise's: 1 for noise alone.
    pub chi2_per_count: f64,
}

/// Sequences of neighbours: the positions of an episode's data by channel, in order.
fn sequences(channel: &[usize]) -> Vec<std::ops::Range<usize>> {
    let mut found = Vec::new();
    let mut start = 0;
    for k in 1..=channel.len() {
        if k == channel.len() || channel[k] != channel[start] {
            found.push(start..k);
            start = k;
        }
    }
    found
}

/// Correlation of neighbours, pooled over sequences.
fn autocorrelation(sequences: &[&[f64]]) -> f64 {
    let (mut product, mut square) = (0.0, 0.0);
    for sequence in sequences {
        product += sequence
            .windows(2)
            .map(|pair| pair[0] * pair[1])
            .sum::<f64>();
        square += sequence.iter().map(|r| r * r).sum::<f64>();
    }
    if square > 0.0 { product / square } else { 0.0 }
}

/// Returns the effective number of `count` autocorrelated values.
///
/// # Source
/// G. V. Bayley, J. M. Hammersley, Suppl. J. R. Stat. Soc. 8, 184 (1946), for an autoregression of first order.
pub(super) fn effective_sample_size(count: usize, autocorrelation: f64) -> f64 {
    let rho = autocorrelation.clamp(0.0, 0.98);
    // Correlations within chance count as none.
    if rho < 2.0 / (count.max(1) as f64).sqrt() {
        return count as f64;
    }
    (count as f64 * (1.0 - rho) / (1.0 + rho)).max(1.0)
}

/// The noise of residuals as a process: what neighbours differ by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct NoiseFloor {
    pub(crate) sd: f64,
    /// Correlation of the noise with the next sample's.
    pub(crate) correlation: f64,
}

/// Largest correlation of neighbours that counts as one of noise.
const MOST_CORRELATED: f64 = 0.95;
/// The longest distance that noise may remember, samples.
const MOST_LAG: usize = 20;
/// Correlation that counts as forgotten.
const FORGOTTEN: f64 = 0.1;
/// Correlation above which distant values are alike.
const ALIKE: f64 = 0.15;
/// Outliers count as so many medians.
const OUTLIER_MEDIANS: f64 = 6.0;

/// Mean square of the differences of an order, outliers clipped.
fn mean_square_difference(sequences: &[&[f64]], weights: &[f64]) -> (f64, usize) {
    let mut sizes: Vec<f64> = sequences
        .iter()
        .flat_map(|sequence| {
            sequence
                .windows(weights.len())
                .map(|w| w.iter().zip(weights).map(|(a, b)| a * b).sum::<f64>().abs())
        })
        .collect();
    let count = sizes.len();
    let limit = OUTLIER_MEDIANS * median(&mut sizes);
    let clipped = sizes.iter().map(|size| size.min(limit).powi(2));
    (clipped.sum::<f64>() / count.max(1) as f64, count)
}

/// Returns whether values far apart are more alike than an autoregression of first order with this correlation allows.
///
/// # Source
/// M. S. Bartlett, Suppl. J. R. Stat. Soc. 8, 27 (1946), for the variance of autocorrelations.
fn remembers(sequences: &[&[f64]], correlation: f64) -> bool {
    let count: usize = sequences.iter().map(|sequence| sequence.len()).sum();
    let square: f64 = sequences.iter().flat_map(|s| s.iter()).map(|r| r * r).sum();
    let forgotten = (1..=MOST_LAG).find(|lag| libm::pow(correlation, *lag as f64) < FORGOTTEN);
    let first = forgotten.unwrap_or(MOST_LAG);
    (first..=2 * MOST_LAG).any(|lag| {
        let pairs: usize = sequences.iter().map(|s| s.len().saturating_sub(lag)).sum();
        if 2 * pairs < count || square <= 0.0 {
            return false;
        }
        let product: f64 = sequences
            .iter()
            .flat_map(|s| s.iter().zip(s.iter().skip(lag)))
            .map(|(a, b)| a * b)
            .sum();
        let alike = (product / pairs as f64) / (square / count as f64);
        // The standard deviation of an autocorrelation after noise has forgotten (Bartlett).
        let c2 = correlation * correlation;
        let sd = ((1.0 + c2) / (1.0 - c2) / pairs as f64).sqrt();
        alike.abs() > ALIKE + 3.0 * sd
    })
}

/// The noise of a residual from its differences, in which what is smooth cancels. `None` for fewer than 12 third
/// differences, and where most neighbours are equal.
///
/// # Source
/// For an autoregression of first order with variance s² and correlation c the mean squares of first, second and third
/// differences are 2 (1 - c) s² times 1, 3 - c and 10 - 5 c + c²; for white noise 2, 6 and 20 s².
pub(crate) fn noise_from_differences(sequences: &[&[f64]]) -> Option<NoiseFloor> {
    let (first, _) = mean_square_difference(sequences, &[1.0, -1.0]);
    let (second, _) = mean_square_difference(sequences, &[1.0, -2.0, 1.0]);
    let (third, count) = mean_square_difference(sequences, &[1.0, -3.0, 3.0, -1.0]);
    if count < 12 || first <= 0.0 || third <= 0.0 {
        return None;
    }
    let found = (3.0 - second / first).clamp(0.0, MOST_CORRELATED);
    // The estimate's own error is about 3 / sqrt(n): what is certain of it is taken. Noise forgets; what is still alike when
    // it should have is motion that was not modelled.
    let mut c = (found - 6.0 / (count as f64).sqrt()).max(0.0);
    if remembers(sequences, found) {
        c = 0.0;
    }
    let share = 2.0 * (1.0 - c) * (10.0 - 5.0 * c + c * c);
    Some(NoiseFloor {
        sd: (third / share).sqrt(),
        correlation: c,
    })
}

/// Root mean square of the standard deviations of a channel, in its unit.
fn mean_sd(experiment: &dyn Experiment, set: &[usize], channel: usize) -> f64 {
    let episodes = set.iter().map(|episode| &experiment.episodes()[*episode]);
    let (sum, count) = episodes
        .flat_map(|episode| episode.sd.iter().zip(&episode.channel))
        .filter(|(_, other)| **other == channel)
        .fold((0.0, 0), |(sum, count), (sd, _)| (sum + sd * sd, count + 1));
    (sum / f64::from(count.max(1)))
        .sqrt()
        .max(f64::MIN_POSITIVE)
}

/// Splits residuals of a set by channel. `residuals`: in standard deviations, shape (episode of the set, datum).
fn by_sequence<'a>(
    experiment: &dyn Experiment,
    set: &[usize],
    residuals: &'a [Vec<f64>],
) -> BTreeMap<usize, Vec<&'a [f64]>> {
    let mut all: BTreeMap<usize, Vec<&[f64]>> = BTreeMap::new();
    for (episode, residual) in set.iter().zip(residuals) {
        let channel = &experiment.episodes()[*episode].channel;
        for range in sequences(channel) {
            all.entry(channel[range.start])
                .or_default()
                .push(&residual[range]);
        }
    }
    all
}

/// The residual report.
pub(crate) fn channel_residuals(
    experiment: &dyn Experiment,
    set: &[usize],
    residuals: &[Vec<f64>],
) -> Vec<ChannelResidual> {
    let mut report = Vec::new();
    for (index, info) in experiment.channels().iter().enumerate() {
        let mut values = Vec::new();
        let mut normalised = Vec::new();
        let mut squares_of_sd = 0.0;
        for (episode, residual) in set.iter().zip(residuals) {
            let measured = &experiment.episodes()[*episode];
            for (k, r) in residual
                .iter()
                .enumerate()
                .filter(|(k, _)| measured.channel[*k] == index)
            {
                values.push(r * measured.sd[k]);
                normalised.push(*r);
                squares_of_sd += measured.sd[k].powi(2);
            }
        }
        if values.is_empty() {
            continue;
        }
        let sequences = by_sequence(experiment, set, residuals)
            .remove(&index)
            .unwrap_or_default();
        let n = values.len() as f64;
        let rho = autocorrelation(&sequences);
        report.push(ChannelResidual {
            channel: info.name.clone(),
            unit: info.unit.clone(),
            count: values.len(),
            effective_count: effective_sample_size(values.len(), rho),
            autocorrelation: rho,
            bias: values.iter().sum::<f64>() / n,
            rms: (values.iter().map(|r| r * r).sum::<f64>() / n).sqrt(),
            noise_sd: (squares_of_sd / n).sqrt(),
            noise_known: info.noise_known,
            chi2_per_count: normalised.iter().map(|r| r * r).sum::<f64>() / n,
        });
    }
    report
}

/// Returns the effective number of all residuals.
pub(super) fn effective_count(
    experiment: &dyn Experiment,
    set: &[usize],
    residuals: &[Vec<f64>],
) -> f64 {
    match experiment.residual_structure() {
        ResidualStructure::OverTime => {
            let all = by_sequence(experiment, set, residuals);
            let counted = all.values().map(|sequences| {
                let count = sequences.iter().map(|sequence| sequence.len()).sum();
                effective_sample_size(count, autocorrelation(sequences))
            });
            counted.sum()
        }
        ResidualStructure::ByCell => {
            // Data of one episode share its geometry and its rays: episodes are clusters.
            let count: usize = residuals.iter().map(Vec::len).sum();
            let square: f64 =
                residuals.iter().flatten().map(|r| r * r).sum::<f64>() / count.max(1) as f64;
            let clusters: f64 = residuals
                .iter()
                .filter(|episode| !episode.is_empty())
                .map(|episode| episode.iter().sum::<f64>().powi(2) / episode.len() as f64)
                .sum::<f64>()
                / residuals.len().max(1) as f64;
            let effect = if square > 0.0 {
                (clusters / square).max(1.0)
            } else {
                1.0
            };
            count as f64 / effect
        }
    }
}

/// A test for residuals beyond noise.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ResidualNoiseTest {
    /// What can be learned of it; `null` where that is not tried: responses of rooms, or too few episodes.
    pub learnable: Option<LearnableResidual>,
    /// What varies slowly within episodes; `null` for responses of rooms.
    pub slow: Option<SlowResidual>,
    /// Mean square of the residuals over that of their noise: 1 for noise alone.
    pub ratio: f64,
    /// The ratio above which noise alone is no explanation.
    pub threshold: f64,
}

impl ResidualNoiseTest {
    /// Returns whether something systematic is left.
    pub(crate) fn is_structured(&self) -> bool {
        self.ratio > self.threshold
            || self.learnable.is_some_and(|found| found.is_structured())
            || self.slow.is_some_and(|found| found.is_structured())
    }

    pub(crate) fn of(experiment: &dyn Experiment, set: &[usize], residuals: &[Vec<f64>]) -> Self {
        match experiment.residual_structure() {
            ResidualStructure::OverTime => Self::in_time(experiment, set, residuals),
            ResidualStructure::ByCell => Self::in_cells(experiment, set, residuals),
        }
    }

    fn in_time(experiment: &dyn Experiment, set: &[usize], residuals: &[Vec<f64>]) -> Self {
        let (mut sum, mut count) = (0.0, 0);
        let rounding = rounding_sd(experiment);
        for (channel, sequences) in &by_sequence(experiment, set, residuals) {
            let all = || sequences.iter().flat_map(|sequence| sequence.iter());
            let found = noise_from_differences(sequences).map(|floor| floor.sd);
            // Residuals count standard deviations.
            let rounding = rounding
                .get(channel)
                .map(|sd| sd / mean_sd(experiment, set, *channel));
            let Some(floor) = found.into_iter().chain(rounding).reduce(f64::max) else {
                continue;
            };
            // A few outliers are no structure.
            let mut sizes: Vec<f64> = all().map(|r| r.abs()).collect();
            let limit = 4.5 * median(&mut sizes);
            sum += all()
                .map(|r| (r.abs().min(limit) / floor).powi(2))
                .sum::<f64>();
            count += sizes.len();
        }
        let n = count.max(1) as f64;
        Self {
            learnable: None,
            slow: None,
            ratio: if count > 0 { sum / n } else { 1.0 },
            // The floor's own error by the median of autocorrelated differences is about 2.5/sqrt(n).
            threshold: 1.25 + 12.0 / n.sqrt(),
        }
    }

    fn in_cells(experiment: &dyn Experiment, set: &[usize], residuals: &[Vec<f64>]) -> Self {
        let mut cells: BTreeMap<(usize, u64), Vec<f64>> = BTreeMap::new();
        for (episode, residual) in set.iter().zip(residuals) {
            let measured = &experiment.episodes()[*episode];
            for (k, r) in residual.iter().enumerate() {
                cells
                    .entry((measured.channel[k], measured.t_s[k].to_bits()))
                    .or_default()
                    .push(*r);
            }
        }
        let (mut common, mut within, mut freedom) = (0.0, 0.0, 0.0);
        // A single number has nothing in common with others.
        cells.retain(|_, values| values.len() > 1);
        for values in cells.values() {
            let n = values.len() as f64;
            let mean = values.iter().sum::<f64>() / n;
            common += n * mean * mean;
            within += values.iter().map(|r| (r - mean).powi(2)).sum::<f64>();
            freedom += n - 1.0;
        }
        let count = cells.len().max(1) as f64;
        let within = within / f64::max(freedom, 1.0);
        Self {
            learnable: None,
            slow: None,
            ratio: if within > 0.0 {
                common / count / within
            } else {
                1.0
            },
            // The simulation's own approximations leave common parts of about a third of the chance in a level.
            threshold: 2.5 + 6.0 * (2.0 / count).sqrt(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::random::RandomKey;

    #[test]
    fn noise_is_seen_through_a_smooth_misfit() {
        for seed in 0..5 {
            let mut stream = RandomKey::root(seed).stream();
            let values: Vec<f64> = (0..400)
                .map(|k| 3.0 * (f64::from(k) * 0.02).sin() + 0.1 * stream.normal())
                .collect();
            let found = noise_from_differences(&[&values]).unwrap();
            assert!((found.sd / 0.1 - 1.0).abs() < 0.25, "{found:?}");
        }
        assert_eq!(noise_from_differences(&[&[1.0, 2.0, 3.0]]), None);
    }

    #[test]
    fn correlated_numbers_are_worth_less() {
        let mut stream = RandomKey::root(1).stream();
        let mut last = 0.0;
        let correlated: Vec<f64> = (0..2000)
            .map(|_| {
                last = 0.9 * last + stream.normal();
                last
            })
            .collect();
        let floor = noise_from_differences(&[&correlated]).unwrap();
        let sd = 1.0 / (1.0_f64 - 0.81).sqrt();
        assert!((floor.sd / sd - 1.0).abs() < 0.4, "{floor:?} {sd}");
        let rho = autocorrelation(&[&correlated]);
        assert!((rho - 0.9).abs() < 0.05, "{rho}");
        let worth = effective_sample_size(2000, rho);
        assert!(worth > 50.0 && worth < 250.0, "{worth}");
        let white: Vec<f64> = (0..2000).map(|_| stream.normal()).collect();
        assert!(effective_sample_size(2000, autocorrelation(&[&white])) > 1900.0);
    }

    #[test]
    fn sequences_end_where_the_channel_changes() {
        assert_eq!(sequences(&[0, 0, 1, 1, 1]), [0..2, 2..5]);
    }
}
