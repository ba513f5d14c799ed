//! Settings that all tasks of navigation have: where episodes start, how they end, and what is paid.

use crate::actions::DiscreteAction;
use crate::episode::StepResult;
use crate::error::WorldError;
use crate::tasks::{TaskSetup, door_leaves};
use crate::world::World;
use dwell_scene::navigation::NavGrid;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Rewards of a step.
///
/// # Source
/// Defaults of habitat-lab's `RLTask`: the decrease of the geodesic distance, 2.5 for success, -0.01 a step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub(in crate::tasks) struct NavigationRewards {
    /// For each metre by which the geodesic distance to the goal fell; default 1. With 0 the reward is sparse.
    pub(in crate::tasks) distance: f64,
    /// For success; default 2.5.
    pub(in crate::tasks) success: f64,
    /// For every step; default -0.01.
    pub(in crate::tasks) step: f64,
    /// For `stop` anywhere but at the goal; default 0.
    pub(in crate::tasks) wrong_stop: f64,
    /// For a step that was cut short by something in the way; default 0.
    pub(in crate::tasks) collision: f64,
}

impl Default for NavigationRewards {
    fn default() -> Self {
        Self {
            distance: 1.0,
            success: 2.5,
            step: -0.01,
            wrong_stop: 0.0,
            collision: 0.0,
        }
    }
}

/// The rules of an episode: where it starts, how it ends, what is paid.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::tasks) struct NavigationRules {
    /// Nearest and furthest start, geodesic m.
    pub(in crate::tasks) distance_m: [f64; 2],
    /// Least ratio of the geodesic distance to the straight one.
    pub(in crate::tasks) min_path_ratio: f64,
    /// True if reaching the goal ends the episode, without `stop`.
    pub(in crate::tasks) ends_at_goal: bool,
    /// Whether all doors stand open at the start; `None`: where the agent has no hand to open them.
    pub(in crate::tasks) open_doors: Option<bool>,
    pub(in crate::tasks) rewards: NavigationRewards,
}

impl NavigationRules {
    /// Opens the doors of an episode that is about to begin, where they stand open at its start.
    pub(in crate::tasks) fn arrange_doors(
        &self,
        world: &mut World,
        grid: &NavGrid,
        setup: &TaskSetup,
    ) -> Result<(), WorldError> {
        if self
            .open_doors
            .unwrap_or(!setup.actions.contains(DiscreteAction::Open))
        {
            door_leaves::open_all(world, grid)?;
        }
        Ok(())
    }

    /// What a step is paid, and whether it ends the episode. `gain_m`: by how much the distance fell; `stops`: whether the agent
    /// called `stop`; `is_reached`: whether it has done what is asked, which is looked at where it counts.
    pub(in crate::tasks) fn step_result(
        &self,
        (gain_m, collided): (f64, bool),
        stops: bool,
        is_reached: impl FnOnce() -> bool,
    ) -> StepResult {
        let pay = &self.rewards;
        let success = (stops || self.ends_at_goal) && is_reached();
        let mut reward = pay.distance * gain_m + pay.step;
        if collided {
            reward += pay.collision;
        }
        if success {
            reward += pay.success;
        } else if stops {
            reward += pay.wrong_stop;
        }
        StepResult {
            reward,
            terminated: stops || success,
            success,
        }
    }

    /// Returns whether an episode may start where the walkable way to the goal is `way_m` and the straight one as `straight_m` says.
    pub(in crate::tasks) fn allow_start(
        &self,
        way_m: f64,
        straight_m: impl FnOnce() -> f64,
    ) -> bool {
        let [least, most] = self.distance_m;
        (least..=most).contains(&way_m)
            && (self.min_path_ratio <= 1.0 || way_m >= self.min_path_ratio * straight_m())
    }

    /// Refuses numbers that no episode can keep to.
    pub(in crate::tasks) fn check(&self) -> Result<(), WorldError> {
        let fault = |field: &'static str, found: f64, allowed: String| {
            Err(WorldError::Config {
                field,
                found: found.to_string(),
                allowed,
            })
        };
        let [least, most] = self.distance_m;
        if !(0.0..=1e6).contains(&most) {
            return fault("max_distance_m", most, "0 to 1,000,000".to_owned());
        }
        if !(0.0..=most).contains(&least) {
            let allowed = if least < 0.0 || least.is_nan() {
                "0 or more".to_owned()
            } else {
                format!("at most max_distance_m, which is {most}")
            };
            return fault("min_distance_m", least, allowed);
        }
        if !(1.0..=100.0).contains(&self.min_path_ratio) {
            return fault("min_path_ratio", self.min_path_ratio, "1 to 100".to_owned());
        }
        let NavigationRewards {
            distance,
            success,
            step,
            wrong_stop,
            collision,
        } = self.rewards;
        for (field, value) in [
            ("reward.distance", distance),
            ("reward.success", success),
            ("reward.step", step),
            ("reward.wrong_stop", wrong_stop),
            ("reward.collision", collision),
        ] {
            if value.is_nan() || value.abs() > 1e6 {
                return fault(field, value, "-1,000,000 to 1,000,000".to_owned());
            }
        }
        Ok(())
    }
}

/// Declares the settings of a task: its own fields, and those of [`NavigationRules`].
macro_rules! navigation_settings {
    (
        $(#[$meta:meta])*
        $vis:vis $name:ident {
            $($(#[$field_meta:meta])* $field:ident: $type:ty = $default:expr,)*
        }
    ) => {
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
        #[serde(default, deny_unknown_fields)]
        $vis struct $name {
            $($(#[$field_meta])* $vis $field: $type,)*
            /// The nearest a start may lie to the goal, geodesic m; default 1.
            $vis min_distance_m: f64,
            /// The furthest, m; default 30.
            $vis max_distance_m: f64,
            /// The least ratio of the geodesic distance at the start to the straight one, 1 to 100; default 1. Above 1 no goal lies
            /// straight ahead.
            $vis min_path_ratio: f64,
            /// Whether the episode ends in success as soon as the goal is reached, without `stop`; default false.
            $vis ends_at_goal: bool,
            /// Whether all doors stand open at the start; default where the agent has no action `open`.
            $vis open_doors: Option<bool>,
            /// What a step is paid: `distance` (a metre nearer; default 1), `success` (default 2.5), `step` (default -0.01),
            /// `wrong_stop` and `collision` (default 0).
            $vis reward: $crate::tasks::navigation::NavigationRewards,
        }

        impl Default for $name {
            fn default() -> Self {
                Self {
                    $($field: $default,)*
                    min_distance_m: 1.0,
                    max_distance_m: 30.0,
                    min_path_ratio: 1.0,
                    ends_at_goal: false,
                    open_doors: None,
                    reward: Default::default(),
                }
            }
        }

        impl $name {
            /// Reads settings (`null` gives the defaults), and checks what all tasks of navigation share.
            fn parse(
                value: &serde_json::Value,
            ) -> Result<(Self, $crate::tasks::navigation::NavigationRules), $crate::error::WorldError> {
                let settings: Self = $crate::parse_settings::parse_task_settings(value)?;
                let rules = $crate::tasks::navigation::NavigationRules {
                    distance_m: [settings.min_distance_m, settings.max_distance_m],
                    min_path_ratio: settings.min_path_ratio,
                    ends_at_goal: settings.ends_at_goal,
                    open_doors: settings.open_doors,
                    rewards: settings.reward.clone(),
                };
                rules.check()?;
                Ok((settings, rules))
            }
        }
    };
}
pub(in crate::tasks) use navigation_settings;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_no_episode_can_keep_to_are_refused() {
        let rules = NavigationRules {
            distance_m: [3.0, 3.0],
            min_path_ratio: 1.0,
            ends_at_goal: false,
            open_doors: None,
            rewards: NavigationRewards::default(),
        };
        rules.check().unwrap();
        let told = |change: fn(&mut NavigationRules)| {
            let mut other = rules.clone();
            change(&mut other);
            other.check().unwrap_err().to_string()
        };
        assert_eq!(
            told(|rules| rules.distance_m = [5.0, 2.0]),
            "min_distance_m is 5; allowed is at most max_distance_m, which is 2"
        );
        assert_eq!(
            told(|rules| rules.distance_m = [-1.0, 2.0]),
            "min_distance_m is -1; allowed is 0 or more"
        );
        assert!(told(|rules| rules.distance_m[1] = f64::NAN).starts_with("max_distance_m is NaN"));
        assert!(told(|rules| rules.min_path_ratio = 0.5).starts_with("min_path_ratio is 0.5"));
        assert!(told(|rules| rules.rewards.step = f64::INFINITY).starts_with("reward.step is inf"));
    }
}
