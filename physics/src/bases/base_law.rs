//! Laws of wheeled bases.

use super::WheelMotion;
use dwell_scene::AgentId;
use std::fmt::Debug;

/// A law that changes the motion of a base, or its measurement.
pub(crate) trait BaseLaw: Debug + Send + Sync {
    /// Changes the rolling of the two wheels of an agent's differential drive in one physics step.
    fn modify_wheel_motion(&self, _agent: AgentId, _rolling: &mut WheelMotion) {}

    /// Returns the gyro reading of an agent's base at a yaw rate of `rate_rad_s`.
    fn gyro_reading(&self, _agent: AgentId, rate_rad_s: f32) -> f32 {
        rate_rad_s
    }
}
