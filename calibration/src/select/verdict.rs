//! From fits to a verdict.

mod extension;

use super::agreement::{RegimeAgreement, agreement};
use super::compare::{CauseComparer, Estimate, ModelAdvantage, ScoredModel, estimates};
use super::gain::HeldOutGain;
use super::learnable::LearnableResidual;
use super::plausibility::implausibility_reason;
use super::quantum::rounding_sd;
use super::reasons::{
    disagreement_reason, names, rejection_reason, structure_reason, unfinished_reason,
};
use super::residual::{ResidualNoiseTest, noise_from_differences};
use super::screen::{LinearGain, LinearScreening};
use super::spectrum::slow_residual;
use super::split::EpisodeSplit;
use crate::error::CalibrationError;
use crate::experiment::{Experiment, ParameterVector, ResidualStructure};
use crate::fit::CauseSet;
use crate::options::CalibrationOptions;
use crate::progress::ProgressReporter;
use dwell_scene::parallel::Threads;
use dwell_scene::random::RandomKey;

/// Causes that are fitted in full at each stage: those that gain most to first order.
const MOST_FITTED: usize = 6;
/// Share of the best cause's gain to first order below which no cause is fitted in full.
const LEAST_SHARE: f64 = 0.25;
/// Share of the gain by chance below which, where nothing systematic is left, no cause is fitted in full.
const CLEARLY_CHANCE: f64 = 0.5;

/// Share of the fall of the criterion by which a cause may be behind an equivalent one and still be a rival of it: what makes
/// the difference is less well modelled than what they have in common.
const EQUIVALENT_SHARE: f64 = 0.25;

/// All findings, before they are put into words.
pub(crate) struct Findings {
    pub(crate) split: EpisodeSplit,
    /// Nuisances alone.
    pub(crate) base: ScoredModel,
    /// Each cause alone, in the order of the experiment's causes.
    pub(crate) singles: Vec<SingleCause>,
    /// The model that is reported: nuisances alone, or with causes.
    pub(crate) chosen: ScoredModel,
    /// `chosen` against nuisances alone.
    pub(crate) advantage_over_base: Option<ModelAdvantage>,
    pub(crate) remainder_before: ResidualNoiseTest,
    pub(crate) remainder_after: ResidualNoiseTest,
    pub(crate) agreement: Option<RegimeAgreement>,
    pub(crate) decision: Decision,
    /// False where the search was ended early.
    pub(crate) is_finished: bool,
}

/// A cause alone.
pub(crate) struct SingleCause {
    pub(crate) cause: usize,
    /// Its parameters: fitted, or to first order.
    pub(crate) estimates: Vec<Estimate>,
    /// Fall of the information criterion, to first order where it was not fitted.
    pub(crate) delta_bic: f64,
    /// `None` where it was not fitted.
    pub(crate) gain: Option<HeldOutGain>,
    pub(crate) passes: bool,
    /// The reason why it is not plausible, if it is not.
    pub(crate) implausible: Option<String>,
    /// True if nothing in the data depends on it.
    pub(crate) is_idle: bool,
}

/// The verdict, by positions of causes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Decision {
    NoEffect,
    Named(Vec<usize>),
    /// Sets of causes that explain the data alike.
    OneOf(Vec<Vec<usize>>),
    Unexplained(String),
}

/// A model that is tried, against the one that it extends.
struct Trial {
    scored: ScoredModel,
    advantage: ModelAdvantage,
    passes: bool,
    implausible: Option<String>,
}

/// Finds what the simulation lacks.
pub(crate) fn find_causes(
    experiment: &mut dyn Experiment,
    options: &CalibrationOptions,
    progress: &dyn ProgressReporter,
) -> Result<Findings, CalibrationError> {
    let split = EpisodeSplit::new(experiment.episodes(), options.held_out_share, options.seed);
    let threads = Threads::resolve(options.threads);
    progress.stage(0.1, "fitting starts, offsets and noise")?;
    let start = estimate_noise(experiment, &split, options, threads, progress)?;
    let all = CauseComparer {
        experiment,
        split: &split,
        options,
        threads,
        progress,
    };
    let base = all.fit_and_score(&CauseSet::default(), &start)?;
    let search = Search { all: &all };
    let remainder_before = search.remainder(&base)?;
    let (singles, trials) = search.singles(&base, &remainder_before)?;
    let chosen = match best_trial(&trials) {
        Some(first) => search.extend(first.clone(), &base)?,
        None => base.clone(),
    };
    progress.stage(0.8, "comparing explanations")?;
    let remainder_after = search.remainder(&chosen)?;
    let mut found_agreement = None;
    let is_over = || progress.deadline().is_over();
    let decision = if is_over() {
        Decision::Unexplained(unfinished_reason(&all, &singles))
    } else if chosen.model.causes.is_empty() {
        if remainder_before.is_structured() {
            Decision::Unexplained(rejection_reason(&all, &singles))
        } else {
            Decision::NoEffect
        }
    } else if remainder_after.is_structured() {
        Decision::Unexplained(structure_reason(
            &all,
            &chosen,
            &remainder_before,
            &remainder_after,
        ))
    } else {
        let decision = search.alternatives(&chosen, &base, &trials)?;
        if let Decision::Named(causes) = &decision {
            progress.stage(0.9, "checking that each cause has one size everywhere")?;
            let mut refuted = None;
            for cause in causes {
                let found = agreement(&all, &chosen, *cause)?;
                if let Some(found) = &found
                    && found.is_refuting()
                {
                    refuted.get_or_insert_with(|| (*cause, found.clone()));
                }
                found_agreement = found_agreement.or(found);
            }
            match refuted {
                Some((cause, found)) => {
                    let reason = disagreement_reason(&all, cause, &found);
                    found_agreement = Some(found);
                    Decision::Unexplained(reason)
                }
                None => decision,
            }
        } else {
            decision
        }
    };
    // What came last may have been cut short.
    let decision = match decision {
        Decision::Unexplained(reason) => Decision::Unexplained(reason),
        _ if is_over() => Decision::Unexplained(unfinished_reason(&all, &singles)),
        decision => decision,
    };
    let advantage_over_base = (!chosen.model.causes.is_empty())
        .then(|| all.advantage_over(&chosen, &base, chosen.effective_sample_ratio()));
    Ok(Findings {
        base,
        singles,
        chosen,
        advantage_over_base,
        remainder_before,
        remainder_after,
        agreement: found_agreement,
        is_finished: !is_over(),
        decision,
        split,
    })
}

/// The search for effects: one, then one more as long as something systematic is left.
struct Search<'a> {
    all: &'a CauseComparer<'a>,
}

impl Search<'_> {
    /// The test of what a model leaves.
    fn remainder(&self, scored: &ScoredModel) -> Result<ResidualNoiseTest, CalibrationError> {
        let (all, split) = (self.all, self.all.split);
        let found = ResidualNoiseTest::of(all.experiment, &split.train, &scored.fit.residuals);
        if all.experiment.residual_structure() != ResidualStructure::OverTime {
            let own = all.experiment.structure(&split.train, &scored.fit.point)?;
            return Ok(match own {
                // That which is further beyond its threshold is reported.
                Some(own) if own.ratio * found.threshold > found.ratio * own.threshold => {
                    ResidualNoiseTest {
                        learnable: None,
                        slow: None,
                        ratio: own.ratio,
                        threshold: own.threshold,
                    }
                }
                _ => found,
            });
        }
        let learnable = LearnableResidual::new(
            all.experiment,
            (&split.train, &scored.fit),
            (&split.held_out, &scored.held_out),
            all.threads,
            RandomKey::root(all.options.seed).child("learner"),
        )?;
        let fits = [
            (&split.train[..], &scored.fit),
            (&split.held_out[..], &scored.held_out),
        ];
        let slow = slow_residual(all.experiment, &fits, all.threads)?;
        // An autoregression describes what is left: its neighbours do not tell how large it is.
        let ratio = if slow.is_noise() {
            found.ratio.min(1.0)
        } else {
            found.ratio
        };
        Ok(ResidualNoiseTest {
            learnable,
            slow: Some(slow),
            ratio,
            ..found
        })
    }

    /// The causes that are worth a full fit beside a model, the most promising first, with what each gains to first order,
    /// and the gain that chance would give the best.
    fn shortlist(
        &self,
        now: &ScoredModel,
    ) -> Result<(Vec<LinearGain>, Vec<usize>, f64), CalibrationError> {
        let causes = 0..self.all.experiment.causes().len();
        let which: Vec<usize> = causes.filter(|k| !now.model.causes.contains(k)).collect();
        let screen = LinearScreening::new(self.all, &now.fit, &which)?;
        let gains = screen.gains(self.all.experiment);
        let key = RandomKey::root(self.all.options.seed).child("screen");
        let by_chance = screen.gain_by_chance(key);
        let best = gains.iter().map(|gain| gain.gain).fold(0.0, f64::max);
        let mut order: Vec<&LinearGain> = gains
            .iter()
            .filter(|gain| !gain.is_idle && gain.gain >= LEAST_SHARE * best && gain.gain > 0.0)
            .collect();
        order.sort_by(|a, b| b.gain.total_cmp(&a.gain).then(a.cause.cmp(&b.cause)));
        let short = order
            .iter()
            .take(MOST_FITTED)
            .map(|gain| gain.cause)
            .collect();
        Ok((gains, short, by_chance))
    }

    /// Fits these causes, with what a model holds of them held.
    fn fit(
        &self,
        causes: Vec<usize>,
        like: &CauseSet,
        from: &ParameterVector,
    ) -> Result<ScoredModel, CalibrationError> {
        let held = like.held.clone();
        self.all.fit_and_score(&CauseSet { causes, held }, from)
    }

    /// Fits each of the causes beside a model and judges it against that model.
    fn trials(
        &self,
        now: &ScoredModel,
        short: &[usize],
        by_chance: f64,
    ) -> Result<Vec<Trial>, CalibrationError> {
        let mut fitted = Vec::new();
        for (k, cause) in short.iter().enumerate() {
            if self.all.progress.deadline().is_over() {
                break;
            }
            let fraction = 0.2 + 0.5 * k as f32 / short.len() as f32;
            let name = &self.all.experiment.causes()[*cause].name;
            self.all
                .progress
                .stage(fraction, &format!("trying {name}"))?;
            let mut model = now.model.clone();
            model.causes.push(*cause);
            match self.all.fit_and_score(&model, &now.fit.point) {
                Ok(scored) => fitted.push(scored),
                Err(CalibrationError::Interrupted) => return Err(CalibrationError::Interrupted),
                // The engine refuses some of its values, such as a centre of mass outside of a body: it is none of those.
                Err(error) => tracing::info!("{name} is left out: {error}"),
            }
        }
        let best = fitted
            .iter()
            .min_by(|a, b| a.fit.loss.total_cmp(&b.fit.loss));
        let worth = best.map_or(1.0, ScoredModel::effective_sample_ratio);
        Ok(fitted
            .into_iter()
            .map(|scored| {
                let advantage = self.all.advantage_over(&scored, now, worth);
                let fall = now.fit.loss - scored.fit.loss;
                Trial {
                    passes: self.all.is_better(&advantage) && fall > by_chance,
                    implausible: self.implausible(&scored),
                    scored,
                    advantage,
                }
            })
            .collect())
    }

    fn implausible(&self, scored: &ScoredModel) -> Option<String> {
        let causes = scored.model.causes.iter();
        causes
            .clone()
            .find_map(|cause| implausibility_reason(self.all.experiment, scored, *cause))
    }

    /// Every cause alone, and the fits of those that gain most.
    fn singles(
        &self,
        base: &ScoredModel,
        remainder: &ResidualNoiseTest,
    ) -> Result<(Vec<SingleCause>, Vec<Trial>), CalibrationError> {
        self.all
            .progress
            .stage(0.15, "looking through the library")?;
        let (gains, mut short, by_chance) = self.shortlist(base)?;
        let best = gains.iter().map(|gain| gain.gain).fold(0.0, f64::max);
        if !remainder.is_structured() && best < CLEARLY_CHANCE * by_chance {
            short.clear();
        }
        let trials = self.trials(base, &short, by_chance)?;
        let mean_square = base.fit.loss / base.effective_count.max(1.0);
        let count = base.effective_count.max(2.0);
        let mut singles: Vec<SingleCause> = gains
            .iter()
            .map(|linear| {
                let left = (base.fit.loss - linear.gain).max(f64::MIN_POSITIVE);
                let parameters = linear.changes.len() as f64;
                SingleCause {
                    cause: linear.cause,
                    estimates: linear.estimates(self.all.experiment, &base.fit.point, mean_square),
                    delta_bic: count * (base.fit.loss / left).ln() - parameters * count.ln(),
                    gain: None,
                    passes: false,
                    implausible: None,
                    is_idle: linear.is_idle,
                }
            })
            .collect();
        for trial in &trials {
            let cause = trial.scored.model.causes[0];
            if let Some(single) = singles.iter_mut().find(|single| single.cause == cause) {
                let (fit, worth) = (&trial.scored.fit, trial.scored.effective_count);
                single.estimates = estimates(self.all.experiment, fit, worth, cause);
                single.delta_bic = trial.advantage.delta_bic;
                single.gain = Some(trial.advantage.gain);
                single.passes = trial.passes;
                single.implausible.clone_from(&trial.implausible);
            }
        }
        Ok((singles, trials))
    }

    /// The model without those causes that the others make needless.
    fn without_idle(&self, mut now: ScoredModel) -> Result<ScoredModel, CalibrationError> {
        let mut k = 0;
        let is_over = || self.all.progress.deadline().is_over();
        while now.model.causes.len() > 1 && k < now.model.causes.len() && !is_over() {
            let mut causes = now.model.causes.clone();
            let dropped = causes.remove(k);
            let mut from = now.fit.point.clone();
            self.reset(&mut from, dropped);
            let smaller = self.fit(causes, &now.model, &from)?;
            let needed = self
                .all
                .advantage_over(&now, &smaller, now.effective_sample_ratio());
            if needed.delta_bic > self.all.options.min_delta_bic {
                k += 1;
            } else {
                (now, k) = (smaller, 0);
            }
        }
        Ok(now)
    }

    /// Puts a cause back to its default.
    fn reset(&self, point: &mut ParameterVector, cause: usize) {
        let range = crate::experiment::parameter_range(self.all.experiment, cause);
        let parameters = &self.all.experiment.causes()[cause].parameters;
        for (slot, parameter) in range.zip(parameters) {
            point.causes[slot] = parameter.default;
        }
    }

    /// Which explanations fit the data as well: each effect is exchanged for every other one that could stand for it.
    fn alternatives(
        &self,
        chosen: &ScoredModel,
        base: &ScoredModel,
        singles: &[Trial],
    ) -> Result<Decision, CalibrationError> {
        let worth = chosen.effective_sample_ratio();
        let own = self.all.advantage_over(chosen, base, worth).delta_bic;
        let own_fault = self.implausible(chosen);
        let mut sets: Vec<(f64, Vec<usize>)> = Vec::new();
        if own_fault.is_none() {
            sets.push((own, chosen.model.causes.clone()));
        }
        // What fits better than all that is plausible, and why it is no explanation.
        let mut better: Option<(f64, Vec<usize>, String)> = None;
        for (k, cause) in chosen.model.causes.iter().enumerate() {
            let mut rest = chosen.model.causes.clone();
            rest.remove(k);
            let without = if rest.is_empty() {
                base.clone()
            } else {
                let mut from = chosen.fit.point.clone();
                self.reset(&mut from, *cause);
                self.fit(rest.clone(), &chosen.model, &from)?
            };
            let equivalents = self.all.experiment.equivalents(*cause);
            let mut short = if rest.is_empty() {
                singles
                    .iter()
                    .map(|trial| trial.scored.model.causes[0])
                    .collect()
            } else {
                self.shortlist(&without)?.1
            };
            short.extend(
                equivalents
                    .iter()
                    .filter(|other| !chosen.model.causes.contains(other) && !short.contains(other))
                    .copied()
                    .collect::<Vec<_>>(),
            );
            for other in short.iter().filter(|other| *other != cause) {
                if self.all.progress.deadline().is_over() {
                    break;
                }
                let mut causes = rest.clone();
                causes.insert(k, *other);
                let mut sorted = causes.clone();
                sorted.sort_unstable();
                let is_known = |set: &Vec<usize>| {
                    let mut set = set.clone();
                    set.sort_unstable();
                    set == sorted
                };
                if sets.iter().any(|(_, set)| is_known(set)) {
                    continue;
                }
                // The exchanged cause is fitted last, so that its probes are tried.
                let mut order = rest.clone();
                order.push(*other);
                let known = singles
                    .iter()
                    .find(|trial| trial.scored.model.causes == order);
                let scored = match known {
                    Some(trial) => trial.scored.clone(),
                    None => self.fit(order, &without.model, &without.fit.point)?,
                };
                let fall = self.all.advantage_over(&scored, base, worth).delta_bic;
                let allowed = if equivalents.contains(other) {
                    (EQUIVALENT_SHARE * own).max(self.all.options.rival_delta_bic)
                } else {
                    self.all.options.rival_delta_bic
                };
                match self.implausible(&scored) {
                    None if own - fall < allowed => sets.push((fall, causes)),
                    Some(fault)
                        if fall - own > self.all.options.rival_delta_bic
                            && better.as_ref().is_none_or(|(most, ..)| fall > *most) =>
                    {
                        better = Some((fall, causes, fault));
                    }
                    _ => {}
                }
            }
        }
        sets.sort_by(|a, b| b.0.total_cmp(&a.0));
        if let (Some((fall, causes, fault)), Some((most, next))) = (&better, sets.first())
            && fall - most > self.all.options.rival_delta_bic
        {
            return Ok(Decision::Unexplained(format!(
                "{} fits best by far, but it is not plausible: {fault}; {}, which is, fits worse",
                self.names(causes),
                self.names(next)
            )));
        }
        let mut sets: Vec<Vec<usize>> = sets.into_iter().map(|(_, set)| set).collect();
        Ok(match (sets.len(), own_fault) {
            (0, fault) => Decision::Unexplained(format!(
                "{} fits best, but it is not plausible: {}",
                self.names(&chosen.model.causes),
                fault.unwrap_or_default()
            )),
            // What fits best is not plausible, and another explanation is: it is one that was looked for.
            (1, _) if sets[0] == chosen.model.causes => Decision::Named(sets.remove(0)),
            _ => Decision::OneOf(sets),
        })
    }

    fn names(&self, causes: &[usize]) -> String {
        names(self.all, causes)
    }
}

/// The trial that passes with the largest fall of the criterion, a plausible one before others.
fn best_trial(trials: &[Trial]) -> Option<&ScoredModel> {
    let passing = trials.iter().filter(|trial| trial.passes);
    let best = passing.max_by(|a, b| {
        let plausible = |trial: &Trial| trial.implausible.is_none();
        plausible(a)
            .cmp(&plausible(b))
            .then(a.advantage.delta_bic.total_cmp(&b.advantage.delta_bic))
    });
    best.map(|trial| &trial.scored)
}

/// Fits the nuisances, and estimates the noise of channels that do not state it from the residuals.
fn estimate_noise(
    experiment: &mut dyn Experiment,
    split: &EpisodeSplit,
    options: &CalibrationOptions,
    threads: Threads,
    progress: &dyn ProgressReporter,
) -> Result<ParameterVector, CalibrationError> {
    let start = ParameterVector::start(experiment);
    if experiment.residual_structure() != ResidualStructure::OverTime
        || experiment
            .channels()
            .iter()
            .all(|channel| channel.noise_known)
    {
        return Ok(start);
    }
    let fit = CauseComparer {
        experiment,
        split,
        options,
        threads,
        progress,
    }
    .fit_on(&split.train, &CauseSet::default(), &start)?;
    let rounding = rounding_sd(experiment);
    for channel in 0..experiment.channels().len() {
        if experiment.channels()[channel].noise_known {
            continue;
        }
        let residuals: Vec<Vec<f64>> = split
            .train
            .iter()
            .zip(&fit.residuals)
            .map(|(episode, residual)| {
                let channels = &experiment.episodes()[*episode].channel;
                (0..residual.len())
                    .filter(|k| channels[*k] == channel)
                    .map(|k| residual[k])
                    .collect()
            })
            .collect();
        let slices: Vec<&[f64]> = residuals.iter().map(Vec::as_slice).collect();
        let spread = || {
            let n = residuals.iter().map(Vec::len).sum::<usize>().max(1) as f64;
            (residuals.iter().flatten().map(|r| r * r).sum::<f64>() / n).sqrt()
        };
        let least = rounding.get(&channel).copied();
        let sd = noise_from_differences(&slices)
            .map(|floor| floor.sd)
            .or(least)
            .unwrap_or_else(spread)
            .max(least.unwrap_or(1e-9));
        for measured in experiment.episodes_mut() {
            for (sd_here, channel_here) in measured.sd.iter_mut().zip(&measured.channel) {
                if *channel_here == channel {
                    *sd_here *= sd;
                }
            }
        }
    }
    Ok(fit.point)
}
