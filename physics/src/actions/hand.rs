//! Grasping and releasing.

use super::request::Target;
use super::{ActionContext, ActionResult, Actor};
use crate::body::BodyStatus;
use crate::convert::{from_rapier, to_rapier};
use crate::hands::{Grasp, HeldObject, held_body_target_pose};
use crate::outcome::{ActionOutcome, OutcomeCode, done, fail};
use dwell_scene::{AgentId, Mobility, ObjectId, State};
use glam::Vec3;

impl ActionContext<'_> {
    /// Returns the object that a hand can take, and its body.
    pub(super) fn object_to_pick(
        &self,
        state: &State,
        actor: Actor<'_>,
        target: &Target,
        grasp: Grasp,
    ) -> Result<(ObjectId, usize), Box<ActionOutcome>> {
        let holder = actor.body;
        let (object, _) = self.resolve_object_target(state, actor, target)?;
        let name = self.dynamics.name_of(object);
        let refuse = |code, sentence: String| Err(Box::new(fail(code, sentence, Some(object))));
        if !grasp.is_valid() {
            let sentence = format!(
                "{grasp} cannot be; a spring's frequency is 0.5 to 20 Hz, its damping ratio 0.05 to 4."
            );
            return refuse(OutcomeCode::BadNumber, sentence);
        }
        if let Some(held) = holder.holding {
            let held = self.dynamics.name_of(held);
            let sentence = format!("You hold the {held} already. Drop it first.");
            return refuse(OutcomeCode::HandFull, sentence);
        }
        if let Some(other) = state.held_by[object] {
            let sentence = format!("Agent {} holds the {name}. Wait until it is free.", other.0);
            return refuse(OutcomeCode::HeldByOther, sentence);
        }
        let thing = &self.dynamics.model.house.objects[object];
        let bodies: Vec<usize> = self.dynamics.bodies_of(object);
        let whole = thing.mobility == Mobility::Movable && bodies.len() == 1;
        if !thing.pickable || !whole {
            let sentence = format!("The {name} is not a thing to take. Choose something that is.");
            return refuse(OutcomeCode::NotPickable, sentence);
        }
        let body = bodies[0];
        if let Some(refusal) = self.check_not_stood_on(state, actor.id, object) {
            return Err(Box::new(refusal));
        }
        if let Some(refusal) = self.check_reach(state, actor, object) {
            return Err(Box::new(refusal));
        }
        if self.dynamics.statuses[body] != BodyStatus::Free {
            let sentence = format!("The {name} is stuck where it stands. Choose something else.");
            return refuse(OutcomeCode::Stuck, sentence);
        }
        let rigid = &self.dynamics.engine.bodies[self.dynamics.bodies[body].handle];
        let (mass, lift) = (rigid.mass(), holder.body.lift_kg);
        if mass > lift {
            let sentence = format!(
                "The {name} weighs {mass:.1} kg; you lift {lift:.1} kg. Choose something lighter."
            );
            return refuse(OutcomeCode::TooHeavy, sentence);
        }
        let size = self.dynamics.model.bodies[body]
            .bounds(rigid.position())
            .size()
            .max_element();
        let most = holder.body.max_carry_size_m;
        if size > most {
            let sentence = format!(
                "The {name} is {size:.1} m long; you carry up to {most:.1} m. Choose something smaller."
            );
            return refuse(OutcomeCode::TooLarge, sentence);
        }
        Ok((object, body))
    }

    pub(super) fn pick(
        &mut self,
        state: &mut State,
        actor: Actor<'_>,
        target: &Target,
        grasp: Grasp,
    ) -> ActionResult {
        let (object, body) = self.object_to_pick(state, actor, target, grasp)?;
        let holder = actor.body;
        let name = self.dynamics.name_of(object);
        let place = *self.dynamics.engine.bodies[self.dynamics.bodies[body].handle].position();
        // Objects on it or in it come along if it is moved gently.
        let house = &self.dynamics.model.house;
        let loaded = house
            .objects
            .ids()
            .any(|other| state.supports_of(house, other).contains(&Some(object)));
        let grip = HeldObject::new(
            &self.dynamics.model,
            body as u32,
            actor.id,
            &holder,
            &from_rapier(&place),
            (grasp, loaded),
        );
        self.hands.held_objects.push(grip);
        self.hands.held_objects.sort_by_key(|grip| grip.agent);
        self.dynamics
            .collision_exclusions
            .exclude_carried(body as u32, actor.id);
        let target = to_rapier(&held_body_target_pose(&grip, &holder));
        let clear = if loaded {
            None
        } else {
            self.dynamics
                .first_clear_pose(body, &holder, &place, &target)
        };
        let gravity_scale = self.hands.gravity_scale(self.dynamics, body);
        self.dynamics
            .engine
            .wake_around(self.dynamics.bodies[body].handle);
        if let Some(rigid) = self
            .dynamics
            .engine
            .bodies
            .get_mut(self.dynamics.bodies[body].handle)
        {
            rigid.set_gravity_scale(gravity_scale, true);
            rigid.set_linvel(Vec3::ZERO, true);
            rigid.set_angvel(Vec3::ZERO, true);
            // A held object may be thin and fast afterwards.
            rigid.enable_ccd(true);
            if let Some(clear) = clear {
                rigid.set_position(clear, true);
            }
        }
        state.agents[actor.id].holding = Some(object);
        state.held_by[object] = Some(actor.id);
        self.dynamics.flush();
        self.articulation
            .write_bodies_and_joints(self.dynamics, state);
        let sentence = format!("You hold the {name}.");
        Ok(done(OutcomeCode::Done, sentence, Some(object)))
    }

    pub(super) fn release(&mut self, state: &mut State, agent: AgentId) -> ActionOutcome {
        let Some(place) = self
            .hands
            .held_objects
            .iter()
            .position(|grip| grip.agent == agent)
        else {
            return fail(
                OutcomeCode::HandEmpty,
                "You hold nothing. Pick something first.",
                None,
            );
        };
        let object = self.hands.held_objects[place].object;
        let at_edge = self.hands.held_objects[place].edge().is_some();
        self.hands.open_hand(self.dynamics, state, place);
        if at_edge {
            // It may have been set down.
            self.articulation
                .write_bodies_and_joints(self.dynamics, state);
        }
        let sentence = format!("You let go of the {}.", self.dynamics.name_of(object));
        done(OutcomeCode::Done, sentence, Some(object))
    }
}
