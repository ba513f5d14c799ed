//! Control inputs of an agent's body.

use crate::error::PhysicsError;
use dwell_scene::{AgentState, Locomotion};
use glam::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Largest pitch of an agent's view up or down, rad.
pub(crate) const STEEPEST_LOOK_RAD: f32 = 1.5;

/// Highest commanded speed of a body, m/s and rad/s: beyond it squares of speeds overflow. Bodies stay within their own
/// limits, whatever the command.
const FASTEST: f32 = 1e6;

/// The control input of an agent's body for one control step: constant velocities in its own frame.
///
/// A displacement of `d` metres in a control step is a velocity of `d * control_rate_hz`. An agent on legs has these
/// velocities at once, up to its speed limit; wheels accelerate towards them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct AgentControl {
    /// m/s along its heading; negative: backwards.
    pub forward_m_s: f32,
    /// m/s to its right; negative: to its left. Not for a differential drive.
    pub right_m_s: f32,
    /// rad/s, positive to the left.
    pub yaw_rate_rad_s: f32,
    /// rad/s, positive up; the pitch stays within 1.5 rad.
    pub pitch_rate_rad_s: f32,
    /// Speeds of the left and right wheel of a differential drive, rad/s, instead of the velocities above.
    pub wheel_rad_s: Option<[f32; 2]>,
    /// Makes an agent on legs crouch; without it the agent stands up again where there is room.
    pub crouch: bool,
}

impl AgentControl {
    /// Returns all numbers with their fields.
    fn numbers(&self) -> [(&'static str, f32); 6] {
        let [left, right] = self.wheel_rad_s.unwrap_or_default();
        [
            ("forward_m_s", self.forward_m_s),
            ("right_m_s", self.right_m_s),
            ("yaw_rate_rad_s", self.yaw_rate_rad_s),
            ("pitch_rate_rad_s", self.pitch_rate_rad_s),
            ("wheel_rad_s", left),
            ("wheel_rad_s", right),
        ]
    }

    /// Checks that a body with this locomotion can follow the control.
    pub(crate) fn check(&self, index: usize, locomotion: &Locomotion) -> Result<(), PhysicsError> {
        let refuse = |field: &'static str, found: String, allowed: &'static str| {
            Err(PhysicsError::Range {
                at: format!("control of agent {index} ({})", locomotion.name()),
                field,
                found,
                allowed,
            })
        };
        for (field, speed) in self.numbers() {
            // Not "above", so that NaN is refused too.
            if !(-FASTEST..=FASTEST).contains(&speed) {
                let allowed = "finite numbers, at most 1e6 m/s or rad/s either way";
                return refuse(field, speed.to_string(), allowed);
            }
        }
        let drive = matches!(locomotion, Locomotion::DifferentialDrive(_));
        if let Some(rates) = self.wheel_rad_s {
            let found = format!("{rates:?}");
            if !drive {
                return refuse("wheel_rad_s", found, "nothing: it has no such wheels");
            }
            if self.forward_m_s != 0.0 || self.yaw_rate_rad_s != 0.0 {
                return refuse(
                    "wheel_rad_s",
                    found,
                    "either wheel speeds or forward_m_s and yaw_rate_rad_s, not both",
                );
            }
        }
        if drive && self.right_m_s != 0.0 {
            let found = self.right_m_s.to_string();
            return refuse("right_m_s", found, "0: its wheels do not go sideways");
        }
        if self.crouch && !matches!(locomotion, Locomotion::Walking(_)) {
            return refuse("crouch", "true".to_owned(), "false: it has no legs");
        }
        Ok(())
    }

    /// Turns an agent by this control for `dt_s` seconds. Returns the angle, rad.
    pub(crate) fn apply_yaw(&self, agent: &mut AgentState, dt_s: f32) -> f32 {
        let turn = self.yaw_rate_rad_s * dt_s;
        if self.yaw_rate_rad_s != 0.0 {
            agent.yaw_rad = dwell_scene::math::wrap_angle(agent.yaw_rad + turn);
        }
        turn
    }

    /// Pitches an agent's view up or down for `dt_s` seconds.
    pub(crate) fn pitch_view(&self, agent: &mut AgentState, dt_s: f32) {
        let pitch = agent.pitch_rad + self.pitch_rate_rad_s * dt_s;
        agent.pitch_rad = pitch.clamp(-STEEPEST_LOOK_RAD, STEEPEST_LOOK_RAD);
    }

    /// The displacement in world space in `dt_s` seconds, m.
    pub(crate) fn displacement(&self, yaw_rad: f32, dt_s: f32) -> Vec3 {
        let forward = dwell_scene::space::forward_from_yaw(yaw_rad);
        let right = Vec3::new(-forward.z, 0.0, forward.x);
        (forward * self.forward_m_s + right * self.right_m_s) * dt_s
    }
}
