//! Walking forward.

use super::kind::{ActionKind, movement};
use super::step_sizes::StepSizes;
use dwell_physics::AgentControl;

pub(super) const KIND: ActionKind = movement("move_forward", "Walks forward.", control);

fn control(stride: &StepSizes, step_s: f64) -> AgentControl {
    AgentControl {
        forward_m_s: (f64::from(stride.forward_m) / step_s) as f32,
        ..AgentControl::default()
    }
}
