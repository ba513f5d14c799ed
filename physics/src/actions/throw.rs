//! The action of throwing.

use super::hand_action::{HandAction, HandContext};
use super::{ActionContext, ActionResult, Actor};
use crate::outcome::{ActionOutcome, OutcomeCode, done, fail};
use dwell_scene::State;
use glam::Vec3;
use rapier3d::dynamics::RigidBody;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Distance over which the hand accelerates the object, m: our estimate for an arm.
const STROKE_M: f32 = 0.5;
/// Highest throwing speed of the lightest object, m/s: our estimate for a person indoors.
const FASTEST_M_S: f32 = 20.0;

/// Returns the highest throwing speed of a mass by a hand that lifts `lift_kg`: its force does work over the stroke, m v^2
/// / 2 = F s with F the weight that it lifts.
fn fastest_m_s(lift_kg: f32, mass_kg: f32, gravity_m_s2: f32) -> f32 {
    let work_j = lift_kg * gravity_m_s2 * STROKE_M;
    (2.0 * work_j / mass_kg.max(1e-6)).sqrt().min(FASTEST_M_S)
}

/// Throws the held object.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Throw {
    /// Direction in world space, of any length but zero; default: the direction of view.
    #[schemars(with = "Option<[f32; 3]>")]
    pub direction: Option<Vec3>,
    /// m/s, 0 or more; limited by the agent's strength.
    #[schemars(range(min = 0.0))]
    pub speed_m_s: f32,
}

impl Default for Throw {
    fn default() -> Self {
        Self {
            direction: None,
            speed_m_s: 3.0,
        }
    }
}

impl HandAction for Throw {
    fn perform(&self, hand: &mut HandContext<'_>) -> ActionResult {
        let actor = hand.actor;
        let ahead = actor.body.world_from_eye().transform_vector(Vec3::NEG_Z);
        let direction = self.direction.unwrap_or(ahead);
        hand.context
            .throw(hand.state, actor, direction, self.speed_m_s)
    }

    fn check(&self, hand: &HandContext<'_>) -> Result<(), Box<ActionOutcome>> {
        hand.context.held_object_of(hand.actor).map(|_| ())
    }
}

impl ActionContext<'_> {
    pub(super) fn throw(
        &mut self,
        state: &mut State,
        actor: Actor<'_>,
        direction: Vec3,
        speed_m_s: f32,
    ) -> ActionResult {
        let grip = self.held_object_of(actor)?;
        let along = direction.normalize_or_zero();
        let good = direction.is_finite() && along != Vec3::ZERO && speed_m_s.is_finite();
        if !good || speed_m_s < 0.0 {
            let sentence = format!(
                "You cannot throw along {direction} at {speed_m_s} m/s; give a direction that is not zero and a speed from 0 up."
            );
            return Ok(fail(OutcomeCode::BadNumber, sentence, Some(grip.object)));
        }
        let handle = self.dynamics.bodies[grip.body as usize].handle;
        let mass = self
            .dynamics
            .engine
            .bodies
            .get(handle)
            .map_or(1.0, RigidBody::mass);
        // Strength is given in kilograms of standard gravity.
        let gravity = dwell_scene::units::STANDARD_GRAVITY_M_S2;
        let most = fastest_m_s(actor.body.body.lift_kg, mass, gravity);
        let speed = speed_m_s.min(most);
        if let Some(place) = self
            .hands
            .held_objects
            .iter()
            .position(|grip| grip.agent == actor.id)
        {
            self.hands.open_hand(self.dynamics, state, place);
        }
        if let Some(rigid) = self.dynamics.engine.bodies.get_mut(handle) {
            rigid.set_linvel(along * speed, true);
            rigid.set_angvel(Vec3::ZERO, true);
        }
        self.dynamics.flush();
        self.articulation
            .write_bodies_and_joints(self.dynamics, state);
        let name = self.dynamics.name_of(grip.object);
        let limit = if speed < speed_m_s {
            ", as fast as you can"
        } else {
            ""
        };
        let sentence = format!("You throw the {name} at {speed:.1} m/s{limit}.");
        Ok(done(OutcomeCode::Done, sentence, Some(grip.object)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fastest_throw_does_the_work_of_the_arm() {
        let v = fastest_m_s(10.0, 5.0, 9.8);
        assert!((0.5 * 5.0 * v * v - 49.0).abs() < 1e-4);
        assert_eq!(fastest_m_s(10.0, 0.01, 9.8), FASTEST_M_S);
    }
}
