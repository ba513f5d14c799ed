//! Linear screening: what each cause would gain to first order, and what the largest gain over the library is by chance.
//!
//! Every cause is simulated once for each parameter and probe. What its columns explain of the residuals, with all
//! nuisances projected out, follows by linear algebra; so does the same for residuals whose signs are turned episode by
//! episode, which leaves noise, its correlation in time and its tails as they are and no effect standing.

use super::compare::{CauseComparer, Estimate};
use crate::error::CalibrationError;
use crate::experiment::{Cause, Experiment, ParameterIndex, ParameterVector, parameter_range};
use crate::fit::{FitResult, HuberLoss};
use dwell_scene::random::RandomKey;
use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// Draws of turned signs.
const NULL_DRAWS: usize = 400;
/// Share of the draws whose largest gain lies below the threshold.
const NULL_QUANTILE: f64 = 0.99;
/// Change of the sum of squares that can be seen, squared standard deviations.
const SEEN: f64 = 1.0;
/// Part of a column's size below which nothing of it is left beside nuisances.
const NOTHING_LEFT: f64 = 1e-6;
/// Part of a column's size in whose direction a parameter counts as determined.
const DETERMINED: f64 = 1e-4;

/// The columns of a probe: its whole effect, and beside it the derivatives there by several parameters: a law that begins to
/// act at once has none at its default.
fn probe_columns(cause: &Cause) -> usize {
    match cause.parameters.len() {
        1 => 1,
        several => 1 + several,
    }
}

/// The columns of a cause: derivatives, or the whole effect of a probe.
struct ColumnBlock {
    cause: usize,
    columns: Range<usize>,
    is_probe: bool,
}

/// The linear view of a library around a fit.
pub(super) struct LinearScreening {
    blocks: Vec<ColumnBlock>,
    /// Normal matrices of each episode over shared nuisances, columns and residual, own nuisances eliminated.
    grams: Vec<DMatrix<f64>>,
    shared: usize,
}

/// What a cause would gain to first order.
#[derive(Clone, Debug)]
pub(super) struct LinearGain {
    pub(super) cause: usize,
    /// Fall of the sum of squares, in squared standard deviations.
    pub(super) gain: f64,
    /// Its parameters by their derivatives; empty where the data do not determine them.
    pub(super) changes: Vec<f64>,
    /// The inverse of their normal matrix. Shape (parameter, parameter).
    pub(super) inverse: DMatrix<f64>,
    /// True if nothing in the data depends on it.
    pub(super) is_idle: bool,
}

impl LinearScreening {
    /// Simulates the causes `which` around a fit on the training episodes.
    pub(super) fn new(
        all: &CauseComparer<'_>,
        fit: &FitResult,
        which: &[usize],
    ) -> Result<Self, CalibrationError> {
        let experiment = all.experiment;
        let mut blocks = Vec::new();
        let mut count = 0;
        let mut add = |cause: usize, columns: usize, is_probe: bool| {
            blocks.push(ColumnBlock {
                cause,
                columns: count..count + columns,
                is_probe,
            });
            count += columns;
        };
        for cause in which {
            let info = &experiment.causes()[*cause];
            add(*cause, info.parameters.len(), false);
            for _ in &info.probes {
                add(*cause, probe_columns(info), true);
            }
        }
        let shared = experiment.shared_nuisances().len();
        let loss = HuberLoss::from_residuals(fit.residuals.iter().flatten());
        all.progress.check()?;
        let train = &all.split.train;
        let deadline = all.progress.deadline();
        let grams = all.threads.map(train.len(), |k| {
            let episode = train[k];
            // Of a search that ends early the first episodes say what looks promising.
            if k > 0 && deadline.is_over() {
                return None;
            }
            let residual = &fit.residuals[k];
            Some(episode_gram(
                experiment, episode, fit, residual, which, loss,
            ))
        });
        Ok(Self {
            blocks,
            grams: grams.into_iter().flatten().collect::<Result<_, _>>()?,
            shared,
        })
    }

    /// The normal matrix over columns and residual, shared nuisances eliminated, with each episode's residual times a sign.
    fn reduced(&self, grams: &[DMatrix<f64>], signs: impl Fn(usize) -> f64) -> DMatrix<f64> {
        let size = grams.first().map_or(0, DMatrix::nrows);
        let mut sum = DMatrix::zeros(size, size);
        for (episode, gram) in grams.iter().enumerate() {
            let sign = signs(episode);
            let last = size - 1;
            for c in 0..size {
                for r in 0..size {
                    let turned = (r == last) != (c == last);
                    sum[(r, c)] += if turned { sign } else { 1.0 } * gram[(r, c)];
                }
            }
        }
        eliminate(&sum, self.shared)
    }

    /// What each cause gains, in the order in which they were asked for.
    pub(super) fn gains(&self, experiment: &dyn Experiment) -> Vec<LinearGain> {
        let gram = self.reduced(&self.grams, |_| 1.0);
        let mut found: Vec<LinearGain> = Vec::new();
        for block in &self.blocks {
            let (gain, changes, inverse) = block_gain(&gram, &block.columns);
            if block.is_probe {
                let last = found.last_mut().expect("derivatives come before probes");
                // A probe says how much of an effect there is, which is none against its direction.
                if changes[0] > 0.0 && gain > last.gain {
                    last.gain = gain;
                }
                let first = block.columns.start;
                last.is_idle &= gram[(first, first)] < SEEN;
                continue;
            }
            // The whole plausible range of a parameter moves the sum of squares by less than one standard deviation's.
            let parameters = experiment.causes()[block.cause].parameters.iter();
            let is_unseen = parameters.zip(block.columns.clone()).all(|(parameter, k)| {
                let [low, high] = parameter
                    .plausible
                    .map(|end| (end - parameter.default).abs());
                let width = low.max(high).min(parameter.high - parameter.low);
                width.is_finite() && gram[(k, k)] * width * width < SEEN
            });
            found.push(LinearGain {
                cause: block.cause,
                is_idle: is_unseen,
                gain,
                changes,
                inverse,
            });
        }
        found
    }

    /// The gain that the best of all causes reaches by chance in one of a hundred cases: the residuals without the best
    /// cause's part, each episode's turned at random.
    ///
    /// # Source
    /// P. H. Westfall, S. S. Young, Resampling-Based Multiple Testing (1993): the largest statistic; signs as in
    /// A. M. Winkler et al., `NeuroImage` 92, 381 (2014).
    pub(super) fn gain_by_chance(&self, key: RandomKey) -> f64 {
        let gram = self.reduced(&self.grams, |_| 1.0);
        let best = self
            .blocks
            .iter()
            .map(|block| (block_gain(&gram, &block.columns), block))
            .max_by(|a, b| a.0.0.total_cmp(&b.0.0));
        let Some(((_, changes, _), best)) = best else {
            return 0.0;
        };
        let cleaned: Vec<DMatrix<f64>> = self
            .grams
            .iter()
            .map(|gram| without(gram, self.shared, &best.columns, &changes))
            .collect();
        let mut stream = key.child("turned signs").stream();
        let mut largest: Vec<f64> = (0..NULL_DRAWS)
            .map(|_| {
                let signs: Vec<f64> = (0..cleaned.len())
                    .map(|_| if stream.below(2) == 0 { -1.0 } else { 1.0 })
                    .collect();
                let gram = self.reduced(&cleaned, |episode| signs[episode]);
                let gains = self.blocks.iter().map(|b| block_gain(&gram, &b.columns).0);
                gains.fold(0.0, f64::max)
            })
            .collect();
        largest.sort_by(f64::total_cmp);
        largest[(NULL_QUANTILE * (NULL_DRAWS - 1) as f64) as usize]
    }
}

impl LinearGain {
    /// The parameters of the cause to first order, with standard deviations for residuals of this mean square.
    pub(super) fn estimates(
        &self,
        experiment: &dyn Experiment,
        point: &ParameterVector,
        mean_square: f64,
    ) -> Vec<Estimate> {
        let range = parameter_range(experiment, self.cause);
        range
            .zip(&self.changes)
            .enumerate()
            .map(|(k, (slot, change))| {
                let variance = self.inverse[(k, k)] * mean_square;
                Estimate {
                    value: point.causes[slot] + change,
                    // A parameter that nothing depends on may be anything.
                    sd: if variance > 0.0 {
                        variance.sqrt()
                    } else {
                        f64::INFINITY
                    },
                }
            })
            .collect()
    }
}

/// Everything of one episode: weighted columns, own nuisances eliminated.
fn episode_gram(
    experiment: &dyn Experiment,
    episode: usize,
    fit: &FitResult,
    residual: &[f64],
    which: &[usize],
    loss: HuberLoss,
) -> Result<DMatrix<f64>, CalibrationError> {
    let measured = &experiment.episodes()[episode];
    let at = fit.point.values(episode);
    let base = experiment.predict(episode, &at)?;
    let own = (0..experiment.episode_nuisances().len()).map(ParameterIndex::Own);
    let shared = (0..experiment.shared_nuisances().len()).map(ParameterIndex::Shared);
    let nuisances: Vec<ParameterIndex> = own.chain(shared).collect();
    let mut columns = experiment.derivatives(episode, &at, &base, &nuisances)?;
    for cause in which {
        let range = parameter_range(experiment, *cause);
        let slots: Vec<ParameterIndex> = range.clone().map(ParameterIndex::Cause).collect();
        let derivatives = experiment
            .derivatives(episode, &at, &base, &slots)
            // What the engine refuses as a small change is no small effect.
            .unwrap_or_else(|_| DMatrix::zeros(base.len(), slots.len()));
        columns = beside(columns, &derivatives);
        let info = &experiment.causes()[*cause];
        for probe in &info.probes {
            let mut there = fit.point.clone();
            there.causes[range.clone()].copy_from_slice(probe);
            let at_probe = there.values(episode);
            let nothing = |columns: usize| DMatrix::zeros(base.len(), columns);
            let Ok(changed) = experiment.predict(episode, &at_probe) else {
                columns = beside(columns, &nothing(probe_columns(info)));
                continue;
            };
            let effect: Vec<f64> = changed.iter().zip(&base).map(|(a, b)| a - b).collect();
            columns = beside(columns, &DMatrix::from_column_slice(base.len(), 1, &effect));
            if probe_columns(info) > 1 {
                let more = experiment.derivatives(episode, &at_probe, &changed, &slots);
                columns = beside(columns, &more.unwrap_or_else(|_| nothing(slots.len())));
            }
        }
    }
    for (row, sd) in measured.sd.iter().enumerate() {
        let weight = loss.weight(residual[row]).sqrt();
        columns.row_mut(row).scale_mut(weight / sd);
    }
    let weighted: Vec<f64> = residual
        .iter()
        .map(|r| r * loss.weight(*r).sqrt())
        .collect();
    let whole = beside(
        columns,
        &DMatrix::from_column_slice(base.len(), 1, &weighted),
    );
    Ok(eliminate(
        &whole.tr_mul(&whole),
        experiment.episode_nuisances().len(),
    ))
}

fn beside(left: DMatrix<f64>, right: &DMatrix<f64>) -> DMatrix<f64> {
    let (rows, first) = (right.nrows(), left.ncols());
    let mut both = left.resize(rows, first + right.ncols(), 0.0);
    both.columns_mut(first, right.ncols()).copy_from(right);
    both
}

/// Schur's complement of the first `count` rows and columns of a normal matrix.
fn eliminate(gram: &DMatrix<f64>, count: usize) -> DMatrix<f64> {
    let rest = gram.nrows() - count;
    let corner = gram.view((count, count), (rest, rest)).into_owned();
    if count == 0 {
        return corner;
    }
    let mixed = gram.view((0, count), (count, rest)).into_owned();
    let (inverse, _) = pseudo_inverse(&gram.view((0, 0), (count, count)).into_owned(), 1e-12);
    let mut reduced = corner - mixed.tr_mul(&(inverse * &mixed));
    for k in 0..rest {
        // What is left of a column by rounding alone is nothing.
        if reduced[(k, k)] < NOTHING_LEFT * gram[(count + k, count + k)] {
            reduced.row_mut(k).fill(0.0);
            reduced.column_mut(k).fill(0.0);
        }
    }
    reduced
}

/// The inverse on the directions that are determined, after scaling to a unit diagonal, and the rank.
fn pseudo_inverse(matrix: &DMatrix<f64>, least: f64) -> (DMatrix<f64>, usize) {
    let size = matrix.nrows();
    let scale = DVector::from_fn(size, |k, _| {
        let d = matrix[(k, k)];
        if d > 0.0 { 1.0 / d.sqrt() } else { 0.0 }
    });
    let scaled = DMatrix::from_fn(size, size, |r, c| matrix[(r, c)] * scale[r] * scale[c]);
    let eigen = scaled.symmetric_eigen();
    let mut inverse = DMatrix::zeros(size, size);
    let mut rank = 0;
    for k in 0..size {
        let value = eigen.eigenvalues[k];
        if value > least {
            let v = eigen.eigenvectors.column(k);
            inverse += v * v.transpose() / value;
            rank += 1;
        }
    }
    let inverse = DMatrix::from_fn(size, size, |r, c| inverse[(r, c)] * scale[r] * scale[c]);
    (inverse, rank)
}

/// Gain, changes and inverse of a block in a reduced normal matrix whose last column is the residual.
fn block_gain(gram: &DMatrix<f64>, columns: &Range<usize>) -> (f64, Vec<f64>, DMatrix<f64>) {
    let (first, count, last) = (columns.start, columns.len(), gram.ncols() - 1);
    let block = gram.view((first, first), (count, count)).into_owned();
    let right = gram.view((first, last), (count, 1)).into_owned();
    let (inverse, _) = pseudo_inverse(&block, DETERMINED);
    let changes = &inverse * &right;
    let gain = right.dot(&changes);
    (gain, changes.iter().copied().collect(), inverse)
}

/// A normal matrix whose residual lacks `changes` of the columns.
fn without(
    gram: &DMatrix<f64>,
    shared: usize,
    columns: &Range<usize>,
    changes: &[f64],
) -> DMatrix<f64> {
    let size = gram.nrows();
    let mut weights = DVector::zeros(size);
    weights[size - 1] = 1.0;
    for (k, change) in columns.clone().zip(changes) {
        weights[shared + k] -= change;
    }
    let residual = gram * &weights;
    let square = weights.dot(&residual);
    let mut cleaned = gram.clone();
    for k in 0..size - 1 {
        cleaned[(k, size - 1)] = residual[k];
        cleaned[(size - 1, k)] = residual[k];
    }
    cleaned[(size - 1, size - 1)] = square;
    cleaned
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Eliminating gives what a regression on all columns at once gives for the rest.
    #[test]
    fn elimination_is_regression() {
        let value = |k: usize| ((k * 7919 + 13) % 101) as f64 / 50.0 - 1.0;
        let whole = DMatrix::from_fn(30, 5, |r, c| value(r * 17 + c * 5 + r * c));
        let reduced = eliminate(&whole.tr_mul(&whole), 2);
        let (nuisances, rest) = (whole.columns(0, 2), whole.columns(2, 3));
        let projector = nuisances * (nuisances.tr_mul(&nuisances)).try_inverse().unwrap();
        let left = rest - &projector * nuisances.tr_mul(&rest);
        assert!((reduced - left.tr_mul(&left)).norm() < 1e-9);
    }

    /// A column that is a nuisance explains nothing.
    #[test]
    fn what_a_nuisance_explains_is_no_gain() {
        let value = |k: usize| ((k * 7919 + 13) % 101) as f64 / 50.0 - 1.0;
        let mut whole = DMatrix::from_fn(30, 3, |r, c| value(r * 17 + c * 5 + r * c));
        let copied = 3.0 * whole.column(0);
        whole.column_mut(1).copy_from(&copied);
        let reduced = eliminate(&whole.tr_mul(&whole), 1);
        let (gain, changes, inverse) = block_gain(&reduced, &(0..1));
        assert_eq!((gain, changes[0], inverse[(0, 0)]), (0.0, 0.0, 0.0));
    }
}
