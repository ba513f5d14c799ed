//! Why nothing is named, in words.

use super::agreement::RegimeAgreement;
use super::compare::{CauseComparer, ScoredModel};
use super::residual::ResidualNoiseTest;
use super::verdict::SingleCause;

/// The names of causes.
pub(super) fn names(all: &CauseComparer<'_>, causes: &[usize]) -> String {
    let names: Vec<String> = causes
        .iter()
        .map(|cause| all.experiment.causes()[*cause].name.clone())
        .collect();
    crate::format_number::format_list(&names)
}

/// The reason why a search that ended early names nothing: what it has tried, and what came nearest.
pub(super) fn unfinished_reason(all: &CauseComparer<'_>, singles: &[SingleCause]) -> String {
    let tried = || singles.iter().filter(|single| single.gain.is_some());
    let causes: Vec<usize> = tried().map(|single| single.cause).collect();
    let ended = match all.options.budget_s {
        Some(budget_s) if !all.options.stop.is_raised() => format!(
            "the search was ended by its budget of {} s",
            crate::format_number::format_number(budget_s)
        ),
        _ => "the search was ended by its user".to_owned(),
    };
    let best = tried()
        .filter(|single| single.passes)
        .max_by(|a, b| a.delta_bic.total_cmp(&b.delta_bic));
    match (causes.is_empty(), best) {
        (true, _) => format!("{ended} before a cause was tried"),
        (false, None) => format!(
            "{ended} with {} tried, none of which passes",
            names(all, &causes)
        ),
        (false, Some(best)) => format!(
            "{ended} with {} tried; nearest comes {}, which was not compared with all of its rivals",
            names(all, &causes),
            names(all, &[best.cause])
        ),
    }
}

/// The reason why no cause passes, with the one that comes nearest.
pub(super) fn rejection_reason(all: &CauseComparer<'_>, singles: &[SingleCause]) -> String {
    let fitted = singles
        .iter()
        .filter_map(|single| Some((single, single.gain?)));
    let best = fitted.max_by(|a, b| a.0.delta_bic.total_cmp(&b.0.delta_bic));
    let none = "none of the causes in the library fits it";
    match best.filter(|(best, _)| best.delta_bic > all.options.min_delta_bic) {
        Some((best, gain)) => {
            let [low, high] = gain
                .share_interval
                .map(crate::format_number::format_percent);
            format!(
                "{none}; nearest comes {}, whose gain on episodes that no fit has seen is not certain ({low} to {high} of \
                 the squared error)",
                all.experiment.causes()[best.cause].name
            )
        }
        None => none.to_owned(),
    }
}

/// The reason why what fits best is no name: something systematic is left.
pub(super) fn structure_reason(
    all: &CauseComparer<'_>,
    chosen: &ScoredModel,
    before: &ResidualNoiseTest,
    after: &ResidualNoiseTest,
) -> String {
    let explained = 1.0 - (after.ratio - 1.0) / (before.ratio - 1.0).max(1e-9);
    format!(
        "{} takes away {:.0} % of the misfit, and what is left is still systematic",
        names(all, &chosen.model.causes),
        100.0 * explained.clamp(0.0, 1.0)
    )
}

/// The reason why a cause that fits is none: its size is not one.
pub(super) fn disagreement_reason(
    all: &CauseComparer<'_>,
    cause: usize,
    found: &RegimeAgreement,
) -> String {
    format!(
        "{} fits best, but it would have to be {} where it acts weakly and {} where it acts strongly, {:.1} standard \
         deviations apart: one value does not serve, so it is not the cause",
        all.experiment.causes()[cause].name,
        crate::format_number::format_number(found.weak),
        crate::format_number::format_number(found.strong),
        found.z.abs()
    )
}
