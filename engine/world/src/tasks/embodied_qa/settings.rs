//! The settings of questions.

use crate::error::WorldError;
use crate::tasks::TaskSetup;
use crate::tasks::navigation::{NavigationRewards, NavigationRules};
use dwell_semantics::ask::QuestionKind;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The task's settings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub(super) struct EmbodiedQaSettings {
    /// Kinds of questions to draw from; default all.
    pub(super) kinds: Vec<QuestionKind>,
    /// The nearest a start may lie to where the answer is seen, geodesic m; default 1.
    min_distance_m: f64,
    /// The furthest, m; default 30.
    max_distance_m: f64,
    /// How many forward steps the way from the start to where the answer is seen takes, turns not counted, 1 to 10,000; in place of both
    /// distances. Default none.
    start_actions: Option<u32>,
    /// Whether all doors stand open at the start; default where the agent has no action `open`.
    open_doors: Option<bool>,
    /// What a step is paid: `distance` (a metre nearer; default 1), `success` (the right answer; default 2.5), `step` (default -0.01),
    /// `wrong_answer` and `collision` (default 0).
    reward: QuestionRewards,
}

/// Rewards of a step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
struct QuestionRewards {
    /// For each metre by which the geodesic distance to where the answer is seen fell; default 1.
    distance: f64,
    /// For `stop` with the right answer; default 2.5.
    success: f64,
    /// For every step; default -0.01.
    step: f64,
    /// For `stop` with another answer; default 0.
    wrong_answer: f64,
    /// For a step that was cut short by something in the way; default 0.
    collision: f64,
}

impl Default for QuestionRewards {
    fn default() -> Self {
        let NavigationRewards {
            distance,
            success,
            step,
            wrong_stop,
            collision,
        } = NavigationRewards::default();
        Self {
            distance,
            success,
            step,
            wrong_answer: wrong_stop,
            collision,
        }
    }
}

impl Default for EmbodiedQaSettings {
    fn default() -> Self {
        Self {
            kinds: QuestionKind::ALL.to_vec(),
            min_distance_m: 1.0,
            max_distance_m: 30.0,
            start_actions: None,
            open_doors: None,
            reward: QuestionRewards::default(),
        }
    }
}

impl EmbodiedQaSettings {
    /// Reads settings (`null` gives the defaults), and makes rules of them.
    pub(super) fn parse(
        value: &serde_json::Value,
        setup: TaskSetup,
    ) -> Result<(Self, NavigationRules), WorldError> {
        let settings: Self = crate::parse_settings::parse_task_settings(value)?;
        let fault = |field: &'static str, found: String, allowed: String| {
            Err(WorldError::Config {
                field,
                found,
                allowed,
            })
        };
        if settings.kinds.is_empty() {
            let names = QuestionKind::ALL.map(QuestionKind::name).join(", ");
            let allowed = format!("at least one of {names}");
            return fault("kinds", "none".to_owned(), allowed);
        }
        let wrong_answer = settings.reward.wrong_answer;
        if wrong_answer.is_nan() || wrong_answer.abs() > 1e6 {
            let allowed = "-1,000,000 to 1,000,000".to_owned();
            return fault("reward.wrong_answer", wrong_answer.to_string(), allowed);
        }
        let distance_m = match settings.start_actions {
            None => [settings.min_distance_m, settings.max_distance_m],
            Some(count @ 1..=10_000) => {
                let (count, step_m) = (f64::from(count), f64::from(setup.stride.forward_m));
                [(count - 0.5) * step_m, (count + 0.5) * step_m]
            }
            Some(count) => {
                return fault("start_actions", count.to_string(), "1 to 10,000".to_owned());
            }
        };
        let rules = NavigationRules {
            distance_m,
            min_path_ratio: 1.0,
            ends_at_goal: false,
            open_doors: settings.open_doors,
            rewards: NavigationRewards {
                distance: settings.reward.distance,
                success: settings.reward.success,
                step: settings.reward.step,
                wrong_stop: wrong_answer,
                collision: settings.reward.collision,
            },
        };
        rules.check()?;
        Ok((settings, rules))
    }
}
