//! Errors of whole episodes, and the gain of a model over another.

use super::{ModelOutcome, ModelledSubject};
use crate::error::CalibrationError;
use crate::fit::median;
use crate::format_number::{format_number, format_percent};
use crate::rollout::{Deviation, MotionState};
use crate::select::share_gained;
use dwell_scene::random::RandomKey;
use serde::Serialize;
use std::collections::BTreeMap;

/// Samples of an episode that a fit looks at.
const FIT_SAMPLES: usize = 60;

/// The error over a whole episode, by parameters that it did not choose.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EpisodeDeviation {
    /// Its name.
    pub episode: String,
    /// Its kind.
    pub kind: String,
    /// The fold that it was held out with.
    pub fold: usize,
    /// Distance at the last sample, mm.
    pub end_mm: f64,
    /// Angle at the last sample, degrees.
    pub end_deg: f64,
    /// Mean distance, mm.
    pub mean_mm: f64,
    /// Mean angle, degrees.
    pub mean_deg: f64,
    /// Mean square of the distance, and of the angle times the lever, mm².
    pub square_mm2: f64,
}

/// Medians over episodes of one kind.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct KindMedianDeviations {
    /// The kind; `null`: all episodes.
    pub kind: Option<String>,
    /// Number of episodes.
    pub count: usize,
    /// Distance at the last sample, mm.
    pub end_mm: f64,
    /// Angle at the last sample, degrees.
    pub end_deg: f64,
    /// Mean distance, mm.
    pub mean_mm: f64,
    /// Mean angle, degrees.
    pub mean_deg: f64,
}

/// The gain of a model over the one that it extends, each episode out of fold.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ModelGain {
    /// The other model.
    pub over: &'static str,
    /// Share of the squared error that goes away.
    pub share: f64,
    /// Its 95 % interval over draws of groups.
    pub interval: [f64; 2],
    /// Share of the episodes that are better.
    pub better_share: f64,
}

/// The measured motions after the start of whole roll-outs, beside the predicted ones.
fn paired_rollout<S: ModelledSubject>(
    subject: &S,
    rig: &S::Rig,
    episode: usize,
) -> Result<Vec<(MotionState, MotionState)>, CalibrationError> {
    let measured = subject.measured(episode);
    let at = subject.past_samples();
    let samples = measured.len().saturating_sub(at + 1);
    let predicted = subject.simulate(rig, episode, at, samples, None)?;
    Ok(predicted
        .into_iter()
        .zip(measured[at + 1..].iter().copied())
        .collect())
}

/// An episode's error.
pub(super) fn episode_error<S: ModelledSubject>(
    subject: &S,
    rig: &S::Rig,
    episode: usize,
    fold: usize,
) -> Result<EpisodeDeviation, CalibrationError> {
    let pairs = paired_rollout(subject, rig, episode)?;
    let deviations: Vec<Deviation> = pairs
        .iter()
        .map(|(predicted, measured)| Deviation::between(predicted, measured))
        .collect();
    let last = deviations.last().copied().unwrap_or_default();
    let count = deviations.len().max(1) as f64;
    let mean = |f: &dyn Fn(&Deviation) -> f64| deviations.iter().map(f).sum::<f64>() / count;
    let lever_m = subject.lever_arm_m();
    let square = mean(&|d| d.position_m.powi(2) + (lever_m * d.rotation_rad).powi(2));
    Ok(EpisodeDeviation {
        episode: subject.name(episode).to_owned(),
        kind: subject.kind(episode).to_owned(),
        fold,
        end_mm: last.position_mm(),
        end_deg: last.rotation_deg(),
        mean_mm: mean(&Deviation::position_mm),
        mean_deg: mean(&Deviation::rotation_deg),
        square_mm2: 1e6 * square,
    })
}

/// Returns the residuals that a fit minimizes: each episode counts as one, whatever its length. mm.
pub(super) fn residuals<S: ModelledSubject>(
    subject: &S,
    rig: &S::Rig,
    episode: usize,
) -> Result<Vec<f64>, CalibrationError> {
    let pairs = paired_rollout(subject, rig, episode)?;
    let stride = pairs.len().div_ceil(FIT_SAMPLES).max(1);
    let seen: Vec<_> = pairs.iter().skip(stride - 1).step_by(stride).collect();
    let weight = 1e3 / (seen.len().max(1) as f64).sqrt();
    let lever_m = subject.lever_arm_m();
    Ok(seen
        .into_iter()
        .flat_map(|(predicted, measured)| {
            let shift = predicted.position - measured.position;
            let turned = lever_m
                * crate::bundle::rotation_vector_between(measured.rotation, predicted.rotation);
            [shift, turned]
                .map(|vector| (weight * vector).to_array())
                .concat()
        })
        .collect())
}

/// Medians of all episodes and of each kind.
pub(super) fn by_kind(episodes: &[EpisodeDeviation]) -> Vec<KindMedianDeviations> {
    let mut names: Vec<&str> = episodes.iter().map(|e| e.kind.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    let kinds = std::iter::once(None).chain(names.into_iter().map(Some));
    kinds
        .map(|kind| {
            let here: Vec<&EpisodeDeviation> = episodes
                .iter()
                .filter(|e| kind.is_none_or(|kind| e.kind == kind))
                .collect();
            let middle = |f: &dyn Fn(&EpisodeDeviation) -> f64| {
                median(&mut here.iter().map(|e| f(e)).collect::<Vec<f64>>())
            };
            KindMedianDeviations {
                kind: kind.map(str::to_owned),
                count: here.len(),
                end_mm: middle(&|e| e.end_mm),
                end_deg: middle(&|e| e.end_deg),
                mean_mm: middle(&|e| e.mean_mm),
                mean_deg: middle(&|e| e.mean_deg),
            }
        })
        .collect()
}

/// Returns the gain of `after` over `before`. Groups are drawn, not episodes: those of one session are alike.
pub(super) fn model_gain<S: ModelledSubject>(
    subject: &S,
    before: &ModelOutcome,
    after: &ModelOutcome,
    draws: usize,
    key: RandomKey,
) -> ModelGain {
    let mut groups: BTreeMap<&str, [f64; 2]> = BTreeMap::new();
    let mut better = 0;
    for (k, (b, a)) in before.episodes.iter().zip(&after.episodes).enumerate() {
        let sums = groups.entry(subject.group(k)).or_default();
        sums[0] += b.square_mm2;
        sums[1] += a.square_mm2;
        better += usize::from(a.square_mm2 < b.square_mm2);
    }
    let column = |k: usize| groups.values().map(|sums| sums[k]).collect::<Vec<f64>>();
    let (share, interval) = share_gained(&column(0), &column(1), draws, key);
    ModelGain {
        over: before.model.name,
        share,
        interval,
        better_share: better as f64 / before.episodes.len().max(1) as f64,
    }
}

/// Returns the result in a sentence.
pub(super) fn sentence(best: &ModelOutcome, all: &[ModelOutcome]) -> String {
    let ends = |outcome: &ModelOutcome| {
        outcome.kinds.first().map_or_else(String::new, |all| {
            let turned = if all.end_deg > 0.0 {
                format!(" and {} degrees", format_number(all.end_deg))
            } else {
                String::new()
            };
            format!("{} mm{turned}", format_number(all.end_mm))
        })
    };
    let mut text = format!(
        "Over {} episodes, each predicted by parameters that it did not choose, the model \"{}\" ends {} off in the median",
        best.episodes.len(),
        best.model.name,
        ends(best)
    );
    if let Some(first) = all
        .first()
        .filter(|first| first.model.name != best.model.name)
    {
        text = format!("{text}; \"{}\" {}", first.model.name, ends(first));
    }
    text.push('.');
    for outcome in all {
        if let Some(gain) = &outcome.gain {
            let [low, high] = gain.interval.map(format_percent);
            text = format!(
                "{text} \"{}\" takes {} ({low} to {high}) of the squared error of \"{}\" away.",
                outcome.model.name,
                format_percent(gain.share),
                gain.over
            );
        }
    }
    text
}
