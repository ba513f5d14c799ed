//! Taking and letting go.

use super::outcome::{ActionOutcome, OutcomeCode, done, fail};
use super::request::{Grasp, Target};
use super::{ActionResult, Actor, DelayedOutcome};
use crate::agents::{HeldObject, hand_pose, release};
use crate::body::BodyStatus;
use crate::convert::{from_rapier, to_rapier};
use crate::world::PhysicsWorld;
use dwell_scene::{AgentId, AgentState, Mobility, ObjectId, State};
use glam::Vec3;
use rapier3d::dynamics::RigidBody;
use rapier3d::math::Pose as RapierPose;

/// Places between the hand and where a thing lies that are tried for it when it is taken.
const TRIES: u32 = 6;

impl PhysicsWorld {
    pub(super) fn pick(
        &mut self,
        state: &mut State,
        actor: Actor<'_>,
        target: &Target,
        grasp: Grasp,
    ) -> ActionResult {
        let holder = actor.body;
        let (object, _) = self.resolve_object_target(state, actor, target)?;
        let name = self.call(object);
        let refuse = |code, sentence: String| Ok(fail(code, sentence, Some(object)));
        if !grasp.is_valid() {
            let sentence = format!(
                "{grasp:?} cannot be; a spring's frequency is 0.5 to 20 Hz, its damping ratio 0.05 to 4."
            );
            return refuse(OutcomeCode::BadNumber, sentence);
        }
        if let Some(held) = holder.holding {
            let held = self.call(held);
            let sentence = format!("You hold the {held} already. Drop it first.");
            return refuse(OutcomeCode::HandFull, sentence);
        }
        if let Some(other) = state.held_by[object] {
            let sentence = format!("Agent {} holds the {name}. Wait until it is free.", other.0);
            return refuse(OutcomeCode::HeldByOther, sentence);
        }
        let thing = &self.model().house.objects[object];
        let bodies: Vec<usize> = self.bodies_of(object);
        let whole = thing.mobility == Mobility::Movable && bodies.len() == 1;
        if !thing.pickable || !whole {
            let sentence = format!("The {name} is not a thing to take. Choose something that is.");
            return refuse(OutcomeCode::NotPickable, sentence);
        }
        let body = bodies[0];
        if let Some(refusal) = self.refuse_stood_on(state, actor.id, object) {
            return Ok(refusal);
        }
        if let Some(refusal) = self.refuse_reach(state, actor, object) {
            return Ok(refusal);
        }
        if self.holds[body] != BodyStatus::Free {
            let sentence = format!("The {name} is stuck where it stands. Choose something else.");
            return refuse(OutcomeCode::Stuck, sentence);
        }
        let rigid = &self.engine.bodies[self.bodies[body].handle];
        let (mass, lift) = (rigid.mass(), holder.body.lift_kg);
        if mass > lift {
            let sentence = format!(
                "The {name} weighs {mass:.1} kg; you lift {lift:.1} kg. Choose something lighter."
            );
            return refuse(OutcomeCode::TooHeavy, sentence);
        }
        let place = *rigid.position();
        let size = self.model().bodies[body]
            .bounds(&place)
            .size()
            .max_element();
        let most = holder.body.max_carry_size_m;
        if size > most {
            let sentence = format!(
                "The {name} is {size:.1} m long; you carry up to {most:.1} m. Choose something smaller."
            );
            return refuse(OutcomeCode::TooLarge, sentence);
        }
        // What stands on it or lies in it comes along if it is moved gently.
        let house = &self.model().house;
        let loaded = house
            .objects
            .ids()
            .any(|other| state.rests_on(house, other).contains(&Some(object)));
        let grip = HeldObject::new(
            self.model(),
            body as u32,
            actor.id,
            &holder,
            &from_rapier(&place),
            (grasp, loaded),
        );
        self.grips.push(grip);
        self.grips.sort_by_key(|grip| grip.agent);
        self.excluded.carry(body as u32, actor.id);
        let target = to_rapier(&hand_pose(&grip, &holder));
        let clear = if loaded {
            None
        } else {
            self.clear_between(body, &holder, &place, &target)
        };
        let gravity_scale = self.gravity_scale(body);
        self.engine.wake_around(self.bodies[body].handle);
        if let Some(rigid) = self.engine.bodies.get_mut(self.bodies[body].handle) {
            rigid.set_gravity_scale(gravity_scale, true);
            rigid.set_linvel(Vec3::ZERO, true);
            rigid.set_angvel(Vec3::ZERO, true);
            // What has been in a hand may be thin and fast.
            rigid.enable_ccd(true);
            if let Some(clear) = clear {
                rigid.set_position(clear, true);
            }
        }
        state.agents[actor.id].holding = Some(object);
        state.held_by[object] = Some(actor.id);
        self.flush();
        self.write_bodies(state);
        let sentence = format!("You hold the {name}.");
        Ok(done(OutcomeCode::Done, sentence, Some(object)))
    }

    /// The first place on the straight way from `to` back to `from` where a body overlaps nothing solid and is not
    /// beyond a wall, seen from its holder's eye.
    pub(crate) fn clear_between(
        &self,
        body: usize,
        holder: &AgentState,
        from: &RapierPose,
        to: &RapierPose,
    ) -> Option<RapierPose> {
        let eye = holder.eye_position();
        (0..TRIES).find_map(|k| {
            let share = k as f32 / TRIES as f32;
            let mut place = *to;
            place.translation = to.translation.lerp(from.translation, share);
            let middle = self.model().bodies[body].bounds(&place).center();
            let open = self.first_obstacle(eye, middle).is_none();
            (open && self.is_clear(body, &place)).then_some(place)
        })
    }

    pub(super) fn let_go(&mut self, state: &mut State, agent: AgentId) -> ActionOutcome {
        let Some(place) = self.grips.iter().position(|grip| grip.agent == agent) else {
            return fail(
                OutcomeCode::HandEmpty,
                "You hold nothing. Pick something first.",
                None,
            );
        };
        let object = self.grips[place].object;
        self.ungrip(state, place);
        let sentence = format!("You let go of the {}.", self.call(object));
        done(OutcomeCode::Done, sentence, Some(object))
    }

    /// Opens hands that hold more than they lift: since they took it they have become weaker, or it heavier.
    pub(crate) fn drop_too_heavy(&mut self, state: &mut State) {
        let mut place = 0;
        while place < self.grips.len() {
            let HeldObject {
                body,
                agent,
                object,
                ..
            } = self.grips[place];
            let handle = self.bodies[body as usize].handle;
            let mass = self.engine.bodies.get(handle).map_or(0.0, RigidBody::mass);
            let lift = state.agents[agent].body.lift_kg;
            if mass <= lift {
                place += 1;
                continue;
            }
            self.ungrip(state, place);
            let name = self.call(object);
            self.notices.push(DelayedOutcome {
                agent: Some(agent),
                outcome: fail(
                    OutcomeCode::TooHeavy,
                    format!(
                        "The {name} weighs {mass:.1} kg and you lift {lift:.1} kg now: it fell from your hand."
                    ),
                    Some(object),
                ),
            });
        }
    }

    /// Opens the hand that holds the grip at `place` of the list.
    pub(crate) fn ungrip(&mut self, state: &mut State, place: usize) {
        let grip = self.grips.remove(place);
        let velocity = state.agents[grip.agent].velocity;
        let body = grip.body as usize;
        let scale = self.gravity_scale(body);
        release(&mut self.engine, &self.bodies[body], scale, velocity);
        state.agents[grip.agent].holding = None;
        state.held_by[grip.object] = None;
        // The pair meets again once they have parted.
        self.released_overlapping.push((grip.body, grip.agent));
    }

    /// The share of its weight that a body has: none in a hand that holds it firmly, else what laws leave of it.
    pub(crate) fn gravity_scale(&self, body: usize) -> f32 {
        let carried = |grip: &HeldObject| grip.body as usize == body && grip.is_firm();
        if self.grips.iter().any(carried) {
            return 0.0;
        }
        self.weights.altered[body].map_or(1.0, |inertia| inertia.gravity_scale)
    }

    /// The bodies of an object.
    pub(crate) fn bodies_of(&self, object: ObjectId) -> Vec<usize> {
        let bodies = self.model().bodies.iter().enumerate();
        bodies
            .filter(|(_, plan)| plan.object == object)
            .map(|(index, _)| index)
            .collect()
    }
}
