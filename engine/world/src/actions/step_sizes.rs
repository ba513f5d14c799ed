//! Step sizes of the movement actions.

use super::DiscreteAction;
use crate::error::WorldError;
use dwell_scene::AgentState;
use dwell_scene::space::forward_from_yaw;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Step sizes of the movement actions in one control step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct StepSizes {
    /// m a step; 0.001 to 1, default 0.1 (2 m/s at 20 Hz).
    pub forward_m: f32,
    /// Degrees a step; 0.1 to 180, default 9 (180 degrees/s at 20 Hz).
    pub turn_deg: f32,
    /// Degrees a step; 0.1 to 90, default 9.
    pub look_deg: f32,
}

impl Default for StepSizes {
    fn default() -> Self {
        Self {
            forward_m: 0.1,
            turn_deg: 9.0,
            look_deg: 9.0,
        }
    }
}

impl StepSizes {
    /// An agent after a step, a turn or a tilt that nothing stops; as it is after any other action.
    pub(crate) fn after(&self, agent: &AgentState, action: DiscreteAction) -> AgentState {
        let mut after = *agent;
        match action {
            DiscreteAction::MoveForward => {
                after.position += self.forward_m * forward_from_yaw(agent.yaw_rad);
            }
            DiscreteAction::TurnLeft => after.yaw_rad += self.turn_deg.to_radians(),
            DiscreteAction::TurnRight => after.yaw_rad -= self.turn_deg.to_radians(),
            DiscreteAction::LookUp => after.pitch_rad += self.look_deg.to_radians(),
            DiscreteAction::LookDown => after.pitch_rad -= self.look_deg.to_radians(),
            _ => {}
        }
        after
    }

    /// Checks every range.
    ///
    /// # Errors
    /// [`WorldError::Config`] names the field.
    pub fn check(&self) -> Result<(), WorldError> {
        let range = |field: &'static str, value: f32, low: f32, high: f32| {
            if (low..=high).contains(&value) {
                return Ok(());
            }
            Err(WorldError::Config {
                field,
                found: value.to_string(),
                allowed: format!("{low} to {high}"),
            })
        };
        range("forward_m", self.forward_m, 0.001, 1.0)?;
        range("turn_deg", self.turn_deg, 0.1, 180.0)?;
        range("look_deg", self.look_deg, 0.1, 90.0)
    }
}

/// The velocity that turns by `degrees` within `step_s`.
pub(super) fn turn_rate_rad_s(degrees: f32, step_s: f64) -> f32 {
    (f64::from(degrees).to_radians() / step_s) as f32
}
