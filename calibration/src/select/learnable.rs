//! The learnable remainder: what a flexible learner predicts of the residuals of episodes that it has not seen.
//!
//! Noise cannot be learned, however it is correlated within an episode; a cause that is missing can, as far as it follows
//! the motion. Random Fourier features of time, value, rate and acceleration of each channel's prediction, and of the sign
//! of the rate, with ridge regression.

use crate::error::CalibrationError;
use crate::experiment::{EpisodeData, Experiment};
use crate::fit::FitResult;
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use nalgebra::{DMatrix, DVector};
use serde::Serialize;

/// Random features of each channel.
const FEATURES: usize = 48;
/// Quantities that features are made of.
const INPUTS: usize = 5;
/// Ridge, in squared standard deviations of a feature over all data.
const RIDGE_SHARE: f64 = 1e-3;
/// Draws of turned signs.
const DRAWS: usize = 400;
/// Residuals beyond so many standard deviations count as that many.
const CLIP: f64 = 5.0;

/// What a learner takes away of the squared residuals of held-out episodes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LearnableResidual {
    /// The share that it takes away; 0 and below: nothing can be learned.
    pub share: f64,
    /// The probability that noise gives as much: from residuals whose signs are turned episode by episode.
    pub probability: f64,
}

impl LearnableResidual {
    /// Returns whether the remainder is systematic.
    pub(crate) fn is_structured(&self) -> bool {
        self.share > LEAST_SHARE && self.probability < LEVEL
    }

    /// Learns on the episodes of `fit` and predicts those of `held_out`; `None` where there are too few of either.
    pub(crate) fn new(
        experiment: &dyn Experiment,
        (train, fit): (&[usize], &FitResult),
        (others, held_out): (&[usize], &FitResult),
        threads: Threads,
        key: RandomKey,
    ) -> Result<Option<Self>, CalibrationError> {
        if train.len() < FEWEST_EPISODES || others.len() < FEWEST_EPISODES {
            return Ok(None);
        }
        let rows = |set: &[usize], fit: &FitResult| {
            let done = threads.map(set.len(), |k| {
                let episode = set[k];
                let at = fit.point.values(episode);
                let prediction = experiment.predict(episode, &at)?;
                Ok::<_, CalibrationError>(inputs(&experiment.episodes()[episode], &prediction))
            });
            done.into_iter().collect::<Result<Vec<_>, _>>()
        };
        let (known, unknown) = (rows(train, fit)?, rows(others, held_out)?);
        let channels = experiment.channels().len();
        let mut predicted: Vec<Vec<f64>> = held_out
            .residuals
            .iter()
            .map(|episode| vec![0.0; episode.len()])
            .collect();
        for channel in 0..channels {
            let Some(learner) = Learner::new(
                &select(experiment, train, &known, &fit.residuals, channel),
                key.child(channel as u64),
            ) else {
                continue;
            };
            for (k, episode) in others.iter().enumerate() {
                for (row, input) in unknown[k].iter().enumerate() {
                    if experiment.episodes()[*episode].channel[row] == channel {
                        predicted[k][row] = learner.predict(input);
                    }
                }
            }
        }
        Ok(Some(Self::of(&held_out.residuals, &predicted, key)))
    }

    fn of(residuals: &[Vec<f64>], predicted: &[Vec<f64>], key: RandomKey) -> Self {
        let sums = residuals.iter().zip(predicted).map(|(episode, learned)| {
            episode
                .iter()
                .zip(learned)
                .fold([0.0; 3], |[rr, rf, ff], (r, f)| {
                    let r = r.clamp(-CLIP, CLIP);
                    [rr + r * r, rf + r * f, ff + f * f]
                })
        });
        let sums: Vec<[f64; 3]> = sums.collect();
        let total: f64 = sums.iter().map(|s| s[0]).sum();
        let taken = |sign: &mut dyn FnMut() -> f64| -> f64 {
            sums.iter().map(|s| 2.0 * sign() * s[1] - s[2]).sum()
        };
        let found = taken(&mut || 1.0);
        let mut stream = key.child("turned signs").stream();
        let by_chance = (0..DRAWS)
            .filter(|_| taken(&mut || if stream.below(2) == 0 { -1.0 } else { 1.0 }) >= found)
            .count();
        Self {
            share: if total > 0.0 { found / total } else { 0.0 },
            probability: (by_chance + 1) as f64 / (DRAWS + 1) as f64,
        }
    }
}

/// Share of the squared residuals below which what is learned is too little to matter.
const LEAST_SHARE: f64 = 0.02;
/// Probability below which noise is no explanation.
const LEVEL: f64 = 0.01;
/// Episodes below which nothing is learned, or judged.
const FEWEST_EPISODES: usize = 3;

/// The inputs of a learner at each datum: time, and value, rate, acceleration and direction of the prediction.
fn inputs(episode: &EpisodeData, prediction: &[f64]) -> Vec<[f64; INPUTS]> {
    let count = prediction.len();
    (0..count)
        .map(|k| {
            let channel = episode.channel[k];
            let near = |other: usize| other < count && episode.channel[other] == channel;
            let before = if k > 0 && near(k - 1) { k - 1 } else { k };
            let after = if near(k + 1) { k + 1 } else { k };
            let slope = |a: usize, b: usize| {
                let dt = episode.t_s[b] - episode.t_s[a];
                if dt > 0.0 {
                    (prediction[b] - prediction[a]) / dt
                } else {
                    0.0
                }
            };
            let rate = slope(before, after);
            let bend = if before < k && after > k {
                let dt = 0.5 * (episode.t_s[after] - episode.t_s[before]);
                (slope(k, after) - slope(before, k)) / dt.max(1e-9)
            } else {
                0.0
            };
            let direction = if rate == 0.0 { 0.0 } else { rate.signum() };
            [episode.t_s[k], prediction[k], rate, bend, direction]
        })
        .collect()
}

/// The data of one channel: inputs and clipped residuals.
fn select(
    experiment: &dyn Experiment,
    set: &[usize],
    rows: &[Vec<[f64; INPUTS]>],
    residuals: &[Vec<f64>],
    channel: usize,
) -> Vec<([f64; INPUTS], f64)> {
    let mut found = Vec::new();
    for ((episode, inputs), residuals) in set.iter().zip(rows).zip(residuals) {
        let channels = &experiment.episodes()[*episode].channel;
        for ((input, residual), other) in inputs.iter().zip(residuals).zip(channels) {
            if *other == channel {
                found.push((*input, residual.clamp(-CLIP, CLIP)));
            }
        }
    }
    found
}

/// Ridge regression on random Fourier features.
///
/// # Source
/// A. Rahimi, B. Recht, Random Features for Large-Scale Kernel Machines, NIPS 20 (2007).
struct Learner {
    mean: [f64; INPUTS],
    scale: [f64; INPUTS],
    /// Frequencies and phase of each feature.
    waves: Vec<([f64; INPUTS], f64)>,
    weights: DVector<f64>,
}

impl Learner {
    fn new(data: &[([f64; INPUTS], f64)], key: RandomKey) -> Option<Self> {
        if data.len() < 2 * FEATURES {
            return None;
        }
        let count = data.len() as f64;
        let mean: [f64; INPUTS] =
            std::array::from_fn(|k| data.iter().map(|(x, _)| x[k]).sum::<f64>() / count);
        let scale = std::array::from_fn(|k| {
            let square: f64 = data.iter().map(|(x, _)| (x[k] - mean[k]).powi(2)).sum();
            let sd = (square / count).sqrt();
            if sd > 0.0 { 1.0 / sd } else { 0.0 }
        });
        let mut stream = key.child("waves").stream();
        // Points of a normal distribution are about sqrt(2 INPUTS) apart: a kernel narrower than that sees no neighbours.
        let width = (2.0 * INPUTS as f64).sqrt();
        let waves = (0..FEATURES)
            .map(|_| {
                let frequency = std::array::from_fn(|_| stream.normal() / width);
                (frequency, std::f64::consts::TAU * stream.uniform())
            })
            .collect();
        let mut learner = Self {
            mean,
            scale,
            waves,
            weights: DVector::zeros(FEATURES + 1),
        };
        let size = FEATURES + 1;
        let (mut normal, mut right) = (DMatrix::zeros(size, size), DVector::zeros(size));
        for (input, residual) in data {
            let features = learner.features(input);
            normal.ger(1.0, &features, &features, 1.0);
            right.axpy(*residual, &features, 1.0);
        }
        for k in 0..size {
            normal[(k, k)] += RIDGE_SHARE * count;
        }
        learner.weights = normal.cholesky()?.solve(&right);
        Some(learner)
    }

    fn features(&self, input: &[f64; INPUTS]) -> DVector<f64> {
        let scaled: [f64; INPUTS] =
            std::array::from_fn(|k| (input[k] - self.mean[k]) * self.scale[k]);
        DVector::from_fn(FEATURES + 1, |k, _| match self.waves.get(k) {
            Some((frequency, phase)) => {
                let products = frequency.iter().zip(&scaled).map(|(a, b)| a * b);
                libm::cos(products.sum::<f64>() + phase)
            }
            None => 1.0,
        })
    }

    fn predict(&self, input: &[f64; INPUTS]) -> f64 {
        self.weights.dot(&self.features(input))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_smooth_relation_is_learned_and_noise_is_not() {
        let mut stream = RandomKey::root(3).stream();
        let mut data = |noise: f64| -> Vec<([f64; INPUTS], f64)> {
            (0..800)
                .map(|_| {
                    let x: [f64; INPUTS] = std::array::from_fn(|_| stream.normal());
                    let y = libm::sin(x[1]) + 0.5 * x[2];
                    (x, y * (1.0 - noise) + noise * stream.normal())
                })
                .collect()
        };
        for (noise, least, most) in [(0.2, 0.6, 1.0), (1.0, -0.3, 0.02)] {
            let learner = Learner::new(&data(noise), RandomKey::root(4)).unwrap();
            let test = data(noise);
            let residuals: Vec<Vec<f64>> = test
                .chunks(80)
                .map(|c| c.iter().map(|d| d.1).collect())
                .collect();
            let predicted: Vec<Vec<f64>> = test
                .chunks(80)
                .map(|c| c.iter().map(|d| learner.predict(&d.0)).collect())
                .collect();
            let found = LearnableResidual::of(&residuals, &predicted, RandomKey::root(5));
            assert!((least..=most).contains(&found.share), "{noise}: {found:?}");
            assert_eq!(found.is_structured(), noise < 1.0, "{found:?}");
        }
    }
}
