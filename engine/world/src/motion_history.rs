//! Poses of a control step ago, for flow, blur and rolling shutters.

use dwell_scene::{AgentId, Id, PartId, Pose, State, math};
use glam::{Quat, Vec3};
use serde::{Deserialize, Serialize};

/// The motion of the last step: what has moved, with its previous pose.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LastStepMotion {
    /// Previous poses of the parts that have moved, by part.
    pub previous_part_poses: Vec<(PartId, Pose)>,
    /// True if there was a step since the world began.
    pub has_step: bool,
    /// The agents' eyes. Shape (agent,); empty before the first step.
    pub previous_eye_poses: Vec<Pose>,
    /// The agents' feet, m. Shape (agent,); empty before the first step.
    pub previous_feet: Vec<Vec3>,
}

impl LastStepMotion {
    /// Records the differences of `before` from `now`.
    pub(crate) fn record(&mut self, before: &PreviousState, now: &State) {
        self.has_step = true;
        self.previous_part_poses.clear();
        let changed = before.parts.iter().zip(now.part_pose.iter_ids());
        let changed = changed.filter(|(was, (_, is))| *was != *is);
        self.previous_part_poses
            .extend(changed.map(|(was, (part, _))| (part, *was)));
        self.previous_eye_poses.clone_from(&before.eyes);
        self.previous_feet.clone_from(&before.feet);
    }

    /// Clears the history.
    pub(crate) fn clear(&mut self) {
        self.has_step = false;
        self.previous_part_poses.clear();
        self.previous_eye_poses.clear();
        self.previous_feet.clear();
    }

    /// Returns the previous pose of an agent's eyes; the current one before the first step.
    pub fn previous_eye_pose(&self, agent: AgentId, now: &State) -> Option<Pose> {
        let is = now.agents.get(agent)?.world_from_eye();
        Some(
            self.previous_eye_poses
                .get(agent.index())
                .copied()
                .unwrap_or(is),
        )
    }

    /// Returns whether nothing but eyes has moved.
    pub(crate) fn is_scene_still(&self, now: &State) -> bool {
        let feet = self.previous_feet.iter().zip(now.agents.iter());
        self.previous_part_poses.is_empty() && feet.into_iter().all(|(was, is)| *was == is.position)
    }

    /// Moves parts and agents of a copy of the present back by the part `share` of a step.
    pub(crate) fn rewind(&self, state: &mut State, share: f32) {
        for (part, was) in &self.previous_part_poses {
            let is = &mut state.part_pose[*part];
            *is = interpolate_back(is, was, share);
        }
        for (was, is) in self.previous_feet.iter().zip(state.agents.iter_mut()) {
            is.position += (*was - is.position) * share;
        }
    }
}

/// The part of the state that is kept while a step is made. Memory is reused from step to step.
#[derive(Clone, Debug, Default)]
pub(crate) struct PreviousState {
    parts: Vec<Pose>,
    eyes: Vec<Pose>,
    feet: Vec<Vec3>,
    /// Agents' positions, m, and headings, rad. Shape (agent,).
    pub(crate) agents: Vec<(Vec3, f32)>,
    /// Positions and velocities of joints. Shape (joint,).
    pub(crate) joints: Vec<(f32, f32)>,
}

impl PreviousState {
    pub(crate) fn capture(&mut self, state: &State) {
        self.parts.clear();
        self.parts.extend(state.part_pose.iter());
        self.eyes.clear();
        self.eyes.extend(
            state
                .agents
                .iter()
                .map(dwell_scene::AgentState::world_from_eye),
        );
        self.feet.clear();
        self.feet
            .extend(state.agents.iter().map(|agent| agent.position));
        self.agents.clear();
        let agents = state.agents.iter();
        self.agents
            .extend(agents.map(|agent| (agent.position, agent.yaw_rad)));
        self.joints.clear();
        let joints = state.joint_position.iter().zip(state.joint_velocity.iter());
        self.joints
            .extend(joints.map(|(position, velocity)| (*position, *velocity)));
    }
}

/// The pose the part `share` of the way from `is` back to `was`, along a straight line and about one axis; beyond 1 further back.
pub(crate) fn interpolate_back(is: &Pose, was: &Pose, share: f32) -> Pose {
    let mut turn = is.rotation.inverse() * was.rotation;
    if turn.w < 0.0 {
        turn = -turn;
    }
    let axis = Vec3::new(turn.x, turn.y, turn.z);
    let sine = axis.length();
    let half_angle = math::atan2(sine, turn.w) * share;
    let rotation = if sine > 0.0 {
        let (part, cosine) = math::sin_cos(half_angle);
        let axis = axis * (part / sine);
        is.rotation * Quat::from_xyzw(axis.x, axis.y, axis.z, cosine)
    } else {
        is.rotation
    };
    Pose::new(
        is.position + (was.position - is.position) * share,
        rotation.normalize(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::space::rotation_from_yaw_pitch;

    #[test]
    fn halfway_back_is_half_the_turn_and_half_the_way() {
        let is = Pose::new(Vec3::new(1.0, 2.0, 3.0), rotation_from_yaw_pitch(0.8, 0.0));
        let was = Pose::new(Vec3::new(0.0, 2.0, 5.0), rotation_from_yaw_pitch(0.2, 0.0));
        for (share, yaw, x) in [
            (0.0, 0.8, 1.0),
            (0.5, 0.5, 0.5),
            (1.0, 0.2, 0.0),
            (2.0, -0.4, -1.0),
        ] {
            let pose = interpolate_back(&is, &was, share);
            let expected = rotation_from_yaw_pitch(yaw, 0.0);
            assert!(pose.rotation.dot(expected).abs() > 1.0 - 1e-6, "{share}");
            assert!((pose.position.x - x).abs() < 1e-6);
        }
        assert!(interpolate_back(&is, &is, 0.7).rotation.dot(is.rotation) > 1.0 - 1e-6);
    }
}
