//! Refinement: the same windows with a quarter of the step, to find the solver's share of the residuals.

use super::motion::Deviation;
use super::regime::ContactRegime;
use super::windows::{HORIZONS, WindowPrediction};
use crate::format_number::format_number;
use crate::median::median;
use serde::Serialize;

/// Number of steps of the finer simulation that make one of the other.
pub const REFINEMENT_FACTOR: u32 = 4;
/// Relative change of a median residual by a finer step above which it is an artefact of the solver.
const ARTEFACT_SHARE: f64 = 0.1;
/// Changes below which nothing has changed, mm and degrees.
const LEAST_CHANGE: [f64; 2] = [0.01, 0.01];
/// Number of windows below which a median says nothing.
const FEWEST: usize = 20;

/// The effect of a finer step in windows of one horizon and regime. Windows that diverge are left out.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StepRefinementEffect {
    /// Samples ahead.
    pub horizon: usize,
    /// The worst that the body does between start and end; `null`: all windows.
    pub regime: Option<ContactRegime>,
    /// Number of windows.
    pub count: usize,
    /// Median distance from what was measured with the step and with a quarter of it, mm.
    pub position_median_mm: [f64; 2],
    /// Median angle likewise, degrees.
    pub rotation_median_deg: [f64; 2],
    /// Median distance between both predictions, mm.
    pub apart_mm: f64,
    /// Median angle between them, degrees.
    pub apart_deg: f64,
    /// True if the residual changes with the step: then that part of it is the solver's, not the model's.
    pub artefact: bool,
}

/// Compares ends with those of the same windows at a quarter of the step.
pub fn step_refinement_effects(
    coarse: &[WindowPrediction],
    fine: &[WindowPrediction],
) -> Vec<StepRefinementEffect> {
    let pairs: Vec<(&WindowPrediction, &WindowPrediction)> = coarse
        .iter()
        .zip(fine)
        .filter(|(a, b)| (a.start, a.horizon) == (b.start, b.horizon) && !a.diverges)
        .collect();
    let mut found = Vec::new();
    for horizon in HORIZONS {
        for regime in std::iter::once(None).chain(ContactRegime::ALL.map(Some)) {
            let here: Vec<_> = pairs
                .iter()
                .filter(|(a, _)| a.horizon == horizon && regime.is_none_or(|r| a.regime == r))
                .collect();
            if here.len() < FEWEST {
                continue;
            }
            let middle = |size: &dyn Fn(&(&WindowPrediction, &WindowPrediction)) -> f64| {
                median(&mut here.iter().map(|pair| size(pair)).collect::<Vec<f64>>())
            };
            let apart = |pair: &(&WindowPrediction, &WindowPrediction)| {
                Deviation::between(&pair.1.predicted, &pair.0.predicted)
            };
            let position_median_mm = [
                middle(&|pair| pair.0.deviation.position_mm()),
                middle(&|pair| pair.1.deviation.position_mm()),
            ];
            let rotation_median_deg = [
                middle(&|pair| pair.0.deviation.rotation_deg()),
                middle(&|pair| pair.1.deviation.rotation_deg()),
            ];
            let changes = |[coarse, fine]: [f64; 2], least: f64| {
                (fine - coarse).abs() > (ARTEFACT_SHARE * coarse).max(least)
            };
            found.push(StepRefinementEffect {
                horizon,
                regime,
                count: here.len(),
                position_median_mm,
                rotation_median_deg,
                apart_mm: middle(&|pair| apart(pair).position_mm()),
                apart_deg: middle(&|pair| apart(pair).rotation_deg()),
                artefact: changes(position_median_mm, LEAST_CHANGE[0])
                    || changes(rotation_median_deg, LEAST_CHANGE[1]),
            });
        }
    }
    found
}

/// Returns the result, in a sentence.
pub(crate) fn sentence(model: &str, refinements: &[StepRefinementEffect]) -> String {
    let artefacts = refinements.iter().filter(|r| r.artefact);
    let told: Vec<String> = artefacts
        .map(|r| {
            let [a, b] = r.position_median_mm.map(format_number);
            let [c, d] = r.rotation_median_deg.map(format_number);
            format!(
                "{} ahead in {} ({a} to {b} mm, {c} to {d} degrees)",
                r.horizon,
                r.regime.map_or("all", ContactRegime::name)
            )
        })
        .collect();
    if told.is_empty() {
        format!("{model}: a quarter of the step changes no median residual by more than a tenth.")
    } else {
        let told = crate::format_number::format_list(&told);
        format!(
            "{model}: solver artefact, the residual changes with a quarter of the step: {told}."
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rollout::MotionState;
    use glam::{DQuat, DVec3};

    fn ends(off_m: f64) -> Vec<WindowPrediction> {
        (0..30)
            .map(|k| {
                let predicted = MotionState {
                    position: DVec3::X * off_m,
                    rotation: DQuat::IDENTITY,
                    linear: DVec3::ZERO,
                    angular: DVec3::ZERO,
                };
                let origin = MotionState {
                    position: DVec3::ZERO,
                    ..predicted
                };
                WindowPrediction {
                    start: (0, k),
                    horizon: 5,
                    regime: ContactRegime::Impact,
                    speed_m_s: 1.0,
                    predicted,
                    deviation: Deviation::between(&predicted, &origin),
                    diverges: false,
                }
            })
            .collect()
    }

    #[test]
    fn a_residual_that_changes_with_the_step_is_named() {
        let same = step_refinement_effects(&ends(1e-3), &ends(1.05e-3));
        assert!(same.iter().all(|r| !r.artefact && r.count == 30));
        assert!((same[0].apart_mm - 0.05).abs() < 1e-9);
        let other = step_refinement_effects(&ends(1e-3), &ends(0.8e-3));
        assert!(other.iter().all(|r| r.artefact));
        assert!(sentence("m", &other).contains("solver artefact"));
        assert!(!sentence("m", &same).contains("artefact"));
    }
}
