//! The joints of a world: actuation, motion in a step, and transfer to the state.

mod drive;
mod motors;
mod step;

pub(crate) use drive::{CLOSED_THRESHOLD, OPEN_THRESHOLD};

use crate::body::{self, BodyStatus};
use crate::convert::{from_rapier, to_rapier};
use crate::dynamics::Dynamics;
use crate::joints::{
    self, JointActuation, JointKinematics, KinematicTree, ManualJointDrives, PhysicsJoint,
};
use dwell_scene::{JointId, State};

/// All joints of a world.
#[derive(Clone, Debug, Default)]
pub(crate) struct WorldJoints {
    pub(crate) joints: Vec<PhysicsJoint>,
    /// Kinematic trees of joints that act on each other.
    pub(crate) trees: Vec<KinematicTree>,
    /// Each joint's coordinates within a control step, with the turns of hinges. Between control steps the state holds
    /// them. Shape (joint,).
    pub(crate) joint_coordinates: Vec<JointKinematics>,
    /// The actuation of each joint during this control step. Shape (joint,).
    pub(crate) actuations: Vec<Option<JointActuation>>,
    pub(crate) hand_drives: ManualJointDrives,
}

impl WorldJoints {
    /// Reads the joints' coordinates from the state, at the beginning of a control step.
    pub(crate) fn read_coordinates(&mut self, state: &State) {
        let joints = self.joints.iter();
        self.joint_coordinates = joints
            .map(|joint| joint_from_state(state, joint.id))
            .collect();
    }

    /// Writes the joints' coordinates into the state, at the end of a control step.
    pub(crate) fn write_coordinates(&self, state: &mut State) {
        for (joint, joint_coordinates) in self.joints.iter().zip(&self.joint_coordinates) {
            state.joint_position[joint.id] = joint_coordinates.position as f32;
            state.joint_velocity[joint.id] = joint_coordinates.velocity as f32;
        }
    }

    /// Writes poses, velocities and joints into the state.
    pub(crate) fn write_bodies_and_joints(&self, dynamics: &Dynamics, state: &mut State) {
        for (plan, body) in dynamics.model.bodies.iter().zip(&dynamics.bodies) {
            body::write_parts(&dynamics.engine, plan, body, state);
        }
        for joint in &self.joints {
            let now = joints::coordinates_at_step_start(
                &dynamics.engine,
                joint,
                joint_from_state(state, joint.id),
            );
            let (position, velocity) = (now.position as f32, now.velocity as f32);
            // A latched door is at its closed position, whatever the rounding.
            let shut = dynamics.statuses[joint.child as usize] == BodyStatus::Latched;
            let closed = dynamics.model.house.joints[joint.id].closed;
            state.joint_position[joint.id] = if shut { closed } else { position };
            state.joint_velocity[joint.id] = if shut { 0.0 } else { velocity };
        }
        state.update_switches(&dynamics.model.house);
    }

    /// Moves jointed bodies along with their parents.
    pub(crate) fn move_jointed_bodies(&self, dynamics: &mut Dynamics, state: &State) {
        let stands = self.joints.iter().map(|joint| joints::ImposedJointState {
            position: state.joint_position[joint.id],
            velocity: 0.0,
            force_update: false,
            is_latched: false,
        });
        let stands: Vec<joints::ImposedJointState> = stands.collect();
        for tree in &self.trees {
            let moved = tree.root_body().is_some_and(|body| {
                let body = body as usize;
                let start = to_rapier(&state.part_pose[dynamics.model.bodies[body].root()]);
                body::pose_of(&dynamics.engine, &dynamics.bodies[body]) != Some(from_rapier(&start))
            });
            if moved {
                joints::place_tree(&mut dynamics.engine, &self.joints, tree, &stands);
            }
        }
    }
}

/// Returns a joint's coordinates in the state.
pub(crate) fn joint_from_state(state: &State, joint: JointId) -> JointKinematics {
    JointKinematics {
        position: state.joint_position[joint].into(),
        velocity: state.joint_velocity[joint].into(),
    }
}
