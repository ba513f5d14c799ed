//! Plausibility of fitted causes.

use super::compare::{ScoredModel, estimates};
use crate::experiment::{Experiment, FitParameter};

/// The reason why a fitted cause is not plausible: a parameter at its bound, or outside of what a physicist would believe.
pub(super) fn implausibility_reason(
    experiment: &dyn Experiment,
    judged: &ScoredModel,
    cause: usize,
) -> Option<String> {
    let found = estimates(experiment, &judged.fit, judged.effective_count, cause);
    let parameters = &experiment.causes()[cause].parameters;
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
