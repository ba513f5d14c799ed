//! Taking and letting go.

use super::outcome::{ActionCode, ActionOutcome, done, fail};
use crate::agents::{Grip, hand_pose, release};
use crate::body::Hold;
use crate::convert::{from_rapier, to_rapier};
use crate::world::PhysicsWorld;
use dwell_scene::rays::RayScene;
use dwell_scene::{AgentId, Mobility, ObjectId, State};

/// Places between the hand and where a thing lies that are tried for it when it is taken.
const TRIES: u32 = 6;

impl PhysicsWorld {
    pub(super) fn pick(
        &mut self,
        state: &mut State,
        rays: &RayScene,
        agent: AgentId,
        object: ObjectId,
    ) -> ActionOutcome {
        let holder = state.agents[agent];
        let name = self.call(object);
        if let Some(held) = holder.holding {
            let held = self.call(held);
            let sentence = format!("You hold the {held} already. Drop it first.");
            return fail(ActionCode::HandFull, sentence, Some(object));
        }
        if let Some(other) = state.held_by[object] {
            let sentence = format!("Agent {} holds the {name}. Wait until it is free.", other.0);
            return fail(ActionCode::HeldByOther, sentence, Some(object));
        }
        let thing = &self.model().house.objects[object];
        let bodies: Vec<usize> = self.bodies_of(object);
        let whole = thing.mobility == Mobility::Movable && bodies.len() == 1;
        if !thing.pickable || !whole {
            let sentence = format!("The {name} is not a thing to take. Choose something that is.");
            return fail(ActionCode::NotPickable, sentence, Some(object));
        }
        let body = bodies[0];
        if let Some(refusal) = self.refuse_reach(state, rays, &holder, object) {
            return refusal;
        }
        if self.holds[body] != Hold::Free {
            let sentence = format!("The {name} is stuck where it stands. Choose something else.");
            return fail(ActionCode::Stuck, sentence, Some(object));
        }
        let rigid = &self.engine.bodies[self.bodies[body].handle];
        let (mass, lift) = (rigid.mass(), holder.body.lift_kg);
        if mass > lift {
            let sentence = format!(
                "The {name} weighs {mass:.1} kg; you lift {lift:.1} kg. Choose something lighter."
            );
            return fail(ActionCode::TooHeavy, sentence, Some(object));
        }
        let place = *rigid.position();
        let size = self.model().bodies[body]
            .bounds(&place)
            .size()
            .max_element();
        let most = self.settings.config.max_carry_size_m;
        if size > most {
            let sentence = format!(
                "The {name} is {size:.1} m long; you carry up to {most:.1} m. Choose something smaller."
            );
            return fail(ActionCode::TooLarge, sentence, Some(object));
        }
        let grip = Grip::new(
            self.model(),
            body as u32,
            agent,
            &holder,
            &from_rapier(&place),
        );
        self.grips.push(grip);
        self.grips.sort_by_key(|grip| grip.agent);
        self.excluded.carry(body as u32, agent);
        let target = to_rapier(&hand_pose(&grip, &holder));
        let clear = self.clear_between(body, &place, &target);
        if let Some(rigid) = self.engine.bodies.get_mut(self.bodies[body].handle) {
            rigid.set_gravity_scale(0.0, true);
            rigid.set_linvel(glam::Vec3::ZERO, true);
            rigid.set_angvel(glam::Vec3::ZERO, true);
            if let Some(clear) = clear {
                rigid.set_position(clear, true);
            }
        }
        state.agents[agent].holding = Some(object);
        state.held_by[object] = Some(agent);
        self.flush();
        self.write_bodies(state);
        let sentence = format!("You hold the {name}.");
        done(ActionCode::Done, sentence, Some(object))
    }

    /// The place nearest to the hand, on the straight way to where a thing is, where it overlaps nothing solid.
    fn clear_between(
        &self,
        body: usize,
        from: &rapier3d::math::Pose,
        to: &rapier3d::math::Pose,
    ) -> Option<rapier3d::math::Pose> {
        (0..TRIES).find_map(|k| {
            let share = k as f32 / TRIES as f32;
            let mut place = *to;
            place.translation = to.translation.lerp(from.translation, share);
            self.is_clear(body, &place).then_some(place)
        })
    }

    pub(super) fn let_go(&mut self, state: &mut State, agent: AgentId) -> ActionOutcome {
        let Some(place) = self.grips.iter().position(|grip| grip.agent == agent) else {
            return fail(
                ActionCode::HandEmpty,
                "You hold nothing. Pick something first.",
                None,
            );
        };
        let object = self.grips[place].object;
        self.ungrip(state, place);
        let sentence = format!("You let go of the {}.", self.call(object));
        done(ActionCode::Done, sentence, Some(object))
    }

    /// Opens the hand that holds the grip at `place` of the list.
    pub(crate) fn ungrip(&mut self, state: &mut State, place: usize) {
        let grip = self.grips.remove(place);
        let velocity = state.agents[grip.agent].velocity;
        release(&mut self.engine, &self.bodies[grip.body as usize], velocity);
        state.agents[grip.agent].holding = None;
        state.held_by[grip.object] = None;
        // The pair meets again once they have parted.
        self.parting.push((grip.body, grip.agent));
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
