//! The settings of the task.

use crate::error::WorldError;
use crate::tasks::relocation::{
    MOST_THINGS, check_classes, check_counts, check_moves, check_rewards, setting_error,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The task's settings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub(super) struct RearrangeSettings {
    /// The least number of things that are changed, 1 to 20; default 1.
    pub(super) min_things: u32,
    /// The greatest number, up to 20; default 5.
    pub(super) max_things: u32,
    /// How many of them at most are furniture that is opened or closed; default 1. With 0 things are moved alone.
    pub(super) max_openables: u32,
    /// Classes of things to move, by the names of `assets/categories.csv`; default all that can be picked up.
    pub(super) classes: Vec<String>,
    /// How far a thing is moved at least, m in a straight line; default 0.5.
    pub(super) min_move_m: f32,
    /// How far at most, m; default 10.
    pub(super) max_move_m: f32,
    /// Whether `place` puts what is held exactly where it belongs, where that place is in reach and at most 45 degrees from the middle
    /// of the view; default true.
    pub(super) snap: bool,
    /// Whether all doors between rooms stand open at the start; default true.
    pub(super) open_doors: bool,
    /// What a step is paid: `energy` (for each unit by which the energy fell; default 1), `success` (default 2.5), `step` (default
    /// -0.01), `wrong_stop` and `collision` (default 0).
    pub(super) reward: RearrangeRewards,
}

/// Rewards of a step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub(super) struct RearrangeRewards {
    /// For each unit by which the energy fell; default 1. With 0 the reward is sparse.
    pub(super) energy: f64,
    /// For success; default 2.5.
    pub(super) success: f64,
    /// For every step; default -0.01.
    pub(super) step: f64,
    /// For `stop` while something is not as it was; default 0.
    pub(super) wrong_stop: f64,
    /// For a step that was cut short by something in the way; default 0.
    pub(super) collision: f64,
}

impl Default for RearrangeRewards {
    fn default() -> Self {
        Self {
            energy: 1.0,
            success: 2.5,
            step: -0.01,
            wrong_stop: 0.0,
            collision: 0.0,
        }
    }
}

impl Default for RearrangeSettings {
    fn default() -> Self {
        Self {
            min_things: 1,
            max_things: 5,
            max_openables: 1,
            classes: Vec::new(),
            min_move_m: 0.5,
            max_move_m: 10.0,
            snap: true,
            open_doors: true,
            reward: RearrangeRewards::default(),
        }
    }
}

impl RearrangeSettings {
    pub(super) fn check(&self) -> Result<(), WorldError> {
        check_counts(self.min_things, self.max_things)?;
        if self.max_openables > MOST_THINGS {
            let allowed = format!("0 to {MOST_THINGS}");
            return Err(setting_error("max_openables", self.max_openables, allowed));
        }
        check_moves(self.min_move_m, self.max_move_m)?;
        check_classes(&self.classes)?;
        let RearrangeRewards {
            energy,
            success,
            step,
            wrong_stop,
            collision,
        } = self.reward;
        check_rewards(&[
            ("reward.energy", energy),
            ("reward.success", success),
            ("reward.step", step),
            ("reward.wrong_stop", wrong_stop),
            ("reward.collision", collision),
        ])
    }
}
