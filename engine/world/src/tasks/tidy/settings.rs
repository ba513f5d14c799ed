//! The settings of the task.

use crate::error::WorldError;
use crate::tasks::relocation::{
    check_classes, check_counts, check_moves, check_rewards, setting_error,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The task's settings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub(super) struct TidySettings {
    /// The least number of things that lie where they do not belong, 1 to 20; default 1.
    pub(super) min_things: u32,
    /// The greatest number, up to 20; default 3.
    pub(super) max_things: u32,
    /// Classes of things to displace, by the names of `assets/categories.csv`; default all that the rules know.
    pub(super) classes: Vec<String>,
    /// How far a thing is moved at least, m in a straight line; default 0.5.
    pub(super) min_move_m: f32,
    /// How far at most, m; default 10.
    pub(super) max_move_m: f32,
    /// The share of things that are put on the floor, 0 to 1; default 0.3. The others lie on furniture where they do not belong.
    pub(super) floor_share: f64,
    /// Whether all doors between rooms stand open at the start; default true.
    pub(super) open_doors: bool,
    /// What a step is paid: `tidied` (for each thing by which the number of untidy ones fell; default 1), `success` (default 2.5),
    /// `step` (default -0.01), `wrong_stop` and `collision` (default 0).
    pub(super) reward: TidyRewards,
}

/// Rewards of a step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub(super) struct TidyRewards {
    /// For each thing by which the number of untidy ones fell; default 1. With 0 the reward is sparse.
    pub(super) tidied: f64,
    /// For success; default 2.5.
    pub(super) success: f64,
    /// For every step; default -0.01.
    pub(super) step: f64,
    /// For `stop` while something lies where it does not belong; default 0.
    pub(super) wrong_stop: f64,
    /// For a step that was cut short by something in the way; default 0.
    pub(super) collision: f64,
}

impl Default for TidyRewards {
    fn default() -> Self {
        Self {
            tidied: 1.0,
            success: 2.5,
            step: -0.01,
            wrong_stop: 0.0,
            collision: 0.0,
        }
    }
}

impl Default for TidySettings {
    fn default() -> Self {
        Self {
            min_things: 1,
            max_things: 3,
            classes: Vec::new(),
            min_move_m: 0.5,
            max_move_m: 10.0,
            floor_share: 0.3,
            open_doors: true,
            reward: TidyRewards::default(),
        }
    }
}

impl TidySettings {
    pub(super) fn check(&self) -> Result<(), WorldError> {
        check_counts(self.min_things, self.max_things)?;
        check_moves(self.min_move_m, self.max_move_m)?;
        check_classes(&self.classes)?;
        if !(0.0..=1.0).contains(&self.floor_share) {
            return Err(setting_error("floor_share", self.floor_share, "0 to 1"));
        }
        let TidyRewards {
            tidied,
            success,
            step,
            wrong_stop,
            collision,
        } = self.reward;
        check_rewards(&[
            ("reward.tidied", tidied),
            ("reward.success", success),
            ("reward.step", step),
            ("reward.wrong_stop", wrong_stop),
            ("reward.collision", collision),
        ])
    }
}
