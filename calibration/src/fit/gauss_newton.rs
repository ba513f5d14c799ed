//! The damped Gauss-Newton iteration.

use super::normal::{self, NormalBlock};
use super::robust::HuberLoss;
use crate::error::CalibrationError;
use crate::experiment::{Experiment, ParameterIndex, ParameterVector, parameter_range};
use crate::progress::ProgressReporter;
use dwell_scene::parallel::Threads;
use nalgebra::{DMatrix, DVector};

const MOST_ITERATIONS: usize = 12;
/// Iterations of the second stage, in which outliers count less.
const MOST_ROBUST_ITERATIONS: usize = 4;
const MOST_DAMPINGS: usize = 6;
/// Fall of the loss, in mean squared residuals, at which the iteration ends: a fiftieth of what one datum brings.
const TOLERANCE: f64 = 0.02;

/// The causes that are fitted, by position; nuisances always are.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct CauseSet {
    pub(crate) causes: Vec<usize>,
    /// Positions in [`ParameterVector::causes`] that stay at their default: their causes act by other parameters.
    pub(crate) held: Vec<usize>,
}

impl CauseSet {
    /// The positions in [`ParameterVector::causes`] that are fitted.
    pub(crate) fn parameter_indices(&self, experiment: &dyn Experiment) -> Vec<usize> {
        self.causes
            .iter()
            .flat_map(|cause| parameter_range(experiment, *cause))
            .filter(|slot| !self.held.contains(slot))
            .collect()
    }
}

/// The inputs of a fit.
pub(crate) struct FitTask<'a> {
    pub(crate) experiment: &'a dyn Experiment,
    /// The episodes, by position.
    pub(crate) set: &'a [usize],
    pub(crate) threads: Threads,
    pub(crate) robust: bool,
    pub(crate) progress: &'a dyn ProgressReporter,
}

/// The end point of a fit.
#[derive(Clone, Debug)]
pub(crate) struct FitResult {
    pub(crate) point: ParameterVector,
    /// Weighted sum of squares (or of the robust loss).
    pub(crate) loss: f64,
    /// Data, and parameters that all episodes share.
    pub(crate) data: usize,
    pub(crate) parameters: usize,
    /// (measured - simulated) / sd. Shape (episode of the set, datum).
    pub(crate) residuals: Vec<Vec<f64>>,
    /// Inverse of the reduced normal matrix of the shared parameters: nuisances, then causes.
    pub(crate) inverse: DMatrix<f64>,
    /// The slots that `inverse` belongs to.
    pub(crate) slots: Vec<ParameterIndex>,
}

struct Evaluation {
    residuals: Vec<Vec<f64>>,
    predictions: Vec<Vec<f64>>,
}

impl FitTask<'_> {
    /// Fits the model's causes and all nuisances from `start` on.
    pub(crate) fn fit(
        &self,
        model: &CauseSet,
        start: &ParameterVector,
    ) -> Result<FitResult, CalibrationError> {
        let slots = model.parameter_indices(self.experiment);
        let causes = slots.into_iter().map(ParameterIndex::Cause);
        let shared = (0..self.experiment.shared_nuisances().len()).map(ParameterIndex::Shared);
        self.run(shared.chain(causes).collect(), start)
    }

    /// Fits the episodes' own nuisances alone.
    pub(crate) fn fit_episode_nuisances(
        &self,
        start: &ParameterVector,
    ) -> Result<FitResult, CalibrationError> {
        self.run(Vec::new(), start)
    }

    /// The sum of squares at a point, without a fit.
    pub(crate) fn loss_at(&self, point: &ParameterVector) -> Result<f64, CalibrationError> {
        Ok(total(
            &self.evaluate(point)?.residuals,
            HuberLoss::QUADRATIC,
        ))
    }

    fn run(
        &self,
        global: Vec<ParameterIndex>,
        start: &ParameterVector,
    ) -> Result<FitResult, CalibrationError> {
        let mut point = start.clone();
        let mut now = self.evaluate(&point)?;
        let blocks = self.iterate(
            &global,
            &mut point,
            &mut now,
            HuberLoss::QUADRATIC,
            MOST_ITERATIONS,
        )?;
        let (mut blocks, mut loss) = (blocks, HuberLoss::QUADRATIC);
        if self.robust {
            loss = HuberLoss::from_residuals(now.residuals.iter().flatten());
            blocks = self.iterate(&global, &mut point, &mut now, loss, MOST_ROBUST_ITERATIONS)?;
        }
        Ok(FitResult {
            loss: total(&now.residuals, loss),
            data: now.residuals.iter().map(Vec::len).sum(),
            parameters: global.len(),
            inverse: normal::inverse(&normal::schur_complement(&blocks)),
            point,
            residuals: now.residuals,
            slots: global,
        })
    }

    fn iterate(
        &self,
        global: &[ParameterIndex],
        point: &mut ParameterVector,
        now: &mut Evaluation,
        loss: HuberLoss,
        most: usize,
    ) -> Result<Vec<NormalBlock>, CalibrationError> {
        let mut damping = 1e-6;
        let mut value = total(&now.residuals, loss);
        let mut blocks = self.normal_blocks(global, point, now, loss)?;
        let count = now.residuals.iter().map(Vec::len).sum::<usize>().max(1) as f64;
        for _ in 0..most {
            self.progress.check()?;
            if self.progress.deadline().is_over() {
                break;
            }
            let (before, least) = (value, TOLERANCE * value / count);
            for _ in 0..MOST_DAMPINGS {
                let step = normal::step(&blocks, damping);
                if step.predicted < least {
                    break;
                }
                let trial = self.apply_step(global, point, &step);
                // A trial that the engine refuses is too large a step.
                let there = self
                    .evaluate(&trial)
                    .ok()
                    .map(|there| (total(&there.residuals, loss), there));
                if let Some((lower, there)) = there.filter(|(lower, _)| *lower < value) {
                    (*point, *now, value) = (trial, there, lower);
                    damping = (damping * 0.1).max(1e-9);
                    break;
                }
                damping = (damping * 30.0).max(1e-4);
            }
            if before - value <= least {
                // Blocks of the point before the last, tiny, step serve as well.
                break;
            }
            blocks = self.normal_blocks(global, point, now, loss)?;
        }
        Ok(blocks)
    }

    /// The point one step on, inside the bounds.
    fn apply_step(
        &self,
        global: &[ParameterIndex],
        point: &ParameterVector,
        step: &normal::ParameterStep,
    ) -> ParameterVector {
        let mut moved = point.clone();
        let bounded = |slot: ParameterIndex, value: f64| {
            let parameter = self.experiment.parameter(slot);
            value.clamp(parameter.low, parameter.high)
        };
        for (slot, change) in global.iter().zip(step.global.iter()) {
            match *slot {
                ParameterIndex::Shared(k) => {
                    moved.shared[k] = bounded(*slot, moved.shared[k] + change);
                }
                ParameterIndex::Cause(k) => {
                    moved.causes[k] = bounded(*slot, moved.causes[k] + change);
                }
                ParameterIndex::Own(_) => {}
            }
        }
        for (episode, change) in self.set.iter().zip(&step.own) {
            for (k, change) in change.iter().enumerate() {
                let value = &mut moved.episode_nuisances[*episode][k];
                *value = bounded(ParameterIndex::Own(k), *value + change);
            }
        }
        moved
    }

    fn evaluate(&self, point: &ParameterVector) -> Result<Evaluation, CalibrationError> {
        let (experiment, set) = (self.experiment, self.set);
        let done = self.threads.map(set.len(), |k| {
            let episode = set[k];
            let measured = &experiment.episodes()[episode];
            let predictions = experiment.predict(episode, &point.values(episode))?;
            if predictions.len() != measured.measured.len()
                || predictions.iter().any(|value| !value.is_finite())
            {
                return Err(CalibrationError::simulation(
                    &measured.name,
                    "it left the world of numbers",
                ));
            }
            let residuals = measured
                .measured
                .iter()
                .zip(&predictions)
                .zip(&measured.sd)
                .map(|((y, f), sd)| (y - f) / sd)
                .collect::<Vec<f64>>();
            Ok((residuals, predictions))
        });
        let (residuals, predictions) = done
            .into_iter()
            .collect::<Result<Vec<_>, _>>()?
            .into_iter()
            .unzip();
        Ok(Evaluation {
            residuals,
            predictions,
        })
    }

    fn normal_blocks(
        &self,
        global: &[ParameterIndex],
        point: &ParameterVector,
        now: &Evaluation,
        loss: HuberLoss,
    ) -> Result<Vec<NormalBlock>, CalibrationError> {
        let own = self.experiment.episode_nuisances().len();
        let slots: Vec<ParameterIndex> = (0..own)
            .map(ParameterIndex::Own)
            .chain(global.iter().copied())
            .collect();
        let (experiment, set) = (self.experiment, self.set);
        let done = self.threads.map(set.len(), |k| {
            let episode = set[k];
            let sd = &experiment.episodes()[episode].sd;
            let base = &now.predictions[k];
            let mut jacobian =
                experiment.derivatives(episode, &point.values(episode), base, &slots)?;
            let mut residual = DVector::from_column_slice(&now.residuals[k]);
            for (row, sd) in sd.iter().enumerate() {
                let weight = loss.weight(residual[row]).sqrt();
                residual[row] *= weight;
                jacobian.row_mut(row).scale_mut(weight / sd);
            }
            Ok(NormalBlock::new(&jacobian, &residual, own))
        });
        done.into_iter().collect()
    }
}

fn total(residuals: &[Vec<f64>], loss: HuberLoss) -> f64 {
    residuals.iter().flatten().map(|r| loss.loss(*r)).sum()
}

impl FitResult {
    /// The loss of each episode of the set.
    pub(crate) fn loss_by_episode(&self, robust: Option<&Self>) -> Vec<f64> {
        let loss = match robust {
            // Both models that are compared are judged by one loss.
            Some(other) => HuberLoss::from_residuals(other.residuals.iter().flatten()),
            None => HuberLoss::QUADRATIC,
        };
        let sums = self
            .residuals
            .iter()
            .map(|episode| episode.iter().map(|r| loss.loss(*r)).sum());
        sums.collect()
    }
}
