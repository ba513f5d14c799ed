//! An index of things by their nouns.

use crate::facts::ObjectFacts;
use dwell_scene::{IdVec, ObjectId};
use std::collections::BTreeMap;

/// Things with the same nouns.
#[derive(Debug)]
struct NounClass {
    /// One of them, for its words.
    first: ObjectId,
    /// All of them, ascending.
    things: Vec<ObjectId>,
}

/// The things of a house by their nouns, so that words are compared once for a kind, not for each thing.
#[derive(Debug, Default)]
pub(crate) struct NounIndex {
    all: Vec<NounClass>,
    /// Shape (object,).
    of: IdVec<ObjectId, u32>,
}

impl NounIndex {
    pub(crate) fn gather(facts: &IdVec<ObjectId, ObjectFacts>) -> Self {
        let mut known: BTreeMap<(&str, Option<&str>), u32> = BTreeMap::new();
        let mut kinds = Self::default();
        for (id, facts) in facts.iter_ids() {
            let row = facts.category.map(|row| row.name);
            let next = kinds.all.len() as u32;
            let kind = *known.entry((&facts.noun, row)).or_insert(next);
            if kind == next {
                let things = Vec::new();
                kinds.all.push(NounClass { first: id, things });
            }
            kinds.all[kind as usize].things.push(id);
            kinds.of.push(kind);
        }
        kinds
    }

    /// The number of a thing's kind.
    pub(crate) fn kind_of(&self, object: ObjectId) -> u32 {
        self.of[object]
    }

    /// The numbers of the kinds that may be called `noun`.
    pub(crate) fn kinds_called(
        &self,
        facts: &IdVec<ObjectId, ObjectFacts>,
        noun: &str,
    ) -> Vec<u32> {
        let kinds = self.all.iter().enumerate();
        let called = kinds.filter(|(_, kind)| facts[kind.first].is_called(noun));
        called.map(|(k, _)| k as u32).collect()
    }

    /// The things of some kinds, ascending.
    pub(crate) fn objects_of_kinds(&self, kinds: &[u32]) -> Vec<ObjectId> {
        let kinds = kinds.iter().map(|kind| &self.all[*kind as usize]);
        let mut things: Vec<ObjectId> =
            kinds.flat_map(|kind| kind.things.iter().copied()).collect();
        things.sort_unstable();
        things
    }
}
