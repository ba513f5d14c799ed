//! Motors under laws: what they follow and give changes in every physics step.

use crate::joints;
use crate::laws::{InstalledLaw, MotorStep};
use crate::world::PhysicsWorld;
use dwell_scene::{JointCommand, JointId, State};

/// Returns whether a law changes what motors do between control steps.
pub(crate) fn are_driven(laws: &[InstalledLaw]) -> bool {
    laws.iter().any(|installed| installed.law.drives())
}

/// Returns what a joint's motor is told in this control step.
pub(crate) fn commanded(state: &State, joint: JointId) -> JointCommand {
    let command = state.joint_command[joint];
    if command.is_finite() {
        command
    } else {
        JointCommand::Off
    }
}

impl PhysicsWorld {
    /// Sets what motors do in the next physics step from what they are told in this control step.
    pub(crate) fn drive_motors(&mut self, state: &State) {
        if !are_driven(&self.laws) {
            return;
        }
        let house = self.model.house.clone();
        for index in 0..self.joints.len() {
            let joint = self.joints[index];
            let articulation = &house.joints[joint.id];
            if articulation.servo.is_none() {
                continue;
            }
            let now = joints::stands(&self.engine, &joint, self.joint_coordinates[index]);
            let (position, velocity) = (now.position as f32, now.velocity as f32);
            let motor = MotorStep {
                joint: joint.id,
                position,
                velocity,
                dt_s: self.settings.dt_s,
            };
            let mut command = commanded(state, joint.id);
            for installed in &mut self.laws {
                installed.law.drive(&motor, &mut command);
            }
            let now = (position, velocity);
            let (mut pull, _) =
                joints::advance(joint.kind, &joint.values, command, None, now, (0.0, 0.0));
            if let Some(pull) = &mut pull {
                for installed in &self.laws {
                    installed.law.modify_motor(joint.id, pull);
                }
            }
            // One that lets go wakes what it held, too.
            if self.pulls[index] != pull {
                joints::wake(&mut self.engine, &joint);
            }
            self.pulls[index] = pull;
        }
    }
}
