//! Changes of agents' bodies while the world runs.

use super::movement::{agent_queries, other_agents};
use super::{Agent, Agents, current_body, resize_capsule};
use crate::dynamics::Dynamics;
use crate::error::PhysicsError;
use dwell_scene::{AgentBody, AgentState, Id, State};

/// Returns whether two bodies occupy the same space.
fn has_same_extents(a: &AgentBody, b: &AgentBody) -> bool {
    let room = |body: &AgentBody| (body.radius_m, body.height_m, body.step_height_m);
    room(a) == room(b)
}

impl Agents {
    /// Refuses bodies that would overlap something that they did not overlap before. Light objects give way. A body that
    /// overlapped something already may change as long as its core stays out of it.
    pub(crate) fn check_resize(
        &self,
        dynamics: &Dynamics,
        state: &State,
    ) -> Result<(), PhysicsError> {
        for ((id, agent), known) in state.agents.iter_ids().zip(&self.list) {
            let (now, was) = (current_body(agent), known.stands);
            agent.body.check()?;
            if has_same_extents(&now, &was) {
                continue;
            }
            let others = other_agents(state, id);
            let [now, was] = [now, was].map(|body| agent_queries(dynamics, body, id, &others));
            let feet = agent.position;
            let cramped = now.is_cylinder_blocked(feet) && !was.is_cylinder_blocked(feet);
            let inside = now.is_core_blocked(feet) && !was.is_core_blocked(feet);
            if cramped || inside {
                let body = &agent.body;
                return Err(PhysicsError::Range {
                    at: format!("agent {}", id.index()),
                    field: "body",
                    found: format!(
                        "radius {} m, height {} m, steps of {} m: it would stand in what is beside, above or under it",
                        body.radius_m, body.height_m, body.step_height_m
                    ),
                    allowed: "a body that has room where the agent stands; move the agent first",
                });
            }
        }
        Ok(())
    }

    /// Gives an agent's capsule the body of the state. Returns whether it changed.
    pub(crate) fn apply_resize(
        &mut self,
        dynamics: &mut Dynamics,
        index: usize,
        state: &AgentState,
    ) -> bool {
        let agent: &mut Agent = &mut self.list[index];
        let now = current_body(state);
        let same = has_same_extents(&now, &agent.stands);
        agent.stands = now;
        if !same {
            resize_capsule(&mut dynamics.engine, agent, state);
        }
        !same
    }
}
