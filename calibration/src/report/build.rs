//! From findings to the report.

use super::data::{
    CalibrationReport, CalibrationVerdict, CandidateCause, FittedParameter, FoundEffects,
    NamedEffect, NuisanceParameter, Provenance,
};
use super::plot::plots;
use crate::bundle::Bundle;
use crate::bundle::file::BundleKind;
use crate::experiment::{Experiment, FitParameter, ModelChanges, ParameterIndex};
use crate::format_number::{format_list, format_number, format_percent};
use crate::select::{
    Decision, Estimate, Findings, ScoredModel, SingleCause, channel_residuals, estimates,
    parameter_sd,
};
use std::collections::BTreeMap;

/// The version of the report's form.
const VERSION: u32 = 1;

/// Puts findings into a report.
pub(crate) fn build(
    bundle: &Bundle,
    experiment: &dyn Experiment,
    findings: &Findings,
    seed: u64,
) -> CalibrationReport {
    let verdict = verdict(experiment, findings);
    let named = matches!(verdict, CalibrationVerdict::Named { .. });
    let chosen = if named {
        &findings.chosen
    } else {
        &findings.base
    };
    let (set_before, before) = all_residuals(findings, &findings.base);
    let (set_after, after) = all_residuals(findings, chosen);
    let name = |set: &[usize]| {
        set.iter()
            .map(|k| experiment.episodes()[*k].name.clone())
            .collect()
    };
    let candidates: Vec<CandidateCause> = findings
        .singles
        .iter()
        .map(|single| candidate(experiment, single))
        .collect();
    CalibrationReport {
        version: VERSION,
        title: bundle.manifest.title.clone(),
        licence: bundle.manifest.licence.clone(),
        kind: bundle.kind(),
        finished: findings.is_finished,
        sentence: verdict_sentence(&verdict, &candidates, experiment, findings),
        fitted_episodes: name(&findings.split.train),
        held_out_episodes: name(&findings.split.held_out),
        residuals_before: channel_residuals(experiment, &set_before, &before),
        residuals_after: channel_residuals(experiment, &set_after, &after),
        remainder_before: findings.remainder_before,
        remainder_after: if named {
            findings.remainder_after
        } else {
            findings.remainder_before
        },
        agreement: findings.agreement.clone(),
        nuisances: nuisances(experiment, chosen),
        found: if named {
            found(bundle, experiment, findings, seed)
        } else {
            FoundEffects::default()
        },
        plots: plots(
            experiment,
            (&set_before, &before),
            named.then_some((&set_after[..], &after[..])),
        ),
        notes: notes(bundle, experiment, findings),
        candidates,
        verdict,
    }
}

/// Residuals of all episodes, fitted ones first.
fn all_residuals(findings: &Findings, judged: &ScoredModel) -> (Vec<usize>, Vec<Vec<f64>>) {
    let set = findings
        .split
        .train
        .iter()
        .chain(&findings.split.held_out)
        .copied()
        .collect();
    let residuals = judged
        .fit
        .residuals
        .iter()
        .chain(&judged.held_out.residuals)
        .cloned()
        .collect();
    (set, residuals)
}

fn fitted(parameter: &FitParameter, estimate: &Estimate) -> FittedParameter {
    let [low, high] = estimate.interval();
    FittedParameter {
        name: parameter.name.clone(),
        unit: parameter.unit.clone(),
        value: estimate.value,
        interval: [low.max(parameter.low), high.min(parameter.high)],
        default: parameter.default,
        plausible: parameter.plausible,
    }
}

fn parameters(
    experiment: &dyn Experiment,
    judged: &ScoredModel,
    cause: usize,
) -> Vec<FittedParameter> {
    let found = estimates(experiment, &judged.fit, judged.effective_count, cause);
    let parameters = experiment.causes()[cause].parameters.iter();
    parameters
        .zip(&found)
        .map(|(parameter, estimate)| fitted(parameter, estimate))
        .collect()
}

fn candidate(experiment: &dyn Experiment, single: &SingleCause) -> CandidateCause {
    let cause = &experiment.causes()[single.cause];
    let parameters = cause.parameters.iter().zip(&single.estimates);
    CandidateCause {
        id: cause.id.clone(),
        name: cause.name.clone(),
        equation: cause.equation.clone(),
        parameters: parameters
            .map(|(parameter, estimate)| fitted(parameter, estimate))
            .collect(),
        delta_bic: single.delta_bic,
        gain: single.gain,
        idle: single.is_idle,
        passes: single.passes,
        implausible: single.implausible.clone(),
        separating_experiment: cause.separating_experiment.clone(),
    }
}

fn verdict(experiment: &dyn Experiment, findings: &Findings) -> CalibrationVerdict {
    let cause = |index: &usize| &experiment.causes()[*index];
    match (&findings.decision, findings.advantage_over_base) {
        (Decision::Named(causes), Some(against)) if !causes.is_empty() => {
            CalibrationVerdict::Named {
                law: cause(&causes[0]).id.clone(),
                effects: causes
                    .iter()
                    .map(|index| NamedEffect {
                        law: cause(index).id.clone(),
                        name: cause(index).name.clone(),
                        equation: cause(index).equation.clone(),
                        parameters: parameters(experiment, &findings.chosen, *index),
                    })
                    .collect(),
                gain: against.gain,
            }
        }
        (Decision::OneOf(sets), _) => {
            let mut members: Vec<usize> = Vec::new();
            for index in sets.iter().flatten() {
                if !members.contains(index) {
                    members.push(*index);
                }
            }
            let ids = |set: &Vec<usize>| set.iter().map(|index| cause(index).id.clone()).collect();
            CalibrationVerdict::OneOf {
                laws: ids(&members),
                sets: sets.iter().map(ids).collect(),
                separating_experiments: members
                    .iter()
                    .map(|index| cause(index).separating_experiment.clone())
                    .collect(),
            }
        }
        (Decision::Unexplained(reason), _) => CalibrationVerdict::Unexplained {
            reason: reason.clone(),
        },
        _ => CalibrationVerdict::NoEffect,
    }
}

fn unit_suffix(unit: &str) -> String {
    if unit == "1" {
        String::new()
    } else {
        format!(" {unit}")
    }
}

/// The parameters of an effect in words: those that the data move, the rest counted.
fn in_words(parameters: &[FittedParameter]) -> String {
    let moved = |p: &&FittedParameter| !(p.interval[0] <= p.default && p.default <= p.interval[1]);
    let told: Vec<String> = parameters
        .iter()
        .filter(moved)
        .map(|p| {
            let [low, high] = p.interval.map(format_number);
            format!(
                "{} = {}{} ({low} to {high})",
                p.name,
                format_number(p.value),
                unit_suffix(&p.unit)
            )
        })
        .collect();
    if told.is_empty() {
        "within the intervals of what it was".to_owned()
    } else {
        format_list(&told)
    }
}

fn verdict_sentence(
    verdict: &CalibrationVerdict,
    candidates: &[CandidateCause],
    experiment: &dyn Experiment,
    findings: &Findings,
) -> String {
    let name = |id: &String| {
        candidates
            .iter()
            .find(|c| c.id == *id)
            .map_or(id.clone(), |c| c.name.clone())
    };
    match verdict {
        CalibrationVerdict::NoEffect => {
            let limits: Vec<String> = candidates
                .iter()
                .filter(|c| c.parameters.len() == 1 && !c.idle)
                .map(|c| {
                    let p = &c.parameters[0];
                    // What is not shown to act may be absent, whatever the estimate.
                    let [low, high] = [p.interval[0].min(p.default), p.interval[1].max(p.default)]
                        .map(format_number);
                    format!(
                        "{} of {} {low} to {high}{}",
                        p.name,
                        c.id,
                        unit_suffix(&p.unit)
                    )
                })
                .collect();
            let limits = if limits.is_empty() {
                String::new()
            } else {
                format!(" Limits at 95 %: {}.", format_list(&limits))
            };
            format!("Nothing is missing that this data could show.{limits}")
        }
        CalibrationVerdict::Named { effects, gain, .. } => {
            let told: Vec<String> = effects
                .iter()
                .map(|e| format!("{}, {}", e.name, in_words(&e.parameters)))
                .collect();
            let [low, high] = gain.share_interval.map(format_percent);
            let is_of_measurement = |effect: &NamedEffect| {
                let mut causes = experiment.causes().iter();
                causes.any(|cause| cause.id == effect.law && cause.is_of_measurement())
            };
            let lead = if effects.iter().all(is_of_measurement) {
                "What is wrong is the measurement, not the simulation"
            } else {
                "What the simulation lacks"
            };
            format!(
                "{lead}: {}. It takes away {} ({low} to {high}) of the squared error on episodes that no fit has seen.",
                told.join("; and "),
                format_percent(gain.share)
            )
        }
        CalibrationVerdict::OneOf {
            sets,
            separating_experiments,
            ..
        } => {
            let sets: Vec<String> = sets
                .iter()
                .map(|set| set.iter().map(name).collect::<Vec<_>>().join(" with "))
                .collect();
            format!(
                "Something is missing, but this data cannot tell apart {}. What would: {}.",
                format_list(&sets),
                separating_experiments.join("; ")
            )
        }
        CalibrationVerdict::Unexplained { reason } => {
            let worst = channel_residuals(
                experiment,
                &findings.split.train,
                &findings.base.fit.residuals,
            )
            .into_iter()
            .max_by(|a, b| a.chi2_per_count.total_cmp(&b.chi2_per_count));
            let size = worst.map_or_else(String::new, |w| {
                format!(
                    " It is worth {}{} in {}.",
                    format_number(w.rms),
                    unit_suffix(&w.unit),
                    w.channel
                )
            });
            format!(
                "Something is missing that has no name here: {reason}.{size} Nothing was added to the model."
            )
        }
    }
}

fn nuisances(experiment: &dyn Experiment, judged: &ScoredModel) -> Vec<NuisanceParameter> {
    let shared = experiment.shared_nuisances().iter().enumerate();
    shared
        .map(|(k, parameter)| NuisanceParameter {
            name: parameter.name.clone(),
            unit: parameter.unit.clone(),
            value: judged.fit.point.shared[k],
            sd: parameter_sd(
                &judged.fit,
                judged.effective_count,
                ParameterIndex::Shared(k),
            ),
        })
        .collect()
}

fn found(
    bundle: &Bundle,
    experiment: &dyn Experiment,
    findings: &Findings,
    seed: u64,
) -> FoundEffects {
    let chosen = &findings.chosen;
    let install = ModelChanges::installable(
        experiment.causes(),
        &chosen.fit.point.causes,
        &chosen.model.causes,
    );
    let mut intervals = BTreeMap::new();
    for index in &chosen.model.causes {
        let cause = &experiment.causes()[*index];
        for (k, value) in parameters(experiment, chosen, *index).iter().enumerate() {
            for address in cause.addresses(k) {
                intervals.insert(address, value.interval);
            }
        }
    }
    let is_installed = !install.laws.is_empty() || !install.overrides.is_empty();
    FoundEffects {
        version: FoundEffects::VERSION,
        laws: install.laws,
        parameters: install.overrides.into_iter().collect(),
        intervals,
        provenance: findings
            .advantage_over_base
            .filter(|_| is_installed)
            .map(|advantage| Provenance {
                title: bundle.manifest.title.clone(),
                data_xxh3: bundle.digest(),
                version: env!("CARGO_PKG_VERSION").to_owned(),
                seed,
                fitted_episodes: findings.split.train.len(),
                held_out_episodes: findings.split.held_out.len(),
                gain: advantage.gain,
            }),
    }
}

fn notes(bundle: &Bundle, experiment: &dyn Experiment, findings: &Findings) -> Vec<String> {
    let mut notes = Vec::new();
    if !findings.split.by_group {
        notes.push(
            "All episodes are of one group, or the groups are too unequal to hold one out: episodes were held out, so what \
             is common to a session is in both parts."
                .to_owned(),
        );
    }
    let air = &bundle.manifest.scene.environment;
    let missing: Vec<String> = [
        (
            "temperature (20 degrees Celsius taken)",
            air.temperature_c.is_none(),
        ),
        (
            "humidity (50 % taken)",
            air.humidity_pct.is_none() && bundle.kind() == BundleKind::ImpulseResponse,
        ),
        ("pressure (101325 Pa taken)", air.pressure_pa.is_none()),
        (
            "local gravity (standard gravity taken)",
            air.g_m_s2.is_none() && bundle.kind() == BundleKind::Trajectory,
        ),
    ]
    .into_iter()
    .filter(|(_, missing)| *missing && bundle.kind() != BundleKind::Servo)
    .map(|(what, _)| what.to_owned())
    .collect();
    if !missing.is_empty() {
        notes.push(format!("Not measured: {}.", format_list(&missing)));
    }
    let own: Vec<String> = experiment
        .episode_nuisances()
        .iter()
        .map(|parameter| parameter.name.clone())
        .collect();
    if !own.is_empty() {
        notes.push(format!(
            "Fitted in every episode, and never an effect: {}.",
            format_list(&own)
        ));
    }
    notes.extend(experiment.notes());
    match bundle.kind() {
        BundleKind::Trajectory => notes.push(
            "A time offset is no effect in free flight: a flight that starts earlier starts elsewhere.".to_owned(),
        ),
        BundleKind::ImpulseResponse => notes.push(
            "Levels are compared from the direct sound on, with a fitted gain in every band; echoes are compared with the nearest \
             that the simulation has, where the direct sound is short and places are known to a centimetre."
                .to_owned(),
        ),
        BundleKind::Servo | BundleKind::PoseTrajectory | BundleKind::Drive => {}
    }
    notes
}
