//! More than one effect.

use super::{ScoredModel, Search, best_trial};
use crate::error::CalibrationError;
use crate::experiment::ResidualStructure;

/// The most effects of one model.
const MOST_EFFECTS: usize = 4;
/// Share of what is left that a further effect takes away, from which on it counts though the test of what is left is met.
const SECOND_SHARE: f64 = 0.15;

impl Search<'_> {
    /// Adds effects as long as something systematic is left, and leaves out those that are not needed any more.
    ///
    /// The test of what is left knows no effect, and a weak one hides from it: over time an effect is added, too, that gains more
    /// than chance gives the best of the library, and in cells one that takes a fair part of what is left.
    pub(super) fn extend(
        &self,
        first: ScoredModel,
        base: &ScoredModel,
    ) -> Result<ScoredModel, CalibrationError> {
        let by_cell = self.all.experiment.residual_structure() == ResidualStructure::ByCell;
        let mut now = first;
        while now.model.causes.len() < MOST_EFFECTS && !self.all.progress.deadline().is_over() {
            let is_structured = self.remainder(&now)?.is_structured();
            let (gains, short, by_chance) = self.shortlist(&now)?;
            let least = match (is_structured, by_cell) {
                (true, _) => 0.0,
                (false, true) => SECOND_SHARE * now.fit.loss,
                (false, false) => by_chance,
            };
            let most = gains.iter().map(|gain| gain.gain).fold(0.0, f64::max);
            if most < least {
                break;
            }
            // Of a few recordings turned signs leave too much to chance for a second effect; its share stands for that.
            let by_chance = if by_cell { 0.0 } else { by_chance };
            let trials = self.trials(&now, &short, by_chance)?;
            let larger = best_trial(&trials).filter(|l| now.fit.loss - l.fit.loss > least);
            let Some(larger) = larger.cloned() else {
                break;
            };
            now = self.without_idle(larger)?;
            if by_cell {
                now = self.exchanged(now, base)?;
            }
        }
        Ok(now)
    }

    /// The model with the causes of which others, beside the rest, explain more exchanged for these: the first of a pair was
    /// chosen without the second.
    fn exchanged(
        &self,
        mut now: ScoredModel,
        base: &ScoredModel,
    ) -> Result<ScoredModel, CalibrationError> {
        for k in 0..now.model.causes.len() {
            let mut rest = now.model.causes.clone();
            if rest.len() < 2 {
                break;
            }
            let left_out = rest.remove(k);
            let mut from = now.fit.point.clone();
            self.reset(&mut from, left_out);
            let without = self.fit(rest, &now.model, &from)?;
            let (_, short, _) = self.shortlist(&without)?;
            let others: Vec<usize> = short
                .into_iter()
                .filter(|other| *other != left_out)
                .collect();
            let trials = self.trials(&without, &others, 0.0)?;
            let worth = now.effective_sample_ratio();
            let fall =
                |scored: &ScoredModel| self.all.advantage_over(scored, base, worth).delta_bic;
            if let Some(better) = best_trial(&trials)
                && fall(better) > fall(&now) + self.all.options.rival_delta_bic
            {
                now = better.clone();
            }
        }
        Ok(now)
    }
}
