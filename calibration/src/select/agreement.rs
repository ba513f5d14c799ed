//! Agreement of a cause's size wherever it is strong or weak: a name that fits one regime and not another is refuted.

use super::compare::{CauseComparer, Estimate, ScoredModel, estimates};
use super::residual::effective_count;
use crate::error::CalibrationError;
use crate::experiment::{ResidualStructure, parameter_range};
use serde::Serialize;

/// Number of standard deviations of difference from which on the name is refuted.
const REFUTED: f64 = 4.0;
/// Share of the value below which a difference is no refutation: masses and sizes are never known better.
const ALLOWED_SHARE: f64 = 0.05;

/// The first parameter of a cause, fitted apart in the episodes that feel it least and most.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RegimeAgreement {
    /// Its fit in the half of the episodes that feels it least.
    pub weak: f64,
    /// Its fit in the half that feels it most.
    pub strong: f64,
    /// Their difference over its standard deviation.
    pub z: f64,
}

impl RegimeAgreement {
    /// Returns whether the two differ by more than chance and the precision of masses and sizes allow.
    pub(crate) fn is_refuting(&self) -> bool {
        let size = self.weak.abs().max(self.strong.abs());
        self.z.abs() > REFUTED && (self.weak - self.strong).abs() > ALLOWED_SHARE * size
    }
}

/// Fits one of `judged`'s causes apart in two halves of the training episodes; `None` where there are too few.
pub(super) fn agreement(
    all: &CauseComparer<'_>,
    judged: &ScoredModel,
    cause: usize,
) -> Result<Option<RegimeAgreement>, CalibrationError> {
    if all.experiment.residual_structure() != ResidualStructure::OverTime
        || all.split.train.len() < 6
    {
        return Ok(None);
    }
    let first = parameter_range(all.experiment, cause).start;
    let default = all.experiment.causes()[cause].parameters[0].default;
    let mut felt = Vec::new();
    for episode in &all.split.train {
        let mut without = judged.fit.point.clone();
        let with = all
            .experiment
            .predict(*episode, &without.values(*episode))?;
        without.causes[first] = default;
        let without = all
            .experiment
            .predict(*episode, &without.values(*episode))?;
        let square: f64 = with
            .iter()
            .zip(&without)
            .map(|(a, b)| (a - b).powi(2))
            .sum();
        felt.push((square / with.len().max(1) as f64, *episode));
    }
    felt.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let half = felt.len() / 2;
    let mut found = [Estimate {
        value: 0.0,
        sd: 0.0,
    }; 2];
    for (k, part) in [&felt[..half], &felt[half..]].iter().enumerate() {
        let mut set: Vec<usize> = part.iter().map(|(_, episode)| *episode).collect();
        set.sort_unstable();
        let fit = all.fit_on(&set, &judged.model, &judged.fit.point)?;
        let worth = effective_count(all.experiment, &set, &fit.residuals);
        found[k] = estimates(all.experiment, &fit, worth, cause)[0];
    }
    let [weak, strong] = found;
    let sd = weak.sd.hypot(strong.sd);
    let z = if sd > 0.0 {
        (weak.value - strong.value) / sd
    } else {
        0.0
    };
    Ok(Some(RegimeAgreement {
        weak: weak.value,
        strong: strong.value,
        z,
    }))
}
