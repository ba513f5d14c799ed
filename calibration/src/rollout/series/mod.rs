//! A series of measured episodes and several models of it: each episode is predicted by parameters that other episodes
//! chose, and what a model gains over the one that it extends comes with an interval.

mod html;
mod model;
mod score;
mod write;

pub use model::{ModelParameter, ModelledSubject, SimulationModel};
pub use score::{EpisodeDeviation, KindMedianDeviations, ModelGain};

use super::refine::sentence as told;
use super::residuals::{self, ResidualGroups};
use super::study::folds;
use super::{
    REFINEMENT_FACTOR, StepRefinementEffect, WindowOptions, WindowPrediction, WindowScore,
    predict_windows, refinements, window_scores,
};
use crate::error::CalibrationError;
use crate::fit::{Variable, least_squares, median};
use crate::progress::{CallbackProgress, ProgressReporter};
use crate::report::{FoundEffects, page};
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use serde::{Deserialize, Serialize};

/// Settings of [`run`]. Every field has a default; unknown fields are refused.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SeriesOptions {
    /// Seed of folds, nudges and draws; default 0.
    pub seed: u64,
    /// Threads; `None`: what `DWELL_THREADS`, the affinity mask or the quota say.
    pub threads: Option<usize>,
    /// Folds of the cross-validation, at least 2, default 5; where there are at most three times as many groups, each
    /// group is a fold of its own.
    pub folds: usize,
    /// Largest number of episodes in a fit; default 40.
    pub fit_episodes: usize,
    /// Largest number of iterations of a fit; default 6.
    pub iterations: usize,
    /// Stride of the starts of windows, samples; default 20.
    pub window_stride: usize,
    /// Draws of the bootstrap; default 2,000.
    pub bootstrap_draws: usize,
}

impl Default for SeriesOptions {
    fn default() -> Self {
        Self {
            seed: 0,
            threads: None,
            folds: 5,
            fit_episodes: 40,
            iterations: 6,
            window_stride: 20,
            bootstrap_draws: 2_000,
        }
    }
}

/// The outcome of a model on the series.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ModelOutcome {
    /// The model.
    pub model: SimulationModel,
    /// The parameters that each fold chose on the other folds. Shape (fold, parameter).
    pub chosen: Vec<Vec<f64>>,
    /// Every episode, out of fold.
    pub episodes: Vec<EpisodeDeviation>,
    /// Medians by kind of episode; the first row is of all.
    pub kinds: Vec<KindMedianDeviations>,
    /// The gain over the model that it extends.
    pub gain: Option<ModelGain>,
    /// Windows, each out of fold.
    pub windows: Vec<WindowScore>,
    /// The effect of a quarter of the step.
    pub refinements: Vec<StepRefinementEffect>,
}

/// The report of a series.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ModelComparisonReport {
    /// The version of this form.
    pub version: u32,
    /// The bundle's title.
    pub title: String,
    /// The licence of the data.
    pub licence: String,
    /// The options of the study.
    pub options: SeriesOptions,
    /// The result in a sentence.
    pub sentence: String,
    /// The models, as they were given.
    pub models: Vec<ModelOutcome>,
    /// Distributions of the residuals.
    pub residuals: Vec<ResidualGroups>,
    /// The residuals that are the solver's, a sentence for each model.
    pub solver: Vec<String>,
    /// The best model with the median of what its folds chose, for the simulator.
    pub found: FoundEffects,
}

/// Compares models of a subject. `progress` gets a fraction (0 to 1) and the current activity, and answers whether to go
/// on.
///
/// # Errors
/// [`CalibrationError::Field`] for options out of range, [`CalibrationError::TooFew`] for fewer than two groups,
/// [`CalibrationError::Simulation`] for what physics does not take, [`CalibrationError::Interrupted`].
///
/// # Determinism
/// Equal subject and options give the same bits for any number of threads.
pub fn run<S: ModelledSubject>(
    subject: &S,
    models: &[SimulationModel],
    options: &SeriesOptions,
    progress: &mut dyn FnMut(f32, &str) -> bool,
) -> Result<ModelComparisonReport, CalibrationError> {
    let fold_of = folds_of(subject, options)?;
    let progress = CallbackProgress::new(progress);
    let mut outcomes: Vec<ModelOutcome> = Vec::with_capacity(models.len());
    let mut windows: Vec<Vec<WindowPrediction>> = Vec::with_capacity(models.len());
    for (k, model) in models.iter().enumerate() {
        let share = [k, k + 1].map(|k| k as f32 / models.len() as f32);
        let study = ModelCrossValidation {
            subject,
            model,
            fold_of: &fold_of,
            options,
            key: RandomKey::root(options.seed)
                .child("series")
                .child(model.name),
        };
        let (mut outcome, ends) = study.run(share, &progress)?;
        let extended = model
            .extends
            .and_then(|name| outcomes.iter().find(|other| other.model.name == name));
        outcome.gain = extended.map(|other| {
            let key = study.key.child("gain");
            score::model_gain(subject, other, &outcome, options.bootstrap_draws, key)
        });
        outcomes.push(outcome);
        windows.push(ends);
    }
    progress.stage(1.0, "done")?;
    let kinds: Vec<&str> = (0..subject.count()).map(|e| subject.kind(e)).collect();
    let shown = models.iter().zip(&windows).take(page::COLOURS.len());
    let rows: Vec<residuals::ModelWindows> =
        shown.map(|(model, ends)| (model.name, &ends[..])).collect();
    let best = outcomes.iter().min_by(|a, b| {
        a.total_squared_error_mm2()
            .total_cmp(&b.total_squared_error_mm2())
    });
    Ok(ModelComparisonReport {
        version: 1,
        title: subject.title().to_owned(),
        licence: subject.licence().to_owned(),
        options: options.clone(),
        sentence: best.map_or_else(String::new, |best| score::sentence(best, &outcomes)),
        residuals: residuals::all(
            &rows,
            subject.most_informative_horizon(),
            subject.lever_arm_m() > 0.0,
            &kinds,
        ),
        solver: outcomes
            .iter()
            .map(|o| told(o.model.name, &o.refinements))
            .collect(),
        found: best.map_or_else(FoundEffects::default, |best| {
            subject.found_effects(&best.model, &best.median_parameters())
        }),
        models: outcomes,
    })
}

fn folds_of<S: ModelledSubject>(
    subject: &S,
    options: &SeriesOptions,
) -> Result<Vec<usize>, CalibrationError> {
    for (field, value, least) in [
        ("folds", options.folds, 2),
        ("fit_episodes", options.fit_episodes, 2),
        ("window_stride", options.window_stride, 1),
    ] {
        if value < least {
            let allowed = format!("at least {least}");
            return Err(CalibrationError::field(
                "series options",
                field,
                value,
                allowed,
            ));
        }
    }
    let groups: Vec<&str> = (0..subject.count()).map(|e| subject.group(e)).collect();
    let mut names = groups.clone();
    names.sort_unstable();
    names.dedup();
    if names.len() < 2 {
        return Err(CalibrationError::TooFew {
            at: subject.title().to_owned(),
            what: "groups of episodes",
            found: names.len(),
            needed: 2,
        });
    }
    let each = names.len() <= 3 * options.folds;
    let count = if each { names.len() } else { options.folds };
    Ok(folds(&groups, count, options.seed))
}

/// A model in cross-validation.
struct ModelCrossValidation<'a, S: ModelledSubject> {
    subject: &'a S,
    model: &'a SimulationModel,
    fold_of: &'a [usize],
    options: &'a SeriesOptions,
    key: RandomKey,
}

impl<S: ModelledSubject> ModelCrossValidation<'_, S> {
    fn run(
        &self,
        share: [f32; 2],
        progress: &dyn ProgressReporter,
    ) -> Result<(ModelOutcome, Vec<WindowPrediction>), CalibrationError> {
        let threads = Threads::resolve(self.options.threads);
        let count = self.fold_of.iter().max().map_or(0, |most| most + 1);
        let (mut chosen, mut rigs, mut fine) = (Vec::new(), Vec::new(), Vec::new());
        for fold in 0..count {
            let done = share[0] + 0.7 * (share[1] - share[0]) * fold as f32 / count as f32;
            progress.stage(done, &format!("{}: fold {}", self.model.name, fold + 1))?;
            let values = self.fitted(fold, threads, progress)?;
            rigs.push(self.subject.simulation(self.model, &values, 1)?);
            fine.push(
                self.subject
                    .simulation(self.model, &values, REFINEMENT_FACTOR)?,
            );
            chosen.push(values);
        }
        progress.stage(
            share[0] + 0.7 * (share[1] - share[0]),
            &format!("{}: windows", self.model.name),
        )?;
        let own: Vec<&S::Rig> = self.fold_of.iter().map(|fold| &rigs[*fold]).collect();
        let finer: Vec<&S::Rig> = self.fold_of.iter().map(|fold| &fine[*fold]).collect();
        let one = |episode: usize| {
            score::episode_error(self.subject, own[episode], episode, self.fold_of[episode])
        };
        let found = threads.map(self.subject.count(), one);
        let episodes = found.into_iter().collect::<Result<Vec<_>, _>>()?;
        let windowing = WindowOptions {
            stride: self.options.window_stride,
            chaos_guard: Some(self.key.child("windows")),
            threads,
        };
        let found = predict_windows(self.subject, &own, &windowing)?;
        progress.check()?;
        let unguarded = WindowOptions {
            chaos_guard: None,
            ..windowing
        };
        let refined = refinements(&found, &predict_windows(self.subject, &finer, &unguarded)?);
        let outcome = ModelOutcome {
            model: self.model.clone(),
            chosen,
            kinds: score::by_kind(&episodes),
            episodes,
            gain: None,
            windows: window_scores(&found),
            refinements: refined,
        };
        Ok((outcome, found))
    }

    /// Returns the parameters that the other folds choose.
    fn fitted(
        &self,
        fold: usize,
        threads: Threads,
        progress: &dyn ProgressReporter,
    ) -> Result<Vec<f64>, CalibrationError> {
        if self.model.parameters.is_empty() {
            return Ok(Vec::new());
        }
        let mut train: Vec<usize> = (0..self.fold_of.len())
            .filter(|episode| self.fold_of[*episode] != fold)
            .collect();
        // All models use the same episodes.
        let key = RandomKey::root(self.options.seed)
            .child("part")
            .child(fold as u64);
        key.stream().shuffle(&mut train);
        train.truncate(self.options.fit_episodes);
        train.sort_unstable();
        let variables: Vec<Variable> = self
            .model
            .parameters
            .iter()
            .map(|parameter| Variable {
                start: parameter.start,
                low: parameter.range[0],
                high: parameter.range[1],
                step: parameter.step,
            })
            .collect();
        least_squares(&variables, self.options.iterations, |values| {
            progress.check()?;
            let rig = self.subject.simulation(self.model, values, 1)?;
            let one = |k: usize| score::residuals(self.subject, &rig, train[k]);
            let found: Result<Vec<Vec<f64>>, _> =
                threads.map(train.len(), one).into_iter().collect();
            Ok(found?.concat())
        })
    }
}

impl ModelOutcome {
    /// The median of what the folds chose, by parameter.
    pub fn median_parameters(&self) -> Vec<f64> {
        (0..self.model.parameters.len())
            .map(|k| median(&mut self.chosen.iter().map(|v| v[k]).collect::<Vec<f64>>()))
            .collect()
    }

    fn total_squared_error_mm2(&self) -> f64 {
        self.episodes.iter().map(|e| e.square_mm2).sum()
    }
}
