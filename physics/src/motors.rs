//! Motors under laws: what they follow and give changes in every physics step.

use crate::joints::{self, MotorStep, commanded};
use crate::world::PhysicsWorld;
use dwell_scene::State;

impl PhysicsWorld {
    /// Sets what motors do in the next physics step from what they are told in this control step.
    pub(crate) fn drive_motors(&mut self, state: &State) {
        if self.laws.motors.is_empty() {
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
            for law in &mut self.laws.motors {
                law.effect.drive(&motor, &mut command);
            }
            let now = (position, velocity);
            let (mut pull, _) =
                joints::advance(joint.kind, &joint.values, command, None, now, (0.0, 0.0));
            if let Some(pull) = &mut pull {
                for law in &self.laws.motors {
                    law.effect.modify_motor(joint.id, pull);
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
