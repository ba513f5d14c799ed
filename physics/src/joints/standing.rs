//! The joints of a tree that may move, as a step finds them and as it leaves them.

use super::Joint;
use super::chain::Chain;
use super::reading::{Coordinate, Reading};
use super::tree::Tree;
use crate::engine::Engine;

/// A tree in a step: made before it, and used again after it.
#[derive(Clone, Debug)]
pub(crate) struct Standing {
    /// The joints that may move, by their places in the tree. Shape (freedom,).
    pub(super) free: Vec<usize>,
    /// Shape (freedom,).
    pub(super) readings: Vec<Reading>,
    pub(super) chain: Chain,
}

impl Standing {
    /// `near`: the numbers of each of the world's joints. `None` for a tree that is asleep or shut.
    pub(super) fn of(
        engine: &Engine,
        tree: &Tree,
        joints: &[Joint],
        near: &[Coordinate],
    ) -> Option<Self> {
        let moves = |k: &usize| {
            let child = joints[tree.joints[*k]].child_handle;
            let body = engine.bodies.get(child);
            body.is_some_and(|body| body.is_dynamic() && !body.is_sleeping())
        };
        let free: Vec<usize> = (0..tree.joints.len()).filter(moves).collect();
        if free.is_empty() {
            return None;
        }
        let read = |k: &usize| {
            let place = tree.joints[*k];
            Reading::before(engine, &joints[place], near[place])
        };
        Some(Self {
            readings: free.iter().map(read).collect(),
            chain: Chain::of(engine, tree, &free, joints),
            free,
        })
    }

    /// Looks at the joints again, after the step. Returns how they were before.
    pub(super) fn again(&mut self, engine: &Engine, tree: &Tree, joints: &[Joint]) -> Vec<Reading> {
        let pairs = self.free.iter().zip(&self.readings);
        let now = pairs.map(|(k, reading)| reading.later(engine, &joints[tree.joints[*k]]));
        let now: Vec<Reading> = now.collect();
        std::mem::replace(&mut self.readings, now)
    }

    /// rad or m. Shape (freedom,).
    pub(super) fn positions(&self) -> Vec<f64> {
        self.readings.iter().map(|r| r.position).collect()
    }

    /// rad/s or m/s. Shape (freedom,).
    pub(super) fn velocities(&self) -> Vec<f64> {
        self.readings.iter().map(|r| r.velocity).collect()
    }

    /// The free joints. Shape (freedom,).
    pub(super) fn joints<'a>(&self, tree: &Tree, joints: &'a [Joint]) -> Vec<&'a Joint> {
        let place = |k: &usize| &joints[tree.joints[*k]];
        self.free.iter().map(place).collect()
    }
}
