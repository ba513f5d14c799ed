//! Turning to the right.

use super::kind::{ActionKind, movement};
use super::step_sizes::{StepSizes, turn_rate_rad_s};
use dwell_physics::AgentControl;

pub(super) const KIND: ActionKind = movement("turn_right", "Turns to the right.", control);

fn control(stride: &StepSizes, step_s: f64) -> AgentControl {
    AgentControl {
        yaw_rate_rad_s: -turn_rate_rad_s(stride.turn_deg, step_s),
        ..AgentControl::default()
    }
}
