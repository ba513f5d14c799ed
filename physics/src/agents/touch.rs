//! What agents' bodies, and the objects in their hands, touch now.

use super::{Agents, movement};
use crate::contact::{ContactEntity, entry_index};
use crate::dynamics::Dynamics;
use dwell_scene::space::forward_from_yaw;
use dwell_scene::{AgentId, Id, State};
use glam::Vec3;
use rapier3d::geometry::{Collider, ContactPair};
use std::f32::consts::TAU;

/// Directions in which a body looks for what it touches.
const DIRECTIONS: u32 = 16;
/// Gap, besides the skin that movements leave, up to which a body touches, m.
const TOUCH_M: f32 = 0.005;
/// Least horizontal component of the direction of a contact beside a body: what lies on it or under it is not beside it.
const BESIDE: f32 = 0.5;

/// Something that an agent's body touches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyContact {
    /// From the body's axis to it, horizontal, unit length, in world space.
    pub direction: Vec3,
    /// The force with which it pressed on the body in the last physics step, N; 0 for what does not move freely.
    pub force_n: f32,
}

/// What an agent touches.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AgentContacts {
    /// Beside its body; a thing may be there several times.
    pub body: Vec<BodyContact>,
    /// The force between the held object and what it touches in the last physics step, N; `None` where it touches nothing or
    /// nothing is held.
    pub held_force_n: Option<f32>,
}

impl Agents {
    /// Returns what an agent touches; nothing for one that does not exist.
    pub(crate) fn touch(
        &self,
        dynamics: &Dynamics,
        state: &State,
        agent: AgentId,
    ) -> AgentContacts {
        let mut body = self.obstacles_beside(dynamics, state, agent);
        body.extend(self.pressing_bodies(dynamics, agent));
        AgentContacts {
            body,
            held_force_n: held_object_force(dynamics, state, agent),
        }
    }

    /// Returns the obstacles that stop the body's movements where it stands.
    fn obstacles_beside(
        &self,
        dynamics: &Dynamics,
        state: &State,
        id: AgentId,
    ) -> Vec<BodyContact> {
        let Some(agent) = state
            .agents
            .get(id)
            .filter(|_| id.index() < self.list.len())
        else {
            return Vec::new();
        };
        let others = movement::other_agents(state, id);
        let queries = movement::current_agent_queries(dynamics, agent, id, &others);
        let touch = |k: u32| {
            let way = forward_from_yaw(agent.yaw_rad + TAU * k as f32 / DIRECTIONS as f32);
            let hit = queries.cast(agent.position, way * TOUCH_M)?;
            let towards = -hit.normal.with_y(0.0);
            Some(BodyContact {
                direction: if towards.length() > 0.05 {
                    towards.normalize_or_zero()
                } else {
                    way
                },
                force_n: 0.0,
            })
        };
        (0..DIRECTIONS).filter_map(touch).collect()
    }

    /// Returns the bodies that press on an agent's capsule from beside it.
    fn pressing_bodies(&self, dynamics: &Dynamics, agent: AgentId) -> Vec<BodyContact> {
        let engine = &dynamics.engine;
        let entry = self.list.get(agent.index()).map(|agent| agent.entry);
        // Colliders are inserted in the order of entries and never removed.
        let own = entry.and_then(|entry| engine.colliders.get_unknown_gen(entry));
        let Some((_, own)) = own else {
            return Vec::new();
        };
        let mut found = Vec::new();
        for pair in engine.narrow_phase.contact_pairs_with(own) {
            // Normals point from the first collider to the second.
            let (sign, other) = if pair.collider1 == own {
                (1.0, pair.collider2)
            } else {
                (-1.0, pair.collider1)
            };
            let Some(other) = engine.colliders.get(other).map(entry_index) else {
                continue;
            };
            for plane in pair.solver_manifolds() {
                let impulses = plane.points.iter().map(|point| point.data.impulse);
                let impulse: f32 = impulses.sum();
                let direction = (plane.data.normal * sign).with_y(0.0);
                if impulse > 0.0 && direction.length() > BESIDE {
                    let touch = BodyContact {
                        direction: direction.normalize_or_zero(),
                        force_n: impulse / engine.solver_call_s(),
                    };
                    found.push((other, touch));
                }
            }
        }
        // rapier's order of pairs is unspecified.
        found.sort_by_key(|(other, touch)| (*other, touch.force_n.to_bits()));
        found.into_iter().map(|(_, touch)| touch).collect()
    }
}

/// Returns the force between the object that an agent holds and what it touches, N; `None` where it touches nothing.
fn held_object_force(dynamics: &Dynamics, state: &State, agent: AgentId) -> Option<f32> {
    let held = state.agents.get(agent)?.holding?;
    let (engine, house) = (&dynamics.engine, &dynamics.model.house);
    let entity = |collider: &Collider| {
        let entry = dynamics.entries.get(entry_index(collider))?;
        entry.contact_entity
    };
    let is_held = |entity: ContactEntity| matches!(entity, ContactEntity::Part(part) if house.parts[part].object == held);
    let distance_m = dynamics.settings.config.touch_distance_m;
    let impulse = |pair: &ContactPair| {
        let colliders = [pair.collider1, pair.collider2];
        let [a, b] = colliders.map(|handle| engine.colliders.get(handle).and_then(entity));
        if is_held(a?) == is_held(b?) {
            return None;
        }
        let planes = pair.solver_manifolds().iter();
        let points = planes.flat_map(|plane| &plane.points);
        points
            .filter(|point| point.data.impulse > 0.0 || point.dist <= distance_m)
            .map(|point| point.data.impulse)
            .reduce(|sum, impulse| sum + impulse)
    };
    let mut impulses: Vec<f32> = engine
        .narrow_phase
        .contact_pairs()
        .filter_map(impulse)
        .collect();
    // rapier's order of pairs is unspecified.
    impulses.sort_by(f32::total_cmp);
    (!impulses.is_empty()).then(|| impulses.iter().sum::<f32>() / engine.solver_call_s())
}
