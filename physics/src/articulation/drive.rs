//! Joint actuation in a control step: motors, and hands that open doors and drawers.

use super::WorldJoints;
use crate::contact::{ContactEntity, entry_index};
use crate::dynamics::Dynamics;
use crate::joints::{self, DriveProgress, ManualJointDrive, PhysicsJoint, motor_command};
use crate::outcome::{DelayedOutcome, OutcomeCode, done, fail};
use dwell_scene::{JointCommand, JointKind, State};

/// Openness from which a joint counts as open, and up to which as closed.
pub(crate) const OPEN_THRESHOLD: f32 = 0.95;
pub(crate) const CLOSED_THRESHOLD: f32 = 0.02;

impl WorldJoints {
    /// Sets the actuation of all joints from the state's targets.
    pub(crate) fn set_actuation(
        &mut self,
        dynamics: &mut Dynamics,
        state: &mut State,
        notices: &mut Vec<DelayedOutcome>,
    ) {
        let house = dynamics.model.house.clone();
        let step_s = dynamics.settings.dt_s * dynamics.settings.steps_per_control as f32;
        let by_laws = !dynamics.laws.motors.is_empty();
        for index in 0..self.joints.len() {
            let joint = self.joints[index];
            let articulation = &house.joints[joint.id];
            if by_laws && articulation.servo.is_some() {
                continue;
            }
            let command = motor_command(state, joint.id);
            let child = joint.child as usize;
            let now = (
                state.joint_position[joint.id],
                state.joint_velocity[joint.id],
            );
            if articulation.servo.is_none()
                && let JointCommand::Position(goal) = command
            {
                let goal = joint.values.clamp(goal);
                let drive = self.hand_drives.get(&joint.id);
                if drive.is_none_or(|drive| drive.goal != goal) {
                    self.hand_drives
                        .insert(joint.id, ManualJointDrive::new(goal, now.0, None));
                }
                if (goal - articulation.closed).abs() > joints::closed_tolerance(joint.kind) {
                    let body = dynamics.bodies[child];
                    joints::release(&mut dynamics.engine, &body, &mut dynamics.statuses[child]);
                }
            } else if articulation.servo.is_none() {
                self.hand_drives.remove(&joint.id);
            }
            let hand = self.hand_drives.get_mut(&joint.id);
            let puller = hand.as_ref().and_then(|hand| hand.agent);
            let puller = puller.and_then(|agent| state.agents.get(agent));
            let effort = puller.map_or_else(
                || state.default_hand_effort(),
                |agent| agent.body.hand_effort,
            );
            let limits = (step_s, effort);
            let (pull, progress) =
                joints::advance(joint.kind, &joint.values, command, hand, now, limits);
            // A motor that is switched off wakes what it held, too.
            if self.actuations[index] != pull {
                joints::wake(&mut dynamics.engine, &joint);
            }
            self.actuations[index] = pull;
            if let Some(progress) = progress.filter(|progress| *progress != DriveProgress::Moving) {
                let drive = self.finish_drive(dynamics, state, &joint, progress);
                notices.extend(drive);
            }
        }
    }

    /// Ends the hand drive of a joint that has arrived or is blocked, with an outcome.
    fn finish_drive(
        &mut self,
        dynamics: &mut Dynamics,
        state: &mut State,
        joint: &PhysicsJoint,
        progress: DriveProgress,
    ) -> Option<DelayedOutcome> {
        let drive = self.hand_drives.remove(&joint.id)?;
        state.joint_command[joint.id] = JointCommand::Off;
        let articulation = dynamics.model.house.joints[joint.id].clone();
        let object = articulation.object;
        let name = dynamics.name_of(object);
        let position = state.joint_position[joint.id];
        if progress == DriveProgress::Arrived
            && dynamics.settings.config.latches
            && drive.goal == articulation.closed
            && joints::is_at_closed_position(joint, &articulation, position)
        {
            let child = joint.child as usize;
            let body = dynamics.bodies[child];
            joints::latch(
                &mut dynamics.engine,
                joint,
                &articulation,
                &body,
                &mut dynamics.statuses[child],
            );
        }
        let share = (articulation.openness(position) * 100.0).round();
        let outcome = if progress == DriveProgress::Arrived {
            let asked = articulation.openness(drive.goal);
            let sentence = if asked <= CLOSED_THRESHOLD {
                format!("The {name} is closed.")
            } else if asked >= OPEN_THRESHOLD {
                format!("The {name} is open.")
            } else {
                format!("The {name} is {share:.0} % open.")
            };
            done(OutcomeCode::Done, sentence, Some(object))
        } else {
            let effort = drive
                .agent
                .and_then(|agent| state.agents.get(agent))
                .map_or_else(
                    || state.default_hand_effort(),
                    |agent| agent.body.hand_effort,
                );
            let friction = joint.values.friction;
            let what = match blocking_object_name(dynamics, state, joint) {
                Some(what) => format!("the {what} is in the way. Move it."),
                None if friction >= effort => {
                    let unit = match joint.kind {
                        JointKind::Hinge => "N m",
                        JointKind::Slide => "N",
                    };
                    format!(
                        "its joint holds with {friction} {unit}, and the hand pulls with {effort} {unit}."
                    )
                }
                None => "something is in the way. Step aside or move it.".to_owned(),
            };
            let sentence = format!("The {name} stopped {share:.0} % open: {what}");
            fail(OutcomeCode::Blocked, sentence, Some(object))
        };
        Some(DelayedOutcome {
            agent: drive.agent,
            outcome,
        })
    }
}

/// Returns the name of a thing that a joint's leaf touches, other than its own object and the building.
fn blocking_object_name(
    dynamics: &Dynamics,
    state: &State,
    joint: &PhysicsJoint,
) -> Option<String> {
    let child = &dynamics.model.bodies[joint.child as usize];
    let house = &dynamics.model.house;
    let own = |part| house.parts[part].object == child.object;
    for pair in dynamics.engine.narrow_phase.contact_pairs() {
        let entry = |handle| {
            dynamics
                .engine
                .colliders
                .get(handle)
                .map(|collider| &dynamics.entries[entry_index(collider)])
        };
        let (Some(a), Some(b)) = (entry(pair.collider1), entry(pair.collider2)) else {
            continue;
        };
        let other = match (a.body, b.body) {
            (Some(body), _) if body == joint.child => b,
            (_, Some(body)) if body == joint.child => a,
            _ => continue,
        };
        if pair.total_impulse_magnitude() <= 0.0 {
            continue;
        }
        match other.contact_entity {
            Some(ContactEntity::Part(part)) if !own(part) => {
                return Some(dynamics.name_of(house.parts[part].object));
            }
            Some(ContactEntity::Agent(agent)) if (agent.0 as usize) < state.agents.len() => {
                return Some(format!("body of agent {}", agent.0));
            }
            _ => {}
        }
    }
    None
}
