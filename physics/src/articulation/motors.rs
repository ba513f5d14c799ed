//! Motors under laws: their commands and efforts change in every physics step.

use super::WorldJoints;
use crate::dynamics::Dynamics;
use crate::joints::{self, MotorState, motor_command};
use dwell_scene::State;

impl WorldJoints {
    /// Sets the actuation of motors in the next physics step from their commands in this control step.
    pub(crate) fn drive_motors(&mut self, dynamics: &mut Dynamics, state: &State) {
        if dynamics.laws.motors.is_empty() {
            return;
        }
        let house = dynamics.model.house.clone();
        for index in 0..self.joints.len() {
            let joint = self.joints[index];
            let articulation = &house.joints[joint.id];
            if articulation.servo.is_none() {
                continue;
            }
            let now = joints::coordinates_at_step_start(
                &dynamics.engine,
                &joint,
                self.joint_coordinates[index],
            );
            let (position, velocity) = (now.position as f32, now.velocity as f32);
            let motor = MotorState {
                joint: joint.id,
                position,
                velocity,
                dt_s: dynamics.settings.dt_s,
            };
            let mut command = motor_command(state, joint.id);
            for law in &mut dynamics.laws.motors {
                law.effect.modify_command(&motor, &mut command);
            }
            let now = (position, velocity);
            let (mut pull, _) =
                joints::advance(joint.kind, &joint.values, command, None, now, (0.0, 0.0));
            if let Some(pull) = &mut pull {
                for law in &dynamics.laws.motors {
                    law.effect.modify_actuation(joint.id, pull);
                }
            }
            // A motor that is switched off wakes what it held, too.
            if self.actuations[index] != pull {
                joints::wake(&mut dynamics.engine, &joint);
            }
            self.actuations[index] = pull;
        }
    }
}
