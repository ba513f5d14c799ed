//! Joint actuation: servos, or a hand that opens and closes a joint.

use super::effort_term::{ActuationGain, JointActuation};
use super::latch::closed_tolerance;
use dwell_scene::{AgentId, JointCommand, JointId, JointKind, JointParameters};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Lowest natural frequency of the hand's pull, rad/s.
const HAND_FREQUENCY_RAD_S: f32 = 12.0;
/// Speed at which a hand swings a door, rad/s.
const HAND_SWING_RAD_S: f32 = 1.5;
/// Speed at which a hand pulls a drawer, m/s.
const HAND_PULL_M_S: f32 = 0.5;
/// Largest lead of the hand over a joint that does not follow, rad or m.
const HAND_LEAD: [f32; 2] = [0.3, 0.1];
/// Speed under which a joint makes no progress, rad/s or m/s.
const STALL_SPEED: f32 = 0.02;
/// Speed under which a joint that reaches its stop has arrived, rad/s or m/s.
const ARRIVAL_SPEED: f32 = 0.2;
/// Time without progress after which the hand gives up while it pulls at full lead, s.
const STALL_TIMEOUT_S: f32 = 0.4;

/// A hand that moves a joint.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct ManualJointDrive {
    /// Goal position of the joint.
    pub(crate) goal: f32,
    /// Present position of the hand.
    ramp: f32,
    /// Time without motion, s.
    stalled_s: f32,
    /// The agent that pulls, if any.
    pub(crate) agent: Option<AgentId>,
}

/// All hands on joints.
pub(crate) type ManualJointDrives = BTreeMap<JointId, ManualJointDrive>;

/// The state of a drive after a control step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum DriveProgress {
    Moving,
    Arrived,
    Blocked,
}

fn speed_and_lead(kind: JointKind) -> (f32, f32) {
    match kind {
        JointKind::Hinge => (HAND_SWING_RAD_S, HAND_LEAD[0]),
        JointKind::Slide => (HAND_PULL_M_S, HAND_LEAD[1]),
    }
}

impl ManualJointDrive {
    pub(crate) fn new(goal: f32, position: f32, agent: Option<AgentId>) -> Self {
        Self {
            goal,
            ramp: position,
            stalled_s: 0.0,
            agent,
        }
    }

    /// Advances the hand by one control step and updates the drive's state.
    fn follow(
        &mut self,
        kind: JointKind,
        limits: Option<[f32; 2]>,
        (position, velocity): (f32, f32),
        step_s: f32,
    ) -> DriveProgress {
        let (rate, lead) = speed_and_lead(kind);
        let left = (position - self.goal).abs();
        // A joint that stays half open must be at rest before the hand lets go, or it would coast on.
        let slow = if limits.is_some_and(|limits| limits.contains(&self.goal)) {
            ARRIVAL_SPEED
        } else {
            STALL_SPEED
        };
        if left <= closed_tolerance(kind) && velocity.abs() < slow {
            return DriveProgress::Arrived;
        }
        let stride = rate * step_s;
        let stands = velocity.abs() < STALL_SPEED;
        let onward = (self.goal - position).signum();
        let short = (self.goal - self.ramp) * onward > stride;
        if short || stands {
            // Where friction holds it short of the goal, the hand pulls further than the goal.
            self.ramp += stride * onward;
        } else {
            self.ramp = self.goal;
        }
        self.ramp = self.ramp.clamp(position - lead, position + lead);
        // A light lid with much friction follows the hand but has no velocity at the end of a step: progress is judged by
        // its position.
        let strains = (self.ramp - position).abs() > 0.99 * lead;
        if stands && strains {
            self.stalled_s += step_s;
        } else {
            self.stalled_s = 0.0;
        }
        if self.stalled_s >= STALL_TIMEOUT_S {
            DriveProgress::Blocked
        } else {
            DriveProgress::Moving
        }
    }
}

/// Returns the actuation of a joint during the next control step, and the state of its hand. `values`: the joint's
/// parameters in force; `command`: its command; `hand`: the hand that moves a joint without a servo.
pub(crate) fn advance(
    kind: JointKind,
    values: &JointParameters,
    command: JointCommand,
    hand: Option<&mut ManualJointDrive>,
    (position, velocity): (f32, f32),
    (step_s, hand_effort): (f32, f32),
) -> (Option<JointActuation>, Option<DriveProgress>) {
    if let Some(servo) = &values.servo {
        let (target, gain) = match command {
            JointCommand::Off => return (None, None),
            JointCommand::Position(target) => {
                let (stiffness, damping) = (servo.stiffness, servo.damping);
                (
                    values.clamp(target),
                    ActuationGain::Servo { stiffness, damping },
                )
            }
            JointCommand::Velocity(target) => {
                (target, ActuationGain::Velocity(servo.velocity_gain))
            }
            JointCommand::Effort(target) => (target, ActuationGain::Effort),
        };
        let max_effort = servo.max_joint_effort();
        let pull = JointActuation {
            target,
            max_effort,
            max_velocity: servo.max_joint_speed(),
            gravity_compensation: if gain == ActuationGain::Effort {
                0.0
            } else {
                values.feed_forward
            },
            gain,
        };
        return (Some(pull), None);
    }
    let Some(hand) = hand else {
        return (None, None);
    };
    let progress = hand.follow(kind, values.limits, (position, velocity), step_s);
    let pull = (progress == DriveProgress::Moving).then_some(JointActuation {
        target: hand.ramp,
        max_effort: hand_effort,
        max_velocity: f32::INFINITY,
        gravity_compensation: 0.0,
        gain: ActuationGain::Hand {
            frequency_rad_s: HAND_FREQUENCY_RAD_S,
            lead: speed_and_lead(kind).1,
        },
    });
    (pull, Some(progress))
}
