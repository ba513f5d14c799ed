//! Laws of motors: changes of the command that a motor follows, and of its effort.

use super::JointActuation;
use dwell_scene::{JointCommand, JointId, State};
use std::fmt::Debug;

/// The state of a motor's or joint's law between steps.
pub(crate) trait StatefulLaw {
    /// Notes that a joint was set to `position` (rad or m) from outside, which is no motion.
    fn on_joint_set(&mut self, _joint: JointId, _position: f32) {}

    /// Returns its state, for snapshots.
    fn state(&self) -> Vec<f32> {
        Vec::new()
    }

    /// Restores the state from [`LawMemory::memory`].
    fn restore_state(&mut self, _memory: &[f32]) {}
}

/// A law that changes motors in each physics step.
pub(crate) trait MotorLaw: StatefulLaw + Debug + Send + Sync {
    /// Changes the command that a joint's motor follows in one physics step. It is called for every motor in every step.
    fn modify_command(&mut self, _motor: &MotorState, _command: &mut JointCommand) {}

    /// Changes the actuation by a joint's motor for its command in one physics step.
    fn modify_actuation(&self, _joint: JointId, _pull: &mut JointActuation) {}

    /// Returns a copy.
    fn clone_box(&self) -> Box<dyn MotorLaw>;
}

impl Clone for Box<dyn MotorLaw> {
    fn clone(&self) -> Self {
        self.clone_box()
    }
}

/// A joint with a motor before a physics step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MotorState {
    pub(crate) joint: JointId,
    /// rad or m.
    pub(crate) position: f32,
    /// rad/s or m/s.
    pub(crate) velocity: f32,
    /// Length of the step, s.
    pub(crate) dt_s: f32,
}

impl MotorState {
    /// Returns the value of a command of this kind that keeps the present state.
    pub(crate) fn holding_value(&self, command: JointCommand) -> f32 {
        match command {
            JointCommand::Position(_) => self.position,
            JointCommand::Velocity(_) => self.velocity,
            JointCommand::Effort(_) | JointCommand::Off => 0.0,
        }
    }
}

/// Returns the command of a joint's motor in this control step.
pub(crate) fn motor_command(state: &State, joint: JointId) -> JointCommand {
    let command = state.joint_command[joint];
    if command.is_finite() {
        command
    } else {
        JointCommand::Off
    }
}
