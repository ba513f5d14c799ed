//! Comparison of a model with the model without one cause.

use super::gain::{HeldOutGain, gain};
use super::residual::effective_count;
use super::split::EpisodeSplit;
use crate::error::CalibrationError;
use crate::experiment::{
    Experiment, ParameterIndex, ParameterVector, ResidualStructure, parameter_range,
};
use crate::fit::{CauseSet, FitResult, FitTask};
use crate::options::CalibrationOptions;
use crate::progress::ProgressReporter;
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;

/// Standard deviations from its default within which the data do not move a parameter.
const MOVED_SD: f64 = 3.0;

/// The inputs that all comparisons share.
pub(crate) struct CauseComparer<'a> {
    pub(crate) experiment: &'a dyn Experiment,
    pub(crate) split: &'a EpisodeSplit,
    pub(crate) options: &'a CalibrationOptions,
    pub(crate) threads: Threads,
    pub(crate) progress: &'a dyn ProgressReporter,
}

/// A model, fitted where fitting is allowed and judged where it is not.
#[derive(Clone, Debug)]
pub(crate) struct ScoredModel {
    pub(crate) model: CauseSet,
    pub(crate) fit: FitResult,
    /// The held-out episodes with only their own nuisances fitted.
    pub(crate) held_out: FitResult,
    /// Independent numbers among those fitted.
    pub(crate) effective_count: f64,
}

impl ScoredModel {
    /// Independent residuals per residual.
    pub(crate) fn effective_sample_ratio(&self) -> f64 {
        self.effective_count / self.fit.data.max(1) as f64
    }
}

/// A model against a smaller one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ModelAdvantage {
    /// Fall of the information criterion.
    pub(crate) delta_bic: f64,
    pub(crate) gain: HeldOutGain,
}

/// A value with the 95 % interval of its fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Estimate {
    pub(crate) value: f64,
    pub(crate) sd: f64,
}

impl Estimate {
    pub(crate) fn interval(&self) -> [f64; 2] {
        [self.value - 1.96 * self.sd, self.value + 1.96 * self.sd]
    }
}

impl CauseComparer<'_> {
    fn task<'b>(&'b self, set: &'b [usize], robust: bool) -> FitTask<'b> {
        FitTask {
            experiment: self.experiment,
            set,
            threads: self.threads,
            // Levels of a response have no outliers, and each fit of a room costs much.
            robust: robust
                && self.options.robust
                && self.experiment.residual_structure() == ResidualStructure::OverTime,
            progress: self.progress,
        }
    }

    /// Fits a model on some of the episodes.
    pub(crate) fn fit_on(
        &self,
        set: &[usize],
        model: &CauseSet,
        from: &ParameterVector,
    ) -> Result<FitResult, CalibrationError> {
        self.task(set, true).fit(model, from)
    }

    /// Fits a model and judges it on the held-out episodes. Of several starts the best is taken.
    pub(crate) fn fit_and_score(
        &self,
        model: &CauseSet,
        from: &ParameterVector,
    ) -> Result<ScoredModel, CalibrationError> {
        let train = self.task(&self.split.train, true);
        let mut start = from.clone();
        if let Some(cause) = model.causes.last() {
            let range = parameter_range(self.experiment, *cause);
            let mut best = train.loss_at(from)?;
            for probe in &self.experiment.causes()[*cause].probes {
                let mut there = from.clone();
                there.causes[range.clone()].copy_from_slice(probe);
                let loss = train.loss_at(&there).unwrap_or(f64::INFINITY);
                if loss < best {
                    (best, start) = (loss, there);
                }
            }
        }
        let (model, fit) = self.without_idle_parameters(model, train.fit(model, &start)?)?;
        let held_out = self
            .task(&self.split.held_out, false)
            .fit_episode_nuisances(&fit.point)?;
        let effective_count = effective_count(self.experiment, &self.split.train, &fit.residuals);
        Ok(ScoredModel {
            model,
            fit,
            held_out,
            effective_count,
        })
    }

    /// Holds those parameters of the last cause at their default that the data do not move, one after the other: a law with
    /// several parts often acts by one.
    fn without_idle_parameters(
        &self,
        model: &CauseSet,
        fit: FitResult,
    ) -> Result<(CauseSet, FitResult), CalibrationError> {
        let (mut model, mut fit) = (model.clone(), fit);
        let Some(cause) = model.causes.last().copied() else {
            return Ok((model, fit));
        };
        // Each band of a surface has its own absorption, and a fit of a room costs much.
        if self.experiment.residual_structure() != ResidualStructure::OverTime {
            return Ok((model, fit));
        }
        let train = self.task(&self.split.train, true);
        let range = parameter_range(self.experiment, cause);
        let parameters = &self.experiment.causes()[cause].parameters;
        loop {
            let free: Vec<usize> = range
                .clone()
                .filter(|slot| !model.held.contains(slot))
                .collect();
            let count = effective_count(self.experiment, &self.split.train, &fit.residuals);
            let distance = |slot: usize| {
                let sd = parameter_sd(&fit, count, ParameterIndex::Cause(slot));
                let moved = fit.point.causes[slot] - parameters[slot - range.start].default;
                if sd > 0.0 { moved.abs() / sd } else { 0.0 }
            };
            let weakest = free
                .iter()
                .copied()
                .min_by(|a, b| distance(*a).total_cmp(&distance(*b)));
            let is_over = self.progress.deadline().is_over();
            let Some(weakest) =
                weakest.filter(|slot| !is_over && free.len() > 1 && distance(*slot) < MOVED_SD)
            else {
                return Ok((model, fit));
            };
            let mut smaller = model.clone();
            smaller.held.push(weakest);
            let mut start = fit.point.clone();
            start.causes[weakest] = parameters[weakest - range.start].default;
            let tried = train.fit(&smaller, &start)?;
            let loss = fit.loss.max(f64::MIN_POSITIVE);
            let worth = count / fit.data.max(1) as f64;
            let rise = worth * fit.data as f64 * (tried.loss.max(f64::MIN_POSITIVE) / loss).ln();
            if rise > count.max(2.0).ln() {
                return Ok((model, fit));
            }
            (model, fit) = (smaller, tried);
        }
    }

    /// Returns the advantage of `larger` over `smaller`. `effective_weight`: independent residuals per residual, the same for all models
    /// that are compared: a wrong model's residuals are correlated because it is wrong.
    ///
    /// # Source
    /// G. Schwarz, Ann. Stat. 6, 461 (1978), with a noise scale that is fitted and the effective count of data.
    pub(crate) fn advantage_over(
        &self,
        larger: &ScoredModel,
        smaller: &ScoredModel,
        worth: f64,
    ) -> ModelAdvantage {
        let n = (worth * larger.fit.data as f64).max(2.0);
        let more = larger.fit.parameters as f64 - smaller.fit.parameters as f64;
        let ratio =
            smaller.fit.loss.max(f64::MIN_POSITIVE) / larger.fit.loss.max(f64::MIN_POSITIVE);
        let robust = self.options.robust.then_some(&larger.held_out);
        let key = RandomKey::root(self.options.seed).child("gain");
        ModelAdvantage {
            delta_bic: n * ratio.ln() - more * n.ln(),
            gain: gain(
                &smaller.held_out.loss_by_episode(robust),
                &larger.held_out.loss_by_episode(robust),
                larger.fit.loss / larger.fit.data.max(1) as f64,
                worth,
                self.options.bootstrap_draws,
                key,
            ),
        }
    }

    /// Returns whether a comparison speaks for the larger model.
    pub(crate) fn is_better(&self, against: &ModelAdvantage) -> bool {
        against.delta_bic > self.options.min_delta_bic
            && against.gain.log_density_interval[0] > 0.0
            && against.gain.share >= self.options.min_gain_share
    }
}

/// The estimates of a cause's parameters.
pub(crate) fn estimates(
    experiment: &dyn Experiment,
    fit: &FitResult,
    effective_count: f64,
    cause: usize,
) -> Vec<Estimate> {
    let range = parameter_range(experiment, cause);
    range
        .map(|slot| Estimate {
            value: fit.point.causes[slot],
            sd: parameter_sd(fit, effective_count, ParameterIndex::Cause(slot)),
        })
        .collect()
}

/// The standard deviation of a fitted parameter.
pub(crate) fn parameter_sd(fit: &FitResult, effective_count: f64, slot: ParameterIndex) -> f64 {
    let Some(k) = fit.slots.iter().position(|other| *other == slot) else {
        return 0.0;
    };
    let variance = fit.loss / (effective_count - fit.parameters as f64).max(1.0);
    (variance * fit.inverse[(k, k)].max(0.0)).sqrt()
}
