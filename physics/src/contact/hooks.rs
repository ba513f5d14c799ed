//! What rapier asks during a step: which pairs meet, and with what friction.

use super::entry::{Entry, entry_index};
use super::substances::ContactTable;
use dwell_scene::AgentId;
use rapier3d::geometry::SolverFlags;
use rapier3d::pipeline::{ContactModificationContext, PairFilterContext, PhysicsHooks};
use serde::{Deserialize, Serialize};

/// Pairs that do not meet.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Excluded {
    /// A body and an entry, sorted: what a door's leaf overlaps where it stands shut.
    pub(crate) entries: Vec<(u32, u32)>,
    /// A body and the agent that holds it or has just let go of it, sorted.
    pub(crate) carriers: Vec<(u32, AgentId)>,
}

impl Excluded {
    fn meets(&self, entries: &[Entry], a: usize, b: usize) -> bool {
        let one_way = |a: usize, b: usize| {
            let Some(body) = entries.get(a).and_then(|entry| entry.body) else {
                return true;
            };
            let with_agent = entries.get(b).and_then(Entry::agent);
            let carried =
                with_agent.is_some_and(|agent| self.carriers.binary_search(&(body, agent)).is_ok());
            !carried && self.entries.binary_search(&(body, b as u32)).is_err()
        };
        one_way(a, b) && one_way(b, a)
    }

    pub(crate) fn carry(&mut self, body: u32, agent: AgentId) {
        if let Err(place) = self.carriers.binary_search(&(body, agent)) {
            self.carriers.insert(place, (body, agent));
        }
    }

    pub(crate) fn part(&mut self, body: u32, agent: AgentId) {
        self.carriers.retain(|pair| *pair != (body, agent));
    }
}

/// The callbacks of one step.
pub(crate) struct Hooks<'a> {
    pub(crate) entries: &'a [Entry],
    pub(crate) table: &'a ContactTable,
    pub(crate) excluded: &'a Excluded,
}

impl PhysicsHooks for Hooks<'_> {
    fn filter_contact_pair(&self, context: &PairFilterContext) -> Option<SolverFlags> {
        let a = entry_index(&context.colliders[context.collider1]);
        let b = entry_index(&context.colliders[context.collider2]);
        self.excluded
            .meets(self.entries, a, b)
            .then(SolverFlags::default)
    }

    fn modify_solver_contacts(&self, context: &mut ContactModificationContext) {
        let a = entry_index(&context.colliders[context.collider1]);
        let b = entry_index(&context.colliders[context.collider2]);
        let (Some(a), Some(b)) = (self.entries.get(a), self.entries.get(b)) else {
            return;
        };
        if let Some(manifold) = context.rigid_mut() {
            let class_a = a.surface.class(manifold.manifold.subshape1);
            let class_b = b.surface.class(manifold.manifold.subshape2);
            let pair = self.table.pair(class_a, class_b);
            *manifold.friction = pair.friction;
            *manifold.restitution = pair.restitution;
        }
    }
}
