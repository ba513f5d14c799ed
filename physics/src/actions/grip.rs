//! The action of taking hold of a large thing's edge.

use super::hand_action::{HandAction, HandContext};
use super::request::Target;
use super::{ActionContext, ActionResult, Actor};
use crate::body::BodyStatus;
use crate::hands::{HeldObject, edge_point};
use crate::outcome::{ActionOutcome, OutcomeCode, done, fail};
use dwell_scene::{Mobility, ObjectId, State};
use rapier3d::math::Pose as RapierPose;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Furthest level distance of a holder's middle from the edge that it takes hold of, m.
const AT_EDGE_M: f32 = 0.6;
/// Least largest edge, seen from above, of what is taken hold of by its edge, m.
const SMALLEST_M: f32 = 0.4;

/// Takes hold of the edge of a large thing, to carry it together with others on other sides.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Grip {
    /// The thing to take hold of.
    pub target: Target,
}

impl HandAction for Grip {
    fn perform(&self, hand: &mut HandContext<'_>) -> ActionResult {
        hand.context.grip(hand.state, hand.actor, &self.target)
    }

    fn check(&self, hand: &HandContext<'_>) -> Result<(), Box<ActionOutcome>> {
        let found = hand
            .context
            .object_to_grip(hand.state, hand.actor, &self.target);
        found.map(|_| ())
    }
}

impl ActionContext<'_> {
    /// Returns the object whose edge an agent can take hold of, and its body.
    fn object_to_grip(
        &self,
        state: &State,
        actor: Actor<'_>,
        target: &Target,
    ) -> Result<(ObjectId, usize), Box<ActionOutcome>> {
        let (object, _) = self.resolve_object_target(state, actor, target)?;
        let name = self.dynamics.name_of(object);
        let refuse = |code, sentence: String| Err(Box::new(fail(code, sentence, Some(object))));
        if let Some(held) = actor.body.holding {
            let held = self.dynamics.name_of(held);
            let sentence = format!("You hold the {held} already. Drop it first.");
            return refuse(OutcomeCode::HandFull, sentence);
        }
        let bodies: Vec<usize> = self.dynamics.bodies_of(object);
        let thing = &self.dynamics.model.house.objects[object];
        let &[body] = bodies.as_slice() else {
            let sentence = format!("The {name} cannot be carried. Choose something loose.");
            return refuse(OutcomeCode::NotMovable, sentence);
        };
        if thing.mobility != Mobility::Movable {
            let sentence = format!("The {name} stands firm. Choose something loose.");
            return refuse(OutcomeCode::NotMovable, sentence);
        }
        let mut grips = self.hands.held_objects.iter();
        if let Some(grip) = grips.find(|grip| grip.object == object && grip.edge().is_none()) {
            let sentence = format!(
                "Agent {} holds the {name}. Wait until it is free.",
                grip.agent.0
            );
            return refuse(OutcomeCode::HeldByOther, sentence);
        }
        if self.dynamics.statuses[body] != BodyStatus::Free {
            let sentence = format!("The {name} is stuck where it stands. Choose something else.");
            return refuse(OutcomeCode::Stuck, sentence);
        }
        let pose = *self.dynamics.engine.bodies[self.dynamics.bodies[body].handle].position();
        let bounds = self.dynamics.model.bodies[body].bounds(&RapierPose::IDENTITY);
        let size = bounds.size();
        if size.x.max(size.z) < SMALLEST_M {
            let sentence =
                format!("The {name} is too small to be held by several. Pick it, or let it be.");
            return refuse(OutcomeCode::NotPickable, sentence);
        }
        if let Some(refusal) = self.check_not_stood_on(state, actor.id, object) {
            return Err(Box::new(refusal));
        }
        if let Some(refusal) = self.check_reach(state, actor, object) {
            return Err(Box::new(refusal));
        }
        let feet = pose.inverse() * actor.body.position;
        let edge = edge_point(feet, bounds.min, bounds.max);
        let away_m = (edge - feet).with_y(0.0).length();
        if away_m > AT_EDGE_M {
            let sentence = format!(
                "You stand {away_m:.2} m from the edge of the {name}; to carry it stand within {AT_EDGE_M} m. Step closer."
            );
            return refuse(OutcomeCode::TooFar, sentence);
        }
        Ok((object, body))
    }

    fn grip(&mut self, state: &mut State, actor: Actor<'_>, target: &Target) -> ActionResult {
        let (object, body) = self.object_to_grip(state, actor, target)?;
        let grip = HeldObject::at_edge(self.dynamics, (object, body), (actor.id, &actor.body));
        self.hands.grip_edge(self.dynamics, state, grip);
        self.articulation
            .write_bodies_and_joints(self.dynamics, state);
        let name = self.dynamics.name_of(object);
        let sentence = if self.hands.is_lifted(self.dynamics, body) {
            format!("You lift the {name} together.")
        } else {
            format!("You hold the {name} by its edge. It is lifted when others hold other sides.")
        };
        Ok(done(OutcomeCode::Done, sentence, Some(object)))
    }
}
