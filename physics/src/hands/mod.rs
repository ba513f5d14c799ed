//! Hands: objects that agents hold, and those just released.

mod edge_grip;
mod grasp;
mod held_object;

pub use edge_grip::BOTH_HANDS;
pub(crate) use edge_grip::edge_point;
pub use grasp::Grasp;
pub(crate) use held_object::{HeldObject, held_body_target_pose};

use crate::dynamics::Dynamics;
use crate::outcome::{DelayedOutcome, OutcomeCode, fail};
use dwell_scene::{Aabb, AgentId, AgentState, State};
use glam::Vec3;
use held_object::{HandGrasp, release};
use rapier3d::dynamics::RigidBody;

/// The hands of all agents.
#[derive(Clone, Debug, Default)]
pub(crate) struct Hands {
    /// Held objects, by agent.
    pub(crate) held_objects: Vec<HeldObject>,
    /// Released bodies that still overlap the agent that held them.
    pub(crate) released_overlapping: Vec<(u32, AgentId)>,
}

impl Hands {
    /// Returns whether some hand holds a body or has just released it.
    pub(crate) fn holds_or_just_released(&self, body: usize) -> bool {
        self.held_objects
            .iter()
            .any(|grip| grip.body as usize == body)
            || self
                .released_overlapping
                .iter()
                .any(|(released, _)| *released as usize == body)
    }

    /// Opens hands that hold more than they can lift, after a change of their strength or of the object's mass.
    pub(crate) fn drop_too_heavy(
        &mut self,
        dynamics: &mut Dynamics,
        state: &mut State,
        notices: &mut Vec<DelayedOutcome>,
    ) {
        self.update_lifts(dynamics, state);
        let mut place = 0;
        while place < self.held_objects.len() {
            if self.held_objects[place].edge().is_some() {
                place += 1;
                continue;
            }
            let HeldObject {
                body,
                agent,
                object,
                ..
            } = self.held_objects[place];
            let handle = dynamics.bodies[body as usize].handle;
            let mass = dynamics
                .engine
                .bodies
                .get(handle)
                .map_or(0.0, RigidBody::mass);
            let lift = state.agents[agent].body.lift_kg;
            if mass <= lift {
                place += 1;
                continue;
            }
            self.open_hand(dynamics, state, place);
            let name = dynamics.name_of(object);
            notices.push(DelayedOutcome {
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

    /// Opens the hand of the grip at index `place`.
    pub(crate) fn open_hand(&mut self, dynamics: &mut Dynamics, state: &mut State, place: usize) {
        let grip = self.held_objects.remove(place);
        if grip.edge().is_some() {
            self.release_edge(dynamics, state, &grip);
            return;
        }
        let velocity = state.agents[grip.agent].velocity;
        let body = grip.body as usize;
        let scale = self.gravity_scale(dynamics, body);
        release(
            &mut dynamics.engine,
            &dynamics.bodies[body],
            scale,
            velocity,
        );
        state.agents[grip.agent].holding = None;
        state.held_by[grip.object] = None;
        // The pair collides again once they have parted.
        self.released_overlapping.push((grip.body, grip.agent));
    }

    /// Returns the share of its weight that a body has: none in a firm grasp, else as laws set it.
    pub(crate) fn gravity_scale(&self, dynamics: &Dynamics, body: usize) -> f32 {
        let carried = |grip: &HeldObject| grip.body as usize == body && grip.has_kinematic_grasp();
        if self.held_objects.iter().any(carried) {
            return 0.0;
        }
        dynamics.masses.overridden[body].map_or(1.0, |inertia| inertia.gravity_scale)
    }

    /// Moves held objects for one physics step, and opens the hands from which one slips.
    pub(crate) fn step_held_objects(
        &mut self,
        dynamics: &mut Dynamics,
        state: &mut State,
        notices: &mut Vec<DelayedOutcome>,
    ) {
        self.drop_distant_edges(dynamics, state, notices);
        let mut place = 0;
        while place < self.held_objects.len() {
            if self.held_objects[place].edge().is_some() {
                place += 1;
                continue;
            }
            let agent = state.agents[self.held_objects[place].agent];
            let body = dynamics.bodies[self.held_objects[place].body as usize];
            let grip = &mut self.held_objects[place];
            let dt_s = dynamics.settings.dt_s;
            let slips =
                held_object::pull_towards_hand(&mut dynamics.engine, &body, grip, &agent, dt_s);
            if !slips {
                place += 1;
                continue;
            }
            let (holder, object) = (grip.agent, grip.object);
            self.open_hand(dynamics, state, place);
            let name = dynamics.name_of(object);
            notices.push(DelayedOutcome {
                agent: Some(holder),
                outcome: fail(
                    OutcomeCode::Slipped,
                    format!("The {name} was caught on something and slipped from your hand."),
                    Some(object),
                ),
            });
        }
    }

    /// Moves back bodies that were pressed through a thin wall in the last physics step. Contacts stop a held object, but a
    /// hand that presses a thin card against a thin wall overcomes them.
    pub(crate) fn undo_wall_penetration(&self, dynamics: &mut Dynamics) {
        let mut moved = false;
        for place in 0..self.held_objects.len() {
            let grip = self.held_objects[place];
            if grip.edge().is_some() {
                continue;
            }
            let handle = dynamics.bodies[grip.body as usize].handle;
            let Some(now) = dynamics
                .engine
                .bodies
                .get(handle)
                .map(|rigid| *rigid.position())
            else {
                continue;
            };
            let middle = grip.center_at(&now);
            if middle == grip.last_center
                || dynamics
                    .first_reach_obstacle(grip.last_center, middle)
                    .is_none()
            {
                continue;
            }
            if let Some(rigid) = dynamics.engine.bodies.get_mut(handle) {
                let mut back = now;
                back.translation += grip.last_center - middle;
                rigid.set_position(back, true);
                rigid.set_linvel(Vec3::ZERO, true);
                moved = true;
            }
        }
        if moved {
            dynamics.flush();
        }
    }

    /// Lets bodies and the agents that held them collide again once they are apart.
    pub(crate) fn restore_holder_collisions(&mut self, dynamics: &mut Dynamics, state: &State) {
        if self.released_overlapping.is_empty() {
            return;
        }
        let mut still = Vec::new();
        for (body, agent) in std::mem::take(&mut self.released_overlapping) {
            let held_again = self
                .held_objects
                .iter()
                .any(|grip| (grip.body, grip.agent) == (body, agent));
            if held_again {
                continue;
            }
            let rigid = dynamics
                .engine
                .bodies
                .get(dynamics.bodies[body as usize].handle);
            let apart = rigid.is_none_or(|rigid| {
                let bounds = dynamics.model.bodies[body as usize].bounds(rigid.position());
                !bounds.intersects(&agent_bounds(&state.agents[agent]).grown(0.01))
            });
            if apart {
                dynamics.collision_exclusions.include_released(body, agent);
            } else {
                still.push((body, agent));
            }
        }
        self.released_overlapping = still;
    }
}

fn agent_bounds(agent: &AgentState) -> Aabb {
    let r = agent.body.radius_m;
    Aabb::new(
        agent.position - Vec3::new(r, 0.0, r),
        agent.position + Vec3::new(r, agent.height_m(), r),
    )
}
