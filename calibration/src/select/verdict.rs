//! From fits to a verdict.

use super::agreement::{SplitHalfAgreement, agreement};
use super::compare::{CauseComparer, ModelAdvantage, ScoredModel, estimates};
use super::residual::{ResidualNoiseTest, noise_from_differences};
use super::split::EpisodeSplit;
use crate::error::CalibrationError;
use crate::fit::CauseSet;
use crate::options::Options;
use crate::progress::ProgressReporter;
use crate::twin::{FitParameter, ParameterVector, ResidualStructure, Twin};
use dwell_scene::parallel::Threads;

/// Share of the misfit that a name must explain where something systematic is left.
const LEAST_EXPLAINED: f64 = 0.8;

/// All findings, before they are put into words.
pub(crate) struct Findings {
    pub(crate) split: EpisodeSplit,
    /// Nuisances alone.
    pub(crate) base: ScoredModel,
    /// Each cause alone, in the order of the twin's causes.
    pub(crate) singles: Vec<SingleCause>,
    /// The model that is reported: nuisances alone, a cause, or two.
    pub(crate) chosen: ScoredModel,
    /// `chosen` against nuisances alone.
    pub(crate) advantage_over_base: Option<ModelAdvantage>,
    pub(crate) remainder_before: ResidualNoiseTest,
    pub(crate) remainder_after: ResidualNoiseTest,
    pub(crate) agreement: Option<SplitHalfAgreement>,
    pub(crate) decision: Decision,
}

/// A cause alone.
pub(crate) struct SingleCause {
    pub(crate) cause: usize,
    pub(crate) scored: ScoredModel,
    pub(crate) advantage: ModelAdvantage,
    pub(crate) passes: bool,
    /// The reason why it is not plausible, if it is not.
    pub(crate) implausible: Option<String>,
}

/// The verdict, by positions of causes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Decision {
    NoEffect,
    Named(Vec<usize>),
    OneOf(Vec<usize>),
    Unexplained(String),
}

/// Finds what the simulation lacks.
pub(crate) fn find_causes(
    twin: &mut dyn Twin,
    options: &Options,
    progress: &dyn ProgressReporter,
) -> Result<Findings, CalibrationError> {
    let split = EpisodeSplit::new(twin.episodes(), options.held_out_share, options.seed);
    let threads = Threads::resolve(options.threads);
    progress.stage(0.1, "fitting starts, offsets and noise")?;
    let start = estimate_noise(twin, &split, options, threads, progress)?;
    let all = CauseComparer {
        twin,
        split: &split,
        options,
        threads,
        progress,
    };
    let base = all.fit_and_score(&CauseSet::default(), &start)?;
    let mut fitted = Vec::new();
    let count = all.twin.causes().len();
    for (cause, info) in all.twin.causes().iter().enumerate() {
        let fraction = 0.2 + 0.5 * cause as f32 / count as f32;
        progress.stage(fraction, &format!("trying {}", info.name))?;
        let model = CauseSet {
            causes: vec![cause],
        };
        fitted.push(all.fit_and_score(&model, &base.fit.point)?);
    }
    let best = fitted
        .iter()
        .min_by(|a, b| a.fit.loss.total_cmp(&b.fit.loss));
    let worth = best.map_or(1.0, ScoredModel::effective_weight);
    let singles: Vec<SingleCause> = fitted
        .into_iter()
        .enumerate()
        .map(|(cause, judged)| {
            let against = all.advantage_over(&judged, &base, worth);
            SingleCause {
                cause,
                passes: all.is_better(&against),
                implausible: implausible(all.twin, &judged, cause),
                scored: judged,
                advantage: against,
            }
        })
        .collect();
    progress.stage(0.7, "comparing causes")?;
    let remainder =
        |judged: &ScoredModel| ResidualNoiseTest::of(all.twin, &split.train, &judged.fit.residuals);
    let remainder_before = remainder(&base);
    let (decision, chosen) = decide(&all, &base, &singles, &remainder_before)?;
    let mut decision = decision;
    let remainder_after = remainder(&chosen);
    let mut found_agreement = None;
    if let Decision::Named(causes) = &decision {
        progress.stage(0.9, "checking that the cause has one size everywhere")?;
        found_agreement = agreement(&all, &chosen)?;
        let name = &all.twin.causes()[causes[0]].name;
        let explained =
            1.0 - (remainder_after.ratio - 1.0) / (remainder_before.ratio - 1.0).max(1e-9);
        if let Some(agreement) = found_agreement
            .as_ref()
            .filter(|agreement| agreement.is_refuting())
        {
            decision = Decision::Unexplained(format!(
                "{name} fits best, but it would have to be {} where it acts weakly and {} where it acts strongly, {:.1} \
                 standard deviations apart: one value does not serve, so it is not the cause",
                crate::format_number::format_number(agreement.weak),
                crate::format_number::format_number(agreement.strong),
                agreement.z.abs()
            ));
        } else if remainder_after.is_structured() && explained < LEAST_EXPLAINED {
            decision = Decision::Unexplained(format!(
                "{name} takes away {:.0} % of the misfit, and what is left is still systematic",
                100.0 * explained.clamp(0.0, 1.0)
            ));
        }
    }
    let advantage_over_base = (!chosen.model.causes.is_empty())
        .then(|| all.advantage_over(&chosen, &base, chosen.effective_weight()));
    Ok(Findings {
        base,
        singles,
        chosen,
        advantage_over_base,
        remainder_before,
        remainder_after,
        agreement: found_agreement,
        decision,
        split,
    })
}

/// Fits the nuisances, and estimates the noise of channels that do not state it from the residuals.
fn estimate_noise(
    twin: &mut dyn Twin,
    split: &EpisodeSplit,
    options: &Options,
    threads: Threads,
    progress: &dyn ProgressReporter,
) -> Result<ParameterVector, CalibrationError> {
    let start = ParameterVector::start(twin);
    if twin.residual_structure() != ResidualStructure::OverTime
        || twin.channels().iter().all(|channel| channel.noise_known)
    {
        return Ok(start);
    }
    let fit = CauseComparer {
        twin,
        split,
        options,
        threads,
        progress,
    }
    .fit_on(&split.train, &CauseSet::default(), &start)?;
    for channel in 0..twin.channels().len() {
        if twin.channels()[channel].noise_known {
            continue;
        }
        let residuals: Vec<Vec<f64>> = split
            .train
            .iter()
            .zip(&fit.residuals)
            .map(|(episode, residual)| {
                let channels = &twin.episodes()[*episode].channel;
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
        let sd = noise_from_differences(&slices)
            .filter(|sd| *sd > 0.0)
            .unwrap_or_else(spread)
            .max(1e-9);
        for measured in twin.episodes_mut() {
            for (sd_here, channel_here) in measured.sd.iter_mut().zip(&measured.channel) {
                if *channel_here == channel {
                    *sd_here *= sd;
                }
            }
        }
    }
    Ok(fit.point)
}

/// The reason why a fitted cause is not plausible: a parameter at its bound, or outside of what a physicist would believe.
fn implausible(twin: &dyn Twin, judged: &ScoredModel, cause: usize) -> Option<String> {
    let found = estimates(twin, &judged.fit, judged.effective_count, cause);
    let parameters = &twin.causes()[cause].parameters;
    let at_bound = |p: &FitParameter, value: f64| {
        let near = 1e-9 * (1.0 + value.abs());
        (value - p.low < near || p.high - value < near) && (value - p.default).abs() > near
    };
    parameters.iter().zip(&found).find_map(|(p, estimate)| {
        let [low, high] = estimate.interval();
        let number = crate::format_number::format_number;
        // A parameter that the data leave where it was needs no plausibility.
        if low <= p.default && p.default <= high {
            None
        } else if parameters.len() == 1 && at_bound(p, estimate.value) {
            Some(format!(
                "{} ends at its bound {} {}",
                p.name,
                number(estimate.value),
                p.unit
            ))
        } else if high < p.plausible[0] || low > p.plausible[1] {
            let [a, b] = p.plausible.map(number);
            Some(format!(
                "{} would be {} {}, plausible are {a} to {b}",
                p.name,
                number(estimate.value),
                p.unit
            ))
        } else {
            None
        }
    })
}

fn decide(
    all: &CauseComparer<'_>,
    base: &ScoredModel,
    singles: &[SingleCause],
    remainder: &ResidualNoiseTest,
) -> Result<(Decision, ScoredModel), CalibrationError> {
    let mut passing: Vec<&SingleCause> = singles.iter().filter(|single| single.passes).collect();
    passing.sort_by(|a, b| b.advantage.delta_bic.total_cmp(&a.advantage.delta_bic));
    let causes = all.twin.causes();
    let Some(best) = passing.first() else {
        let decision = if remainder.is_structured() {
            Decision::Unexplained(rejection_reason(all, singles))
        } else {
            Decision::NoEffect
        };
        return Ok((decision, base.clone()));
    };
    // Rivals count whether or not each passes on its own: a cause that fits as well could be it.
    let close = |single: &&SingleCause| {
        best.advantage.delta_bic - single.advantage.delta_bic < all.options.rival_delta_bic
    };
    let rivals: Vec<&SingleCause> = singles.iter().filter(close).collect();
    let plausible: Vec<&&SingleCause> = rivals
        .iter()
        .filter(|single| single.implausible.is_none())
        .collect();
    match plausible[..] {
        [] => {
            let why = best.implausible.clone().unwrap_or_default();
            let name = &causes[best.cause].name;
            let decision =
                Decision::Unexplained(format!("{name} fits best, but it is not plausible: {why}"));
            Ok((decision, best.scored.clone()))
        }
        [only] => second_cause(all, only, singles),
        _ => {
            let set = plausible.iter().map(|single| single.cause).collect();
            Ok((Decision::OneOf(set), plausible[0].scored.clone()))
        }
    }
}

/// The reason why no cause passes, with the one that comes nearest.
fn rejection_reason(all: &CauseComparer<'_>, singles: &[SingleCause]) -> String {
    let best = singles
        .iter()
        .max_by(|a, b| a.advantage.delta_bic.total_cmp(&b.advantage.delta_bic));
    let none = "none of the causes in the library fits it";
    match best.filter(|best| best.advantage.delta_bic > all.options.min_delta_bic) {
        Some(best) => {
            let [low, high] = best
                .advantage
                .gain
                .share_interval
                .map(crate::format_number::format_percent);
            format!(
                "{none}; nearest comes {}, whose gain on episodes that no fit has seen is not certain ({low} to {high} of \
                 the squared error)",
                all.twin.causes()[best.cause].name
            )
        }
        None => none.to_owned(),
    }
}

/// Searches for a second cause beside the first.
fn second_cause(
    all: &CauseComparer<'_>,
    first: &SingleCause,
    singles: &[SingleCause],
) -> Result<(Decision, ScoredModel), CalibrationError> {
    let remainder = ResidualNoiseTest::of(all.twin, &all.split.train, &first.scored.fit.residuals);
    let alone = (Decision::Named(vec![first.cause]), first.scored.clone());
    // A second cause is searched only where the first leaves structure.
    if !remainder.is_structured() {
        return Ok(alone);
    }
    let mut best: Option<(f64, ScoredModel)> = None;
    for other in singles.iter().filter(|single| single.cause != first.cause) {
        let model = CauseSet {
            causes: vec![first.cause, other.cause],
        };
        let judged = all.fit_and_score(&model, &first.scored.fit.point)?;
        let against = all.advantage_over(&judged, &first.scored, judged.effective_weight());
        let plausible = model
            .causes
            .iter()
            .all(|cause| implausible(all.twin, &judged, *cause).is_none());
        if plausible
            && all.is_better(&against)
            && best
                .as_ref()
                .is_none_or(|(delta, _)| against.delta_bic > *delta)
        {
            best = Some((against.delta_bic, judged));
        }
    }
    Ok(match best {
        Some((_, judged)) => (Decision::Named(judged.model.causes.clone()), judged),
        None => alone,
    })
}
