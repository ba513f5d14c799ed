//! The action of pointing.

use super::hand_action::{HandAction, HandContext};
use super::request::Target;
use super::{ActionContext, ActionResult, Actor};
use crate::outcome::{ActionOutcome, OutcomeCode, PointedTarget, done, fail};
use dwell_scene::{Entity, EntityId, State, SurfaceOwner};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Points at something: returns the thing, the point and its distance from the eye. No distance is too far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Point {
    /// The thing to point at.
    pub target: Target,
}

impl HandAction for Point {
    fn perform(&self, hand: &mut HandContext<'_>) -> ActionResult {
        hand.context.point(hand.state, hand.actor, &self.target)
    }

    fn check(&self, hand: &HandContext<'_>) -> Result<(), Box<ActionOutcome>> {
        let found = hand
            .context
            .resolve_target(hand.state, hand.actor, &self.target);
        found.map(|_| ())
    }
}

impl ActionContext<'_> {
    pub(super) fn point(
        &mut self,
        state: &State,
        actor: Actor<'_>,
        target: &Target,
    ) -> ActionResult {
        let aim = self.resolve_target(state, actor, target)?;
        let house = &self.dynamics.model.house;
        let eye = actor.body.eye_position();
        let (entity, name, object, middle) = match aim.entity {
            Entity::Object(id) => (
                house.entity_of_object(id),
                format!("the {}", self.dynamics.name_of(id)),
                Some(id),
                house.object_bounds(state, id).center(),
            ),
            Entity::Structure(id) => (
                house.entity_of_structure(id),
                format!("the {}", self.surface_name(SurfaceOwner::Structure(id))),
                None,
                house.meshes[house.structure[id].mesh].bounds().center(),
            ),
            Entity::Agent(id) if id == actor.id => {
                let sentence = "You cannot point at yourself. Point at something else.";
                return Err(Box::new(fail(OutcomeCode::TargetIsSelf, sentence, None)));
            }
            Entity::Agent(id) => (
                house.entity_of_agent(id),
                format!("agent {}", id.0),
                None,
                state.agents[id].eye_position(),
            ),
            Entity::Void => (EntityId::VOID, "nothing".to_owned(), None, eye),
        };
        let point = aim.point.unwrap_or(middle);
        let distance_m = (point - eye).length();
        let sentence = format!("You point at {name}, {distance_m:.1} m away.");
        let mut outcome = done(OutcomeCode::Done, sentence, object);
        outcome.pointed = Some(PointedTarget {
            entity,
            point,
            distance_m,
        });
        Ok(outcome)
    }
}
