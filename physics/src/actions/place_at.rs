//! The action of placing the held object at a point.

use super::hand_action::{HandAction, HandContext};
use super::stable_pose::StablePose;
use super::{ActionContext, ActionResult, Actor};
use crate::dynamics::SupportSurfaceFilter;
use crate::hands::HeldObject;
use crate::outcome::{ActionOutcome, OutcomeCode, done, fail};
use dwell_scene::State;
use glam::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Largest height of a surface above or below the point, m.
const SURFACE_M: f32 = 0.03;

/// Places the held object with the middle of its foot at a point.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlaceAt {
    /// m; a surface must lie within 3 cm of it.
    #[schemars(with = "[f32; 3]")]
    pub point: Vec3,
}

impl HandAction for PlaceAt {
    fn perform(&self, hand: &mut HandContext<'_>) -> ActionResult {
        hand.context.place_at(hand.state, hand.actor, self.point)
    }

    fn check(&self, hand: &HandContext<'_>) -> Result<(), Box<ActionOutcome>> {
        hand.context.held_object_of(hand.actor).map(|_| ())
    }
}

impl ActionContext<'_> {
    pub(super) fn place_at(
        &mut self,
        state: &mut State,
        actor: Actor<'_>,
        point: Vec3,
    ) -> ActionResult {
        let grip = self.held_object_of(actor)?;
        if !point.is_finite() {
            let sentence = format!("{point} is no place; give finite numbers.");
            return Ok(fail(OutcomeCode::BadNumber, sentence, Some(grip.object)));
        }
        let stances = self.stable_poses(grip.body as usize);
        Ok(self.place_in_stances(state, actor, &grip, (&stances, point)))
    }

    /// Leaves the held object in the first of some stances in which it rests with the middle of its foot at a point.
    pub(super) fn place_in_stances(
        &mut self,
        state: &mut State,
        actor: Actor<'_>,
        grip: &HeldObject,
        (stances, point): (&[StablePose], Vec3),
    ) -> ActionOutcome {
        let held = self.dynamics.name_of(grip.object);
        let refuse = |code, sentence: String| fail(code, sentence, Some(grip.object));
        let eye = actor.body.eye_position();
        let (distance, reach) = ((point - eye).length(), actor.body.body.reach_m);
        if distance > reach {
            let sentence = format!(
                "That place is {distance:.2} m away; your reach is {reach:.2} m. Walk closer."
            );
            return refuse(OutcomeCode::TooFar, sentence);
        }
        let above = point + Vec3::Y * SURFACE_M;
        if let Some(blocker) = self.dynamics.first_reach_obstacle(eye, above) {
            let name = self.name_of_collider(blocker);
            let sentence =
                format!("The {name} is between you and that place. Choose one in the open.");
            return refuse(OutcomeCode::NotVisible, sentence);
        }
        let body = grip.body as usize;
        let levels =
            self.dynamics
                .support_heights(body, SupportSurfaceFilter::Any, above, 2.0 * SURFACE_M);
        let Some(height) = levels
            .into_iter()
            .min_by(|a, b| (a - point.y).abs().total_cmp(&(b - point.y).abs()))
        else {
            let sentence =
                format!("Nothing carries the {held} there. Choose a point on a level surface.");
            return refuse(OutcomeCode::NoSupport, sentence);
        };
        let foot = point.with_y(height);
        let mut blocker = None;
        for stance in stances {
            match self.stable_pose_at(body, stance, foot) {
                Ok(pose) => {
                    self.release_at(state, actor, &pose);
                    let sentence = format!("You put the {held} down there.");
                    return done(OutcomeCode::Done, sentence, Some(grip.object));
                }
                Err(found) => blocker = blocker.or(found),
            }
        }
        match blocker {
            Some(name) => refuse(
                OutcomeCode::NoSpace,
                format!(
                    "The {held} does not fit there: the {name} is in the way. Choose another point."
                ),
            ),
            None => refuse(
                OutcomeCode::NoSupport,
                format!("The {held} would not stand there. Choose a level spot away from edges."),
            ),
        }
    }
}
