//! Where agents have room to start beside those who have their starts already.

use crate::world::World;
use dwell_scene::{AgentBody, AgentId};
use glam::Vec3;

/// Between the bodies of two agents at their starts, m.
const APART_M: f32 = 0.1;

/// What agents who have their starts leave free.
pub(super) struct StandingRoom {
    /// Where they stand, and how far from there the agent's middle must be, m.
    taken: Vec<(Vec3, f32)>,
}

impl StandingRoom {
    /// For an agent of this body beside `placed`.
    pub(super) fn beside(world: &World, placed: &[AgentId], body: &AgentBody) -> Self {
        let agents = placed.iter().filter_map(|id| world.state().agents.get(*id));
        let taken = agents
            .map(|agent| {
                let apart_m = agent.body.radius_m + body.radius_m + APART_M;
                (agent.position, apart_m)
            })
            .collect();
        Self { taken }
    }

    /// Returns whether the agent can stand at `feet`, m.
    pub(super) fn holds(&self, feet: Vec3) -> bool {
        let mut taken = self.taken.iter();
        taken.all(|(position, apart_m)| position.distance(feet) >= *apart_m)
    }
}
