//! What tells things of one noun apart, counted once for all of them.

use super::expression::{Expression, Relation};
use crate::predicates;
use crate::scene::Scene;
use crate::size::Size;
use dwell_scene::interrupt::PollEvery;
use dwell_scene::{ObjectId, RoomId};
use std::cell::{OnceCell, RefCell};
use std::collections::BTreeMap;
use std::rc::Rc;

/// Relations that a landmark may stand in, the most telling first.
pub(super) const TELLING: [&str; 3] = ["in", "on", "next_to"];
/// Things between looks at whether they are still wanted.
const THINGS_PER_CHECK: usize = 64;

/// Something that a description says of a thing beside its noun.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Trait {
    Color(String),
    Material(String),
    Size(Size),
    Room(String),
}

/// A relation to something called `noun` that shows `colors`.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Mark {
    predicate: String,
    noun: String,
    colors: Vec<String>,
}

/// Rising.
pub(super) type Things = Rc<[ObjectId]>;
/// Things with what they stand in a relation to, by things.
type Pairs = Vec<(ObjectId, ObjectId)>;

/// The things that may be called by one noun. Who has a trait is listed once for each trait, so that a description costs no look
/// at all of them.
pub(crate) struct Alike {
    /// Rising.
    things: Things,
    in_rooms: BTreeMap<RoomId, usize>,
    having: OnceCell<BTreeMap<Trait, Things>>,
    /// Those that have some traits together.
    having_all: RefCell<BTreeMap<Vec<Trait>, Things>>,
    /// By predicate and the kind of what it leads to.
    pairs: OnceCell<BTreeMap<(&'static str, u32), Pairs>>,
    marked: RefCell<BTreeMap<Mark, Things>>,
}

/// At most `most` of what all lists have, which are rising; shorter lists are faster.
pub(super) fn common(lists: &[&[ObjectId]], most: usize) -> Vec<ObjectId> {
    let Some((shortest, list)) = lists.iter().enumerate().min_by_key(|(_, list)| list.len()) else {
        return Vec::new();
    };
    let others = || lists.iter().enumerate().filter(|(k, _)| *k != shortest);
    let in_all = |id: &ObjectId| others().all(|(_, other)| other.binary_search(id).is_ok());
    list.iter().copied().filter(in_all).take(most).collect()
}

fn push(lists: &mut BTreeMap<Trait, Vec<ObjectId>>, key: Trait, id: ObjectId) {
    let list = lists.entry(key).or_default();
    if list.last() != Some(&id) {
        list.push(id);
    }
}

impl Alike {
    pub(crate) fn gather(scene: &Scene<'_>, noun: &str) -> Self {
        let semantics = scene.semantics;
        let things = semantics.kinds().things(&semantics.kinds_called(noun));
        let mut pace = PollEvery::new(THINGS_PER_CHECK);
        let mut in_rooms = BTreeMap::new();
        for id in &things {
            pace.turn();
            if let Some(room) = scene.room_of(*id) {
                *in_rooms.entry(room).or_default() += 1;
            }
        }
        Self {
            things: things.into(),
            in_rooms,
            having: OnceCell::new(),
            having_all: RefCell::default(),
            pairs: OnceCell::new(),
            marked: RefCell::default(),
        }
    }

    /// How many of them each room holds, where it holds some.
    pub(crate) fn in_rooms(&self) -> &BTreeMap<RoomId, usize> {
        &self.in_rooms
    }

    fn having(&self, scene: &Scene<'_>) -> &BTreeMap<Trait, Things> {
        self.having.get_or_init(|| {
            let mut pace = PollEvery::new(THINGS_PER_CHECK);
            let mut lists: BTreeMap<Trait, Vec<ObjectId>> = BTreeMap::new();
            for id in self.things.iter().copied() {
                pace.turn();
                let facts = scene.facts(id);
                push(&mut lists, Trait::Size(facts.size), id);
                for (word, _) in &facts.colors {
                    push(&mut lists, Trait::Color((*word).to_owned()), id);
                }
                for word in facts.adjectives() {
                    push(&mut lists, Trait::Material(word.to_owned()), id);
                }
                let Some(room) = scene.room_of(id) else {
                    continue;
                };
                let room = scene.semantics.room(room);
                for name in room.names.iter().chain([&room.label]) {
                    push(&mut lists, Trait::Room(name.clone()), id);
                }
            }
            let lists = lists.into_iter();
            lists.map(|(key, list)| (key, list.into())).collect()
        })
    }

    /// Those that a description with their noun fits, its relation left aside; rising.
    pub(super) fn fitting(&self, scene: &Scene<'_>, expression: &Expression) -> Things {
        let colors = expression.colors.iter().cloned().map(Trait::Color);
        let material = expression.material.iter().cloned().map(Trait::Material);
        let size = expression.size.map(Trait::Size);
        let room = expression.room.iter().cloned().map(Trait::Room);
        let traits: Vec<Trait> = colors.chain(material).chain(size).chain(room).collect();
        if traits.is_empty() {
            return self.things.clone();
        }
        if let Some(known) = self.having_all.borrow().get(&traits) {
            return known.clone();
        }
        let having = self.having(scene);
        let lists: Option<Vec<&[ObjectId]>> = traits
            .iter()
            .map(|key| having.get(key).map(|list| &**list))
            .collect();
        let found = lists.map_or_else(Vec::new, |lists| common(&lists, usize::MAX));
        let found: Things = found.into();
        let mut known = self.having_all.borrow_mut();
        known.insert(traits, found.clone());
        found
    }

    fn pairs(&self, scene: &Scene<'_>) -> &BTreeMap<(&'static str, u32), Pairs> {
        self.pairs.get_or_init(|| {
            let mut pace = PollEvery::new(1);
            let mut pairs: BTreeMap<(&'static str, u32), Pairs> = BTreeMap::new();
            for predicate in predicates::all() {
                if !TELLING.contains(&predicate.name()) {
                    continue;
                }
                for id in self.things.iter().copied() {
                    pace.turn();
                    for other in predicates::related_objects(scene, *predicate, id) {
                        let kind = scene.semantics.kinds().of(other);
                        let list = pairs.entry((predicate.name(), kind)).or_default();
                        list.push((id, other));
                    }
                }
            }
            pairs
        })
    }

    /// Those that have a telling relation to something that its landmark fits; rising.
    pub(super) fn marked(&self, scene: &Scene<'_>, relation: &Relation) -> Things {
        let landmark = &relation.landmark;
        let mark = Mark {
            predicate: relation.predicate.clone(),
            noun: landmark.noun.clone(),
            colors: landmark.colors.clone(),
        };
        if let Some(known) = self.marked.borrow().get(&mark) {
            return known.clone();
        }
        let pairs = self.pairs(scene);
        let name = TELLING.iter().find(|name| **name == relation.predicate);
        let mut found: Vec<ObjectId> = Vec::new();
        for kind in scene.semantics.kinds_called(&landmark.noun) {
            let pairs = name.and_then(|name| pairs.get(&(*name, kind)));
            for (id, other) in pairs.into_iter().flatten() {
                if found.last() != Some(id) && landmark.fits_object(scene, *other) {
                    found.push(*id);
                }
            }
        }
        found.sort_unstable();
        found.dedup();
        let found: Things = found.into();
        let mut known = self.marked.borrow_mut();
        known.insert(mark, found.clone());
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::Id;

    #[test]
    fn lists_have_in_common_what_all_of_them_hold() {
        let ids = |all: &[usize]| -> Vec<ObjectId> {
            all.iter().map(|k| ObjectId::from_index(*k)).collect()
        };
        let (a, b, c) = (ids(&[1, 2, 4, 8, 9]), ids(&[2, 3, 4, 9]), ids(&[0, 2, 9]));
        assert_eq!(common(&[&a, &b, &c], usize::MAX), ids(&[2, 9]));
        assert_eq!(common(&[&a, &b, &c], 1), ids(&[2]));
        assert_eq!(common(&[&a], 2), ids(&[1, 2]));
        assert!(common(&[&a, &[]], 2).is_empty());
        assert!(common(&[], 2).is_empty());
    }
}
