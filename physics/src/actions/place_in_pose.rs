//! The action of leaving the held object in a given pose.

use super::hand_action::{HandAction, HandContext};
use super::stable_pose::StablePose;
use super::{ActionContext, ActionResult, Actor};
use crate::convert::to_rapier;
use crate::outcome::{ActionOutcome, OutcomeCode, fail};
use dwell_scene::{Pose, State};
use glam::Vec3;

/// Leaves the held object in a pose in which it rests, as one from which it was taken before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaceInPose {
    /// Pose of its first part, m. It must be within reach, free, and such that the object stays there.
    pub world_from_part: Pose,
}

impl HandAction for PlaceInPose {
    fn perform(&self, hand: &mut HandContext<'_>) -> ActionResult {
        hand.context
            .place_in_pose(hand.state, hand.actor, &self.world_from_part)
    }

    fn check(&self, hand: &HandContext<'_>) -> Result<(), Box<ActionOutcome>> {
        hand.context.held_object_of(hand.actor).map(|_| ())
    }
}

impl ActionContext<'_> {
    fn place_in_pose(
        &mut self,
        state: &mut State,
        actor: Actor<'_>,
        world_from_part: &Pose,
    ) -> ActionResult {
        let grip = self.held_object_of(actor)?;
        if !world_from_part.is_valid() {
            let sentence = format!("{world_from_part:?} is no pose; give finite numbers.");
            return Ok(fail(OutcomeCode::BadNumber, sentence, Some(grip.object)));
        }
        let bounds =
            self.dynamics.model.bodies[grip.body as usize].bounds(&to_rapier(world_from_part));
        let middle = bounds.center();
        let foot = Vec3::new(middle.x, bounds.min.y, middle.z);
        let stance = self.stable_pose(grip.body as usize, world_from_part.rotation);
        let Some(stance) = stance else {
            let held = self.dynamics.name_of(grip.object);
            let sentence = format!("The {held} would not stand like that. Turn it another way.");
            return Ok(fail(OutcomeCode::NoSupport, sentence, Some(grip.object)));
        };
        Ok(self.place_in_stances(state, actor, &grip, (&[stance], foot)))
    }

    /// Returns a body's pose with an orientation; `None` where it topples by itself.
    fn stable_pose(&self, body: usize, rotation: glam::Quat) -> Option<StablePose> {
        let plan = &self.dynamics.model.bodies[body];
        let rigid = self
            .dynamics
            .engine
            .bodies
            .get(self.dynamics.bodies[body].handle)?;
        let center_of_mass = rigid.mass_properties().local_mprops.local_com;
        StablePose::resting(plan, rotation, center_of_mass)
    }
}
