//! Settings of the task.

use crate::error::WorldError;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The task's settings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub(super) struct CarrySettings {
    /// The least distance of the goal from where the thing stands, straight m, 0.4 to 20; default 1.
    pub(super) min_distance_m: f32,
    /// The greatest, straight m, at least `min_distance_m`, at most 20; default 4.
    pub(super) max_distance_m: f32,
    /// Success within this level distance of the goal, m, above 0 to 2; default 0.25.
    pub(super) success_distance_m: f32,
    /// Success within this turn from the goal, degrees, above 0 to 180; default 15.
    pub(super) success_angle_deg: f32,
}

impl Default for CarrySettings {
    fn default() -> Self {
        Self {
            min_distance_m: 1.0,
            max_distance_m: 4.0,
            success_distance_m: 0.25,
            success_angle_deg: 15.0,
        }
    }
}

impl CarrySettings {
    /// # Errors
    /// [`WorldError::Config`] names the setting.
    pub(super) fn check(&self) -> Result<(), WorldError> {
        let fault = |field: &'static str, found: f32, allowed: String| {
            Err(WorldError::Config {
                field,
                found: found.to_string(),
                allowed,
            })
        };
        let least_m = self.min_distance_m;
        if !(0.4..=20.0).contains(&least_m) {
            return fault("min_distance_m", least_m, "0.4 to 20".to_owned());
        }
        if !(least_m..=20.0).contains(&self.max_distance_m) {
            let allowed = format!("min_distance_m, {least_m}, to 20");
            return fault("max_distance_m", self.max_distance_m, allowed);
        }
        let near_m = self.success_distance_m;
        if !(near_m > 0.0 && near_m <= 2.0) {
            return fault("success_distance_m", near_m, "above 0 to 2".to_owned());
        }
        let turn_deg = self.success_angle_deg;
        if !(turn_deg > 0.0 && turn_deg <= 180.0) {
            return fault("success_angle_deg", turn_deg, "above 0 to 180".to_owned());
        }
        Ok(())
    }
}
