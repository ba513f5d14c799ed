//! Laws of wheeled bases.

use super::WheelMotion;
use dwell_scene::AgentId;
use std::fmt::Debug;

/// A law that changes how a base moves, or what it measures of that.
pub(crate) trait BaseLaw: Debug + Send + Sync {
    /// Changes how the two wheels of an agent's differential drive roll in one physics step.
    fn roll(&self, _agent: AgentId, _rolling: &mut WheelMotion) {}

    /// Returns what the gyro of an agent's base reads when it turns with `rate_rad_s`.
    fn gyro(&self, _agent: AgentId, rate_rad_s: f32) -> f32 {
        rate_rad_s
    }
}
