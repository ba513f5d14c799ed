//! Looking down.

use super::kind::{ActionKind, movement};
use super::step_sizes::{StepSizes, turn_rate_rad_s};
use dwell_physics::AgentControl;

pub(super) const KIND: ActionKind = movement("look_down", "Looks down.", control);

fn control(stride: &StepSizes, step_s: f64) -> AgentControl {
    AgentControl {
        pitch_rate_rad_s: -turn_rate_rad_s(stride.look_deg, step_s),
        ..AgentControl::default()
    }
}
