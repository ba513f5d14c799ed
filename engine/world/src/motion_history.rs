//! Poses of a control step ago, for flow, blur and rolling shutters.

use dwell_scene::person::{person_pieces, skeleton_of};
use dwell_scene::{AgentId, House, Id, PartId, Pose, State, math};
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
    /// Previous poses of the pieces of agents that are persons and have moved. Shape of each (piece,).
    pub previous_persons: Vec<(AgentId, Vec<Pose>)>,
    /// Poses of the pieces of all persons at the end of the last step, or where they were placed: gestures come later.
    pub(crate) shown_persons: Vec<(AgentId, Vec<Pose>)>,
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

    /// Records what the figures of persons do in a step.
    pub(crate) fn record_persons(&mut self, house: &House, now: &State) {
        if now.persons.is_empty() && self.shown_persons.is_empty() {
            return;
        }
        let shown = figures(house, now);
        let before = std::mem::replace(&mut self.shown_persons, shown);
        let moved = |person: &(AgentId, Vec<Pose>)| !self.shown_persons.contains(person);
        self.previous_persons = before.into_iter().filter(moved).collect();
    }

    /// Takes the figures of persons as they are for those from which the next step begins.
    pub(crate) fn begin_persons(&mut self, house: &House, now: &State) {
        self.shown_persons = figures(house, now);
    }

    /// Clears the history.
    pub(crate) fn clear(&mut self) {
        self.has_step = false;
        self.previous_part_poses.clear();
        self.previous_eye_poses.clear();
        self.previous_feet.clear();
        self.previous_persons.clear();
        self.shown_persons.clear();
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
        self.previous_part_poses.is_empty()
            && self.previous_persons.is_empty()
            && feet.into_iter().all(|(was, is)| *was == is.position)
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

/// The poses of the pieces of all persons.
fn figures(house: &House, state: &State) -> Vec<(AgentId, Vec<Pose>)> {
    let persons = state.persons.keys();
    let figure = |agent: &AgentId| {
        let joints = skeleton_of(house, state, *agent)?;
        let pieces = person_pieces(&joints);
        Some((*agent, pieces.iter().map(|piece| piece.pose).collect()))
    };
    persons.filter_map(figure).collect()
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
