//! Doors that what is in the hand keeps from opening: an expert puts it down, opens them, and fetches it again.

use super::ShortestPathFollower;
use crate::actions::{DiscreteAction, StepSizes};
use crate::world::World;
use dwell_scene::navigation::NavGrid;
use dwell_scene::{AgentId, ObjectId};
use std::sync::Arc;

/// Control steps for which a door is opened with a thing in the hand; then the thing is put down first.
const OPENING: u32 = 100;
/// Control steps for which the door is then opened, and turns that are made away from it before the hand lets go.
const OPENING_EMPTY: u32 = 240;
const TURNS_DEG: f32 = 120.0;
/// A door is open enough to pass from this share on.
const OPEN_ENOUGH: f32 = 0.8;

/// A door that a thing in the hand keeps from opening.
#[derive(Debug)]
struct BlockedDoor {
    door: ObjectId,
    /// Turns that are left until it lets go of the thing.
    turns: u32,
    /// Control steps for which it has been opening.
    opening: u32,
    follower: ShortestPathFollower,
}

/// Notices such doors on an agent's way, and opens them.
#[derive(Debug)]
pub(crate) struct BlockedDoors {
    agent: AgentId,
    grid: Arc<NavGrid>,
    stride: StepSizes,
    /// Control steps for which it has been opening a door with a full hand.
    opening: u32,
    blocked: Option<BlockedDoor>,
}

impl BlockedDoors {
    /// None yet.
    pub(crate) fn new((agent, grid, stride): (AgentId, &Arc<NavGrid>, StepSizes)) -> Self {
        Self {
            agent,
            grid: grid.clone(),
            stride,
            opening: 0,
            blocked: None,
        }
    }

    /// Notes the next action of the agent.
    pub(crate) fn count(&mut self, world: &World, action: DiscreteAction) {
        let Some(agent) = world.state().agents.get(self.agent) else {
            return;
        };
        if action == DiscreteAction::Open && agent.holding.is_some() {
            self.opening += 1;
        }
        if action == DiscreteAction::MoveForward {
            self.opening = self.opening.saturating_sub(1);
        }
        let door = world.object_in_view_centre(self.agent);
        if self.opening > OPENING
            && let Some(door) = door
            && let Some(here) = self.grid.nearest(agent.position, 0.6)
        {
            self.opening = 0;
            let turn = self.stride.turn_deg.max(1.0);
            self.blocked = Some(BlockedDoor {
                door,
                turns: (TURNS_DEG / turn).ceil() as u32,
                opening: 0,
                follower: ShortestPathFollower::new(
                    self.agent,
                    self.grid.clone(),
                    &[here],
                    self.stride,
                ),
            });
        }
    }

    /// The next action at such a door; `None` where there is none.
    pub(crate) fn next_action(&mut self, world: &World) -> Option<DiscreteAction> {
        let blocked = self.blocked.as_mut()?;
        let agent = world.state().agents.get(self.agent)?;
        if agent.holding.is_some() {
            if let Some(left) = blocked.turns.checked_sub(1) {
                blocked.turns = left;
                return Some(DiscreteAction::TurnLeft);
            }
            return Some(DiscreteAction::Drop);
        }
        let openness = world.state().openness(world.house(), blocked.door);
        blocked.opening += 1;
        if openness.is_none_or(|open| open >= OPEN_ENOUGH) || blocked.opening > OPENING_EMPTY {
            self.blocked = None;
            return None;
        }
        Some(blocked.follower.action_to_open(world, blocked.door))
    }
}
