//! Free places to start for agents, beside those that have their starts already.

use crate::world::World;
use dwell_scene::navigation::{NavCell, NavGrid};
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentBody, AgentId};
use glam::Vec3;

/// Between the bodies of two agents at their starts, m.
const APART_M: f32 = 0.1;

/// The floor that agents with a start leave free.
pub(super) struct FreeStartCells {
    /// Their positions, each with the least distance of the new agent's middle, m.
    taken: Vec<(Vec3, f32)>,
}

impl FreeStartCells {
    /// For an agent of this body beside `placed`.
    pub(super) fn excluding_agents(world: &World, placed: &[AgentId], body: &AgentBody) -> Self {
        let agents = placed.iter().filter_map(|id| world.state().agents.get(*id));
        let taken = agents
            .map(|agent| {
                let apart_m = agent.body.radius_m + body.radius_m + APART_M;
                (agent.position, apart_m)
            })
            .collect();
        Self { taken }
    }

    /// A cell of those that are allowed, drawn from `key` as if nobody had a start yet; drawn anew among those that are left only
    /// where it is taken, so that company that is out of the way changes nothing.
    pub(super) fn sample(
        &self,
        grid: &NavGrid,
        key: RandomKey,
        allowed: impl Fn(NavCell) -> bool,
    ) -> Option<NavCell> {
        let first = grid.sample(key, &allowed)?;
        if self.holds(grid.position(first)) {
            return Some(first);
        }
        grid.sample(key.child("beside"), |cell| {
            self.holds(grid.position(cell)) && allowed(cell)
        })
    }

    /// Returns whether the agent can stand at `feet`, m.
    pub(super) fn holds(&self, feet: Vec3) -> bool {
        let mut taken = self.taken.iter();
        taken.all(|(position, apart_m)| position.distance(feet) >= *apart_m)
    }
}
