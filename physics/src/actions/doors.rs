//! Shared code of opening and closing.

use super::request::Target;
use super::target::ResolvedTarget;
use super::{ActionContext, ActionResult, Actor};
use crate::articulation::{CLOSED_THRESHOLD, OPEN_THRESHOLD};
use crate::joints::ManualJointDrive;
use crate::outcome::{ActionOutcome, OutcomeCode, done, fail};
use dwell_scene::{JointCommand, JointId, ObjectId, State};

/// Tolerance of the openness that an action asks for.
const OPENNESS_TOLERANCE: f32 = 0.02;

/// What a door does on its way to an openness.
fn verb(fraction: f32) -> &'static str {
    if fraction > 0.0 { "open" } else { "close" }
}

impl ActionContext<'_> {
    /// Returns the object that opens or closes, and its joints that move.
    pub(super) fn joints_to_swing(
        &self,
        state: &State,
        actor: Actor<'_>,
        target: &Target,
        fraction: f32,
    ) -> Result<(ObjectId, Vec<JointId>), Box<ActionOutcome>> {
        let (object, aim) = self.resolve_object_target(state, actor, target)?;
        let name = self.dynamics.name_of(object);
        let refuse = |code, sentence: String| Err(Box::new(fail(code, sentence, Some(object))));
        if !(0.0..=1.0).contains(&fraction) {
            let sentence =
                format!("Nothing opens to {fraction}; give a number from 0 (closed) to 1 (open).");
            return refuse(OutcomeCode::BadNumber, sentence);
        }
        let house = self.dynamics.model.house.clone();
        let ids = self.joints_meant(object, &aim);
        let verb = verb(fraction);
        if ids.is_empty() {
            let sentence =
                format!("The {name} has nothing to {verb}. Choose a door, drawer or lid.");
            return refuse(OutcomeCode::NotOpenable, sentence);
        }
        let openness = |id: &JointId| house.joints[*id].openness(state.joint_position[*id]);
        let all = |there: &dyn Fn(f32) -> bool| ids.iter().all(|id| there(openness(id)));
        if fraction >= OPEN_THRESHOLD && all(&|share| share >= OPEN_THRESHOLD) {
            let sentence = format!("The {name} is open already.");
            return refuse(OutcomeCode::AlreadyOpen, sentence);
        }
        if fraction <= CLOSED_THRESHOLD && all(&|share| share <= CLOSED_THRESHOLD) {
            let sentence = format!("The {name} is closed already.");
            return refuse(OutcomeCode::AlreadyClosed, sentence);
        }
        if all(&|share| (share - fraction).abs() <= OPENNESS_TOLERANCE) {
            let percent = (fraction * 100.0).round();
            let sentence = format!("The {name} is {percent:.0} % open already.");
            return refuse(OutcomeCode::AlreadyOpen, sentence);
        }
        if let Some(refusal) = self.check_reach(state, actor, object) {
            return Err(Box::new(refusal));
        }
        Ok((object, ids))
    }

    pub(super) fn swing_door(
        &mut self,
        state: &mut State,
        actor: Actor<'_>,
        target: &Target,
        fraction: f32,
    ) -> ActionResult {
        let (object, ids) = self.joints_to_swing(state, actor, target, fraction)?;
        self.drive_joints(state, actor, &ids, fraction);
        let (verb, name) = (verb(fraction), self.dynamics.name_of(object));
        let sentence = format!("You {verb} the {name}; it takes a moment.");
        Ok(done(OutcomeCode::Started, sentence, Some(object)))
    }

    /// Starts hand drives on joints that move them to an openness (0 to 1) over the next steps.
    pub(super) fn drive_joints(
        &mut self,
        state: &mut State,
        actor: Actor<'_>,
        joints: &[JointId],
        fraction: f32,
    ) {
        for id in joints {
            let joint = &self.dynamics.model.house.joints[*id];
            // Exactly at its stop, so that rounding leaves no gap.
            let goal = if fraction >= 1.0 {
                joint.open
            } else {
                joint.position_at(fraction)
            };
            let goal = state
                .joint_parameters(&self.dynamics.model.house, *id)
                .clamp(goal);
            state.joint_command[*id] = JointCommand::Position(goal);
            let drive = ManualJointDrive::new(goal, state.joint_position[*id], Some(actor.id));
            self.articulation.hand_drives.insert(*id, drive);
        }
    }

    /// Returns the joints of an object that a target means: the one that moves the part named or hit, or all.
    fn joints_meant(&self, object: ObjectId, aim: &ResolvedTarget) -> Vec<JointId> {
        let house = &self.dynamics.model.house;
        let moved_by = |part| {
            let body = self.dynamics.model.body_of_part[part]?;
            self.dynamics.model.bodies[body as usize].joint
        };
        let opens = |id: &JointId| house.joints[*id].is_openable();
        let one = aim.part.and_then(moved_by).filter(opens);
        one.map_or_else(
            || house.joints_of(object).filter(opens).collect(),
            |joint| vec![joint],
        )
    }
}
