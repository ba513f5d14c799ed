//! The study of a bundle of tosses: contact parameters by cross-validation, so that every episode is scored by parameters
//! that it did not choose.

mod folds;
mod html;
mod model;
mod other_simulator;
mod search;
mod search_cache;
mod write;

pub use model::{ContactModel, ContactParameter, further_models, standard_models as models};
pub use other_simulator::{PeerScores, SimulatorComparison, SimulatorScoreDifference};

use super::refine::sentence as told;
use super::residuals::{self, ResidualGroups};
use super::{
    BoardRig, MeanDeviation, PoseTracks, REFINEMENT_FACTOR, ScoreSummary, StepRefinementEffect,
    TrackerNoise, WindowOptions, WindowPrediction, WindowScore, diverges_under_noise,
    predict_windows, scores, step_refinement_effects, window_scores,
};
use crate::error::CalibrationError;
use crate::progress::{CallbackProgress, ProgressReporter};
use crate::report::{FoundEffects, page};
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// The horizon that pictures show, samples.
const SHOWN_HORIZON: usize = 10;

/// Settings of [`run`]. Every field has a default; unknown fields are refused.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct StudyOptions {
    /// Seed of folds, searches and draws; default 0.
    pub seed: u64,
    /// Threads; `None`: what `DWELL_THREADS`, the affinity mask or the quota say.
    pub threads: Option<usize>,
    /// Folds of the cross-validation, at least 2; default 5.
    pub folds: usize,
    /// Points of a generation of the search, at least 4; default 6.
    pub population: usize,
    /// Generations on a part of the training episodes, then on all of them; default 6 and 0.
    pub generations: [usize; 2],
    /// Number of episodes of that part; default 60.
    pub first_episodes: usize,
    /// Stride of the starts of windows, samples; default 20.
    pub window_stride: usize,
    /// Draws of the bootstrap; default 2,000.
    pub bootstrap_draws: usize,
    /// A folder in which ended searches are kept, so that the same study need not search again; `None`: nothing is kept.
    #[serde(skip_serializing)]
    pub cache_folder: Option<PathBuf>,
}

impl Default for StudyOptions {
    fn default() -> Self {
        Self {
            seed: 0,
            threads: None,
            folds: 5,
            population: 6,
            generations: [6, 0],
            first_episodes: 60,
            window_stride: 20,
            bootstrap_draws: 2_000,
            cache_folder: None,
        }
    }
}

/// One episode's score by parameters that it did not choose.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EpisodeScore {
    /// Its name.
    pub episode: String,
    /// The fold that it was held out with.
    pub fold: usize,
    /// The score.
    pub score: MeanDeviation,
    /// True if starts within the tracker's noise end elsewhere.
    pub diverges: bool,
}

/// The outcome of a contact model on the bundle.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ModelReport {
    /// The model.
    pub model: ContactModel,
    /// The parameters that each fold chose on the other folds. Shape (fold, parameter).
    pub chosen: Vec<Vec<f64>>,
    /// All episodes, each out of fold.
    pub summary: ScoreSummary,
    /// Those that do not diverge.
    pub steady: ScoreSummary,
    /// Windows, each out of fold.
    pub windows: Vec<WindowScore>,
    /// The effect of a quarter of the step.
    pub refinements: Vec<StepRefinementEffect>,
    /// Every episode.
    pub episodes: Vec<EpisodeScore>,
    /// The comparison with the peers, episode by episode.
    pub against: Vec<SimulatorComparison>,
}

/// The report of a study.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StudyReport {
    /// The version of this form.
    pub version: u32,
    /// The bundle's title.
    pub title: String,
    /// The licence of the data.
    pub licence: String,
    /// The options of the study.
    pub options: StudyOptions,
    /// The tracker's noise from sample to sample.
    pub noise: TrackerNoise,
    /// The result in a sentence.
    pub sentence: String,
    /// The residuals that are the solver's, a sentence for each model.
    pub solver: Vec<String>,
    /// The models, in the order of [`models`].
    pub models: Vec<ModelReport>,
    /// Distributions of the first models' residuals.
    pub residuals: Vec<ResidualGroups>,
    /// The best model with the median of what its folds chose, for the simulator.
    pub found: FoundEffects,
}

/// Studies the tracks. `progress` gets a fraction (0 to 1) and the current activity, and answers whether to go on.
///
/// # Errors
/// [`CalibrationError::Field`] for options out of range, [`CalibrationError::TooFew`] for fewer episodes than twice the
/// folds, [`CalibrationError::Simulation`] for what physics does not take, [`CalibrationError::Interrupted`].
///
/// # Determinism
/// Equal tracks and options give the same bits for any number of threads.
pub fn run(
    tracks: &PoseTracks,
    models: &[ContactModel],
    peers: &[PeerScores],
    options: &StudyOptions,
    progress: &mut dyn FnMut(f32, &str) -> bool,
) -> Result<StudyReport, CalibrationError> {
    check(tracks, options)?;
    let progress = CallbackProgress::new(progress);
    let groups: Vec<&str> = tracks.episodes.iter().map(|e| e.group.as_str()).collect();
    let fold_of = folds::folds(&groups, options.folds, options.seed);
    let mut reports = Vec::with_capacity(models.len());
    let mut windows: Vec<Vec<WindowPrediction>> = Vec::with_capacity(models.len());
    for (k, model) in models.iter().enumerate() {
        let share = [k, k + 1].map(|k| k as f32 / models.len() as f32);
        let (report, ends) =
            study_model(tracks, model, peers, &fold_of, options, share, &progress)?;
        let told = format!("{}: {}", model.name, errors(&report));
        progress.stage(share[1], &told)?;
        reports.push(report);
        windows.push(ends);
    }
    let shown = models.iter().zip(&windows).take(page::COLOURS.len());
    let rows: Vec<residuals::ModelWindows> =
        shown.map(|(model, ends)| (model.name, &ends[..])).collect();
    progress.stage(1.0, "done")?;
    let best = reports
        .iter()
        .min_by(|a, b| a.summary.e_q.median.total_cmp(&b.summary.e_q.median));
    Ok(StudyReport {
        version: 2,
        title: tracks.title.clone(),
        licence: tracks.licence.clone(),
        options: options.clone(),
        noise: tracks.noise,
        solver: reports
            .iter()
            .map(|r| told(r.model.name, &r.refinements))
            .collect(),
        residuals: residuals::all(&rows, SHOWN_HORIZON),
        sentence: best.map_or_else(String::new, |best| sentence(best, &reports)),
        found: best.map_or_else(FoundEffects::default, |best| found_effects(tracks, best)),
        models: reports,
    })
}

fn check(tracks: &PoseTracks, options: &StudyOptions) -> Result<(), CalibrationError> {
    let least = |field: &str, value: usize, least: usize| {
        if value >= least {
            return Ok(());
        }
        let allowed = format!("at least {least}");
        Err(CalibrationError::field(
            "study options",
            field,
            value,
            allowed,
        ))
    };
    least("folds", options.folds, 2)?;
    least("population", options.population, 4)?;
    least("window_stride", options.window_stride, 1)?;
    let (found, needed) = (tracks.episodes.len(), 2 * options.folds);
    if found < needed {
        return Err(CalibrationError::TooFew {
            at: tracks.title.clone(),
            what: "episodes",
            found,
            needed,
        });
    }
    Ok(())
}

fn study_model(
    tracks: &PoseTracks,
    model: &ContactModel,
    peers: &[PeerScores],
    fold_of: &[usize],
    options: &StudyOptions,
    share: [f32; 2],
    progress: &dyn ProgressReporter,
) -> Result<(ModelReport, Vec<WindowPrediction>), CalibrationError> {
    let threads = Threads::resolve(options.threads);
    let key = RandomKey::root(options.seed)
        .child("study")
        .child(model.name);
    let plain = BoardRig::new(tracks, model.contact_friction)?;
    let plain_fine = BoardRig::with_finer_steps(tracks, model.contact_friction, REFINEMENT_FACTOR)?;
    let (mut chosen, mut rigs, mut fine) = (Vec::new(), Vec::new(), Vec::new());
    for fold in 0..options.folds {
        let done = share[0] + (share[1] - share[0]) * fold as f32 / options.folds as f32;
        progress.stage(done, &format!("{}: fold {}", model.name, fold + 1))?;
        let train: Vec<usize> = (0..fold_of.len()).filter(|k| fold_of[*k] != fold).collect();
        let values = if model.parameters.is_empty() {
            Vec::new()
        } else {
            let key = key.child(fold as u64);
            let what = (tracks, model, fold);
            search_cache::cached_or_search(options.cache_folder.as_deref(), what, options, || {
                search::search(model, &plain, tracks, &train, options, key, progress)
            })?
        };
        let settings = model.settings(&values, &tracks.board);
        rigs.push(plain.with_settings(&settings)?);
        fine.push(plain_fine.with_settings(&settings)?);
        chosen.push(values);
    }
    let all: Vec<usize> = (0..fold_of.len()).collect();
    let mut by_episode = vec![(MeanDeviation::default(), false); fold_of.len()];
    for (fold, rig) in rigs.iter().enumerate() {
        let held: Vec<usize> = all
            .iter()
            .copied()
            .filter(|k| fold_of[*k] == fold)
            .collect();
        progress.check()?;
        let scores = scores(rig, tracks, &held, threads)?;
        let chance = diverges_under_noise(rig, tracks, &held, key.child("episodes"), threads)?;
        for ((k, score), diverges) in held.iter().zip(scores).zip(chance) {
            by_episode[*k] = (score, diverges);
        }
    }
    progress.check()?;
    let own: Vec<&BoardRig> = fold_of.iter().map(|fold| &rigs[*fold]).collect();
    let finer: Vec<&BoardRig> = fold_of.iter().map(|fold| &fine[*fold]).collect();
    let windowing = WindowOptions {
        stride: options.window_stride,
        chaos_guard: Some(key.child("windows")),
        threads,
    };
    let found = predict_windows(tracks, &own, &windowing)?;
    progress.check()?;
    let unguarded = WindowOptions {
        chaos_guard: None,
        ..windowing
    };
    let refined = step_refinement_effects(&found, &predict_windows(tracks, &finer, &unguarded)?);
    let every: Vec<MeanDeviation> = by_episode.iter().map(|(score, _)| *score).collect();
    let steady = by_episode.iter().filter(|(_, diverges)| !diverges);
    let steady: Vec<MeanDeviation> = steady.map(|(score, _)| *score).collect();
    let against: Result<Vec<SimulatorComparison>, _> = peers
        .iter()
        .map(|peer| {
            let key = key.child("peer").child(peer.name.as_str());
            other_simulator::compare(tracks, &every, peer, options.bootstrap_draws, key)
        })
        .collect();
    let report = ModelReport {
        model: model.clone(),
        chosen,
        summary: ScoreSummary::of(&every),
        steady: ScoreSummary::of(&steady),
        windows: window_scores(&found),
        refinements: refined,
        episodes: all
            .iter()
            .map(|k| EpisodeScore {
                episode: tracks.episodes[*k].name.clone(),
                fold: fold_of[*k],
                score: by_episode[*k].0,
                diverges: by_episode[*k].1,
            })
            .collect(),
        against: against?,
    };
    Ok((report, found))
}

impl ModelReport {
    /// The median of what the folds chose, by parameter.
    pub fn median_parameters(&self) -> Vec<f64> {
        (0..self.model.parameters.len())
            .map(|k| {
                let mut column: Vec<f64> = self.chosen.iter().map(|values| values[k]).collect();
                crate::median::median(&mut column)
            })
            .collect()
    }
}

fn errors(report: &ModelReport) -> String {
    format!(
        "{:.3} widths and {:.2} degrees",
        report.summary.position_widths.median, report.summary.rotation_deg.median
    )
}

fn sentence(best: &ModelReport, all: &[ModelReport]) -> String {
    let mut text = format!(
        "Over {} episodes, each scored by parameters that it did not choose, the model \"{}\" is off by {} in the median",
        best.summary.count,
        best.model.name,
        errors(best)
    );
    if let Some(nominal) = all.iter().find(|report| report.model.parameters.is_empty()) {
        text = format!("{text}; the nominal values are off by {}", errors(nominal));
    }
    text + "."
}

fn found_effects(tracks: &PoseTracks, best: &ModelReport) -> FoundEffects {
    let settings = best
        .model
        .settings(&best.median_parameters(), &tracks.board);
    FoundEffects {
        laws: settings.laws,
        parameters: [
            (tracks.board.pair_address("friction"), settings.friction),
            (
                tracks.board.pair_address("restitution"),
                settings.restitution,
            ),
        ]
        .into_iter()
        .collect(),
        ..FoundEffects::default()
    }
}
