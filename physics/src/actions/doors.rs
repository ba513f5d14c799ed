//! Opening and closing.

use super::outcome::{DelayedOutcome, OutcomeCode, done, fail};
use super::request::Target;
use super::target::ResolvedTarget;
use super::{ActionResult, Actor};
use crate::contact::ContactEntity;
use crate::joints::{self, DriveProgress, HandDrive, PhysicsJoint};
use crate::world::PhysicsWorld;
use dwell_scene::{JointCommand, JointId, ObjectId, State};

/// Openness from which a thing counts as open, and below which as closed.
const OPEN: f32 = 0.95;
const CLOSED: f32 = 0.02;
/// How near to a wanted openness a thing counts as being there.
const THERE: f32 = 0.02;

impl PhysicsWorld {
    pub(super) fn swing(
        &mut self,
        state: &mut State,
        actor: Actor<'_>,
        target: &Target,
        fraction: f32,
    ) -> ActionResult {
        let (object, aim) = self.resolve_object_target(state, actor, target)?;
        let name = self.call(object);
        let refuse = |code, sentence: String| Ok(fail(code, sentence, Some(object)));
        if !(0.0..=1.0).contains(&fraction) {
            let sentence =
                format!("Nothing opens to {fraction}; give a number from 0 (closed) to 1 (open).");
            return refuse(OutcomeCode::BadNumber, sentence);
        }
        let house = self.model().house.clone();
        let ids = self.joints_meant(object, &aim);
        let verb = if fraction > 0.0 { "open" } else { "close" };
        if ids.is_empty() {
            let sentence =
                format!("The {name} has nothing to {verb}. Choose a door, drawer or lid.");
            return refuse(OutcomeCode::NotOpenable, sentence);
        }
        let openness = |id: &JointId| house.joints[*id].openness(state.joint_position[*id]);
        let all = |there: &dyn Fn(f32) -> bool| ids.iter().all(|id| there(openness(id)));
        if fraction >= OPEN && all(&|share| share >= OPEN) {
            let sentence = format!("The {name} is open already.");
            return refuse(OutcomeCode::AlreadyOpen, sentence);
        }
        if fraction <= CLOSED && all(&|share| share <= CLOSED) {
            let sentence = format!("The {name} is closed already.");
            return refuse(OutcomeCode::AlreadyClosed, sentence);
        }
        if all(&|share| (share - fraction).abs() <= THERE) {
            let percent = (fraction * 100.0).round();
            let sentence = format!("The {name} is {percent:.0} % open already.");
            return refuse(OutcomeCode::AlreadyOpen, sentence);
        }
        if let Some(refusal) = self.refuse_reach(state, actor, object) {
            return Ok(refusal);
        }
        self.lead(state, actor, &ids, fraction);
        let sentence = format!("You {verb} the {name}; it takes a moment.");
        Ok(done(OutcomeCode::Started, sentence, Some(object)))
    }

    /// Lays the actor's hand on joints, to lead them to an openness (0 to 1) over the next steps.
    pub(super) fn lead(
        &mut self,
        state: &mut State,
        actor: Actor<'_>,
        joints: &[JointId],
        fraction: f32,
    ) {
        for id in joints {
            let joint = &self.model.house.joints[*id];
            // Exactly at its stop, so that rounding leaves no gap.
            let goal = if fraction >= 1.0 {
                joint.open
            } else {
                joint.position_at(fraction)
            };
            let goal = state.joint_values(&self.model.house, *id).clamp(goal);
            state.joint_command[*id] = JointCommand::Position(goal);
            let drive = HandDrive::new(goal, state.joint_position[*id], Some(actor.id));
            self.drives.insert(*id, drive);
        }
    }

    /// The joints of an object that are meant: the one that moves the part that was named or met, or all.
    fn joints_meant(&self, object: ObjectId, aim: &ResolvedTarget) -> Vec<JointId> {
        let house = &self.model().house;
        let moved_by = |part| {
            let body = self.model().body_of_part[part]?;
            self.model().bodies[body as usize].joint
        };
        let opens = |id: &JointId| house.joints[*id].opens();
        let one = aim.part.and_then(moved_by).filter(opens);
        one.map_or_else(
            || house.joints_of(object).filter(opens).collect(),
            |joint| vec![joint],
        )
    }

    /// Takes a hand off a joint that has arrived or is blocked, and says so.
    pub(crate) fn finish_drive(
        &mut self,
        state: &mut State,
        joint: &PhysicsJoint,
        progress: DriveProgress,
    ) {
        let Some(drive) = self.drives.remove(&joint.id) else {
            return;
        };
        state.joint_command[joint.id] = JointCommand::Off;
        let articulation = self.model().house.joints[joint.id].clone();
        let object = articulation.object;
        let name = self.call(object);
        let position = state.joint_position[joint.id];
        if progress == DriveProgress::Arrived
            && self.settings.config.latches
            && drive.goal == articulation.closed
            && joints::stands_shut(joint, &articulation, position)
        {
            let child = joint.child as usize;
            let body = self.bodies[child];
            joints::shut(
                &mut self.engine,
                joint,
                &articulation,
                &body,
                &mut self.holds[child],
            );
        }
        let share = (articulation.openness(position) * 100.0).round();
        let outcome = if progress == DriveProgress::Arrived {
            let asked = articulation.openness(drive.goal);
            let sentence = if asked <= CLOSED {
                format!("The {name} is closed.")
            } else if asked >= OPEN {
                format!("The {name} is open.")
            } else {
                format!("The {name} is {share:.0} % open.")
            };
            done(OutcomeCode::Done, sentence, Some(object))
        } else {
            let what = self.in_the_way(state, joint).map_or_else(
                || "something is in the way. Step aside or move it.".to_owned(),
                |what| format!("the {what} is in the way. Move it."),
            );
            let sentence = format!("The {name} stopped {share:.0} % open: {what}");
            fail(OutcomeCode::Blocked, sentence, Some(object))
        };
        self.notices.push(DelayedOutcome {
            agent: drive.agent,
            outcome,
        });
    }

    /// The name of a thing that a joint's leaf touches, other than its own object and the building.
    fn in_the_way(&self, state: &State, joint: &PhysicsJoint) -> Option<String> {
        let child = &self.model().bodies[joint.child as usize];
        let house = &self.model().house;
        let own = |part| house.parts[part].object == child.object;
        for pair in self.engine.narrow_phase.contact_pairs() {
            let entry = |handle| {
                self.engine
                    .colliders
                    .get(handle)
                    .map(|collider| &self.entries[crate::contact::entry_index(collider)])
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
            match other.toucher {
                Some(ContactEntity::Part(part)) if !own(part) => {
                    return Some(self.call(house.parts[part].object));
                }
                Some(ContactEntity::Agent(agent)) if (agent.0 as usize) < state.agents.len() => {
                    return Some(format!("body of agent {}", agent.0));
                }
                _ => {}
            }
        }
        None
    }
}
