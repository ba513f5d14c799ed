//! Opening and closing.

use super::outcome::{ActionCode, ActionOutcome, Notice, done, fail};
use crate::contact::Toucher;
use crate::joints::{self, Drive, Joint, Progress};
use crate::world::PhysicsWorld;
use dwell_scene::rays::RayScene;
use dwell_scene::{AgentId, JointCommand, JointId, ObjectId, State};

/// Openness from which a thing counts as open, and below which as closed.
const OPEN: f32 = 0.95;
const CLOSED: f32 = 0.02;

impl PhysicsWorld {
    pub(super) fn swing(
        &mut self,
        state: &mut State,
        rays: &RayScene,
        agent: AgentId,
        object: ObjectId,
        open: bool,
    ) -> ActionOutcome {
        let holder = state.agents[agent];
        let name = self.call(object);
        let house = self.model().house.clone();
        let ids: Vec<JointId> = house
            .joints_of(object)
            .filter(|id| house.joints[*id].opens())
            .collect();
        if ids.is_empty() {
            let verb = if open { "open" } else { "close" };
            let sentence =
                format!("The {name} has nothing to {verb}. Choose a door, drawer or lid.");
            return fail(ActionCode::NotOpenable, sentence, Some(object));
        }
        let openness = |id: &JointId| house.joints[*id].openness(state.joint_position[*id]);
        if open && ids.iter().all(|id| openness(id) >= OPEN) {
            let sentence = format!("The {name} is open already.");
            return fail(ActionCode::AlreadyOpen, sentence, Some(object));
        }
        if !open && ids.iter().all(|id| openness(id) <= CLOSED) {
            let sentence = format!("The {name} is closed already.");
            return fail(ActionCode::AlreadyClosed, sentence, Some(object));
        }
        if let Some(refusal) = self.refuse_reach(state, rays, &holder, object) {
            return refusal;
        }
        for id in ids {
            let joint = &house.joints[id];
            let goal = if open { joint.open } else { joint.closed };
            state.joint_command[id] = JointCommand::Position(goal);
            let drive = Drive::new(goal, state.joint_position[id], Some(agent));
            self.drives.insert(id, drive);
        }
        let verb = if open { "open" } else { "close" };
        let sentence = format!("You {verb} the {name}; it takes a moment.");
        done(ActionCode::Started, sentence, Some(object))
    }

    /// Takes a hand off a joint that has arrived or is blocked, and says so.
    pub(crate) fn finish_drive(&mut self, state: &mut State, joint: &Joint, progress: Progress) {
        let Some(drive) = self.drives.remove(&joint.id) else {
            return;
        };
        state.joint_command[joint.id] = JointCommand::Off;
        let articulation = self.model().house.joints[joint.id].clone();
        let object = articulation.object;
        let name = self.call(object);
        let position = state.joint_position[joint.id];
        if progress == Progress::Arrived
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
        let outcome = if progress == Progress::Arrived {
            let shut = drive.goal == articulation.closed;
            let word = if shut { "closed" } else { "open" };
            let sentence = format!("The {name} is {word}.");
            done(ActionCode::Done, sentence, Some(object))
        } else {
            let what = self.in_the_way(state, joint).map_or_else(
                || "something is in the way. Step aside or move it.".to_owned(),
                |what| format!("the {what} is in the way. Move it."),
            );
            let sentence = format!("The {name} stopped {share:.0} % open: {what}");
            fail(ActionCode::Blocked, sentence, Some(object))
        };
        self.notices.push(Notice {
            agent: drive.agent,
            outcome,
        });
    }

    /// The name of a thing that a joint's leaf touches, other than its own object and the building.
    fn in_the_way(&self, state: &State, joint: &Joint) -> Option<String> {
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
                Some(Toucher::Part(part)) if !own(part) => {
                    return Some(self.call(house.parts[part].object));
                }
                Some(Toucher::Agent(agent)) if (agent.0 as usize) < state.agents.len() => {
                    return Some(format!("body of agent {}", agent.0));
                }
                _ => {}
            }
        }
        None
    }
}
