//! What is asked in the episode that is played: steps, or a route.

use super::active_instruction::ActiveInstruction;
use super::active_route::ActiveRoute;
use crate::actions::DiscreteAction;
use crate::error::WorldError;
use crate::world::World;
use dwell_scene::{AgentId, ObjectId};

/// An instruction that is played.
#[derive(Debug)]
pub(super) enum ActiveForm {
    Steps(Box<ActiveInstruction>),
    Route(Box<ActiveRoute>),
}

impl ActiveForm {
    /// Counts what is done; returns how many steps became so. `pointed_at`: what the agent has just pointed at.
    pub(super) fn advance(
        &mut self,
        world: &World,
        agent: AgentId,
        pointed_at: Option<ObjectId>,
    ) -> usize {
        match self {
            Self::Steps(steps) => steps.advance(world, agent, pointed_at),
            Self::Route(route) => route.advance(world),
        }
    }

    /// The walkable way that is left, m.
    pub(super) fn distance_m(&self, world: &World) -> Option<f64> {
        match self {
            Self::Steps(steps) => steps.distance_m(world),
            Self::Route(route) => route.distance_m(world),
        }
    }

    /// Returns whether all is done, and still so.
    pub(super) fn is_fulfilled(&self, world: &World, agent: AgentId) -> bool {
        match self {
            Self::Steps(steps) => steps.is_fulfilled(world, agent),
            Self::Route(route) => route.is_fulfilled(world),
        }
    }

    /// The share of the conditions that hold, 0 to 1.
    pub(super) fn condition_success(&self, world: &World, agent: AgentId) -> f64 {
        match self {
            Self::Steps(steps) => steps.condition_success(world, agent),
            Self::Route(route) => route.condition_success(world),
        }
    }

    /// nDTW of a route so far; NaN for other forms, which have no way of their own.
    pub(super) fn ndtw(&self) -> f64 {
        match self {
            Self::Steps(_) => f64::NAN,
            Self::Route(route) => route.ndtw(),
        }
    }

    /// The action of the expert.
    pub(super) fn expert_action(&mut self, world: &World) -> DiscreteAction {
        match self {
            Self::Steps(steps) => steps.expert_action(world),
            Self::Route(route) => route.expert_action(world),
        }
    }

    /// What it keeps beside the world.
    pub(super) fn snapshot(&self) -> Vec<u8> {
        match self {
            Self::Steps(steps) => steps.snapshot(),
            Self::Route(route) => route.snapshot(),
        }
    }

    /// Takes over what a snapshot keeps.
    ///
    /// # Errors
    /// [`WorldError::Snapshot`] for bytes that are none of this instruction.
    pub(super) fn restore(
        &mut self,
        world: &World,
        agent: AgentId,
        bytes: &[u8],
    ) -> Result<(), WorldError> {
        match self {
            Self::Steps(steps) => steps.restore(world, agent, bytes),
            Self::Route(route) => route.restore(bytes),
        }
    }
}
