//! State of agents.

use super::AgentBody;
use crate::ids::ObjectId;
use crate::space::{Pose, rotation_from_yaw_pitch};
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// The state of a base: its wheels and its odometry.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BaseState {
    /// Speeds of the left and right wheel, rad/s; 0 without wheels.
    pub wheel_rad_s: [f32; 2],
    /// Rotation of the left and right wheel since the agent was placed, rad, as their encoders count.
    pub wheel_rotation_rad: [f64; 2],
    /// Twist that its wheels would give it without slip: m/s forward, m/s to the left, rad/s to the left.
    pub twist: [f32; 3],
    /// Odometry from its wheels and nominal geometry: m forward and m to the left of its initial position, and rad to the
    /// left.
    pub odometry: [f64; 3],
    /// Rounding remainder of its motion so far: m along X and Z, rad.
    pub rounding_remainder: [f32; 3],
}

/// The state of one agent.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AgentState {
    /// Its body.
    pub body: AgentBody,
    /// The point between its feet, m.
    pub position: Vec3,
    /// Heading, rad, positive to the left.
    pub yaw_rad: f32,
    /// Pitch of the view, rad, positive up.
    pub pitch_rad: f32,
    /// m/s.
    pub velocity: Vec3,
    /// True if it stood on something at the end of the last step.
    pub grounded: bool,
    /// True if its movement was cut short in the last step.
    pub collided: bool,
    /// The held object.
    pub holding: Option<ObjectId>,
    /// Present reduction of its body's height, m: more than 0 while it crouches.
    pub crouched_by_m: f32,
    /// Yaw rate as its gyro reads it, rad/s, positive to the left: the mean over the last control step.
    pub gyro_rad_s: f32,
    /// The state of its base, if it has one.
    pub base: BaseState,
}

impl AgentState {
    /// An agent at `position` with heading `yaw_rad`.
    pub fn new(body: AgentBody, position: Vec3, yaw_rad: f32) -> Self {
        Self {
            body,
            position,
            yaw_rad,
            pitch_rad: 0.0,
            velocity: Vec3::ZERO,
            grounded: true,
            collided: false,
            holding: None,
            crouched_by_m: 0.0,
            gyro_rad_s: 0.0,
            base: BaseState::default(),
        }
    }

    /// Returns its present height, m.
    pub fn height_m(&self) -> f32 {
        self.body.height_m - self.crouched_by_m
    }

    /// Returns the present height of eyes and ears above the feet, m.
    pub fn eye_height_m(&self) -> f32 {
        (self.body.eye_height_m - self.crouched_by_m).max(0.0)
    }

    /// Returns the pose of its eyes: a camera at this pose has its view.
    pub fn world_from_eye(&self) -> Pose {
        Pose::new(
            self.eye_position(),
            rotation_from_yaw_pitch(self.yaw_rad, self.pitch_rad),
        )
    }

    /// Returns the pose of its head for its ears: at the eyes' height, turned with the body, upright.
    pub fn world_from_head(&self) -> Pose {
        Pose::from_position_yaw(self.eye_position(), self.yaw_rad)
    }

    /// Returns the position of its eyes, m.
    pub fn eye_position(&self) -> Vec3 {
        self.position + Vec3::Y * self.eye_height_m()
    }
}
