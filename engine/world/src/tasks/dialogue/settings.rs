//! The settings of dialogues.

use crate::error::WorldError;
use crate::tasks::navigation::{NavigationRewards, NavigationRules};
use crate::tasks::point_nav::check_success_distance;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The most things that an instruction may fit.
pub(super) const MOST_CANDIDATES: u32 = 8;
/// The most questions that may be allowed.
const MOST_QUESTIONS: u32 = 1000;

/// The task's settings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub(super) struct DialogueSettings {
    /// The fewest things that an instruction fits, 2 to 8; default 2.
    pub(super) min_candidates: u32,
    /// The most, 2 to 8; default 6.
    pub(super) max_candidates: u32,
    /// How many questions are answered in an episode, 0 to 1000; default 8.
    pub(super) max_questions: u32,
    /// What every question costs that is answered, understood or not; default 0.1.
    pub(super) question_cost: f64,
    /// Success within this distance of the thing's outline, seen from above, m; default 1.
    pub(super) success_distance_m: f64,
    /// The nearest a start may lie to any of the things that the instruction fits, geodesic m; default 1.
    min_distance_m: f64,
    /// The furthest, m; default 30.
    max_distance_m: f64,
    /// Whether all doors stand open at the start; default where the agent has no action `open`.
    open_doors: Option<bool>,
    /// What a step is paid: `distance` (a metre nearer to the thing that is meant; default 1), `success` (default 2.5), `step` (default
    /// -0.01), `wrong_stop` and `collision` (default 0).
    reward: NavigationRewards,
}

impl Default for DialogueSettings {
    fn default() -> Self {
        Self {
            min_candidates: 2,
            max_candidates: 6,
            max_questions: 8,
            question_cost: 0.1,
            success_distance_m: 1.0,
            min_distance_m: 1.0,
            max_distance_m: 30.0,
            open_doors: None,
            reward: NavigationRewards::default(),
        }
    }
}

impl DialogueSettings {
    /// Reads settings (`null` gives the defaults), and makes rules of them.
    pub(super) fn parse(value: &serde_json::Value) -> Result<(Self, NavigationRules), WorldError> {
        let settings: Self = crate::parse_settings::parse_task_settings(value)?;
        let fault = |field: &'static str, found: String, allowed: String| {
            Err(WorldError::Config {
                field,
                found,
                allowed,
            })
        };
        let [least, most] = [settings.min_candidates, settings.max_candidates];
        if !(2..=MOST_CANDIDATES).contains(&most) {
            let allowed = format!("2 to {MOST_CANDIDATES}");
            return fault("max_candidates", most.to_string(), allowed);
        }
        if !(2..=most).contains(&least) {
            let allowed = format!("2 to max_candidates, which is {most}");
            return fault("min_candidates", least.to_string(), allowed);
        }
        if settings.max_questions > MOST_QUESTIONS {
            let allowed = format!("0 to {MOST_QUESTIONS}");
            return fault("max_questions", settings.max_questions.to_string(), allowed);
        }
        if !(0.0..=1e6).contains(&settings.question_cost) {
            let found = settings.question_cost.to_string();
            return fault("question_cost", found, "0 to 1,000,000".to_owned());
        }
        check_success_distance(settings.success_distance_m)?;
        let rules = NavigationRules {
            distance_m: [settings.min_distance_m, settings.max_distance_m],
            min_path_ratio: 1.0,
            ends_at_goal: false,
            open_doors: settings.open_doors,
            rewards: settings.reward.clone(),
        };
        rules.check()?;
        Ok((settings, rules))
    }
}
