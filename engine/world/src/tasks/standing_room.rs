//! Free places to start for agents, beside those that have their starts already.

use super::door_leaves::DoorLeaves;
use crate::world::World;
use dwell_scene::navigation::{NavCell, NavGrid};
use dwell_scene::random::RandomKey;
use dwell_scene::{AgentBody, AgentId, LevelId};
use glam::Vec3;

/// Between the bodies of two agents at their starts, m.
const APART_M: f32 = 0.1;

/// A start anywhere on the largest island of a grid, or on one storey of it, drawn from `key`: clear of the leaves of doors and of those who have their starts.
pub(super) fn sample_start(
    world: &World,
    placed: &[AgentId],
    (grid, body, storey): (&NavGrid, &AgentBody, Option<LevelId>),
    key: RandomKey,
) -> Option<NavCell> {
    let leaves = DoorLeaves::of(world, grid);
    let allowed = |cell: NavCell| {
        grid.island(cell) == Some(0)
            && (storey.is_none() || grid.level(cell) == storey)
            && !leaves.is_blocked(grid, cell)
    };
    FreeStartCells::excluding_agents(world, placed, body).sample(grid, key, allowed)
}

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
        if self.is_free(grid.position(first)) {
            return Some(first);
        }
        grid.sample(key.child("beside"), |cell| {
            self.is_free(grid.position(cell)) && allowed(cell)
        })
    }

    /// Returns whether the agent can stand at `feet`, m.
    pub(super) fn is_free(&self, feet: Vec3) -> bool {
        let mut taken = self.taken.iter();
        taken.all(|(position, apart_m)| position.distance(feet) >= *apart_m)
    }
}
