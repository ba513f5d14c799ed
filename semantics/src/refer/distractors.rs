//! Distinguishing attributes of things of one noun, counted once for all of them.

use crate::color::ColorVocabulary;
use crate::form::{Description, Modifier, Noun, Phrase};
use crate::predicates;
use crate::scene::{
    Attribute, DistractorSet, LandmarkQuery, MOST_NEAR, ObjectList, RelatedPairs, SemanticScene,
};
use crate::size::SizeClass;
use dwell_scene::interrupt::CancelPoller;
use dwell_scene::{ObjectId, RoomId};
use std::cell::{OnceCell, RefCell};
use std::collections::BTreeMap;
use std::rc::Rc;

/// Relations to landmarks, the most informative first.
pub(super) const TELLING: [&str; 3] = ["in", "on", "next_to"];
/// Nouns of things that readers also call by another, and whether such things have their own colour: flowers stand in vases of any.
pub(super) const LOOK_ALIKES: [(&str, &str, bool); 8] = [
    ("book", "row of books", true),
    ("vase", "bunch of flowers", false),
    ("towel", "towel rail", false),
    ("kitchen unit", "wall cabinet", true),
    ("kitchen unit", "kitchen cabinet", true),
    ("kitchen cabinet", "wall cabinet", true),
    ("kitchen cabinet", "kitchen unit", true),
    ("wall cabinet", "kitchen cabinet", true),
];
/// Distance up to which readers take a thing for one beside another, m: the relation ends at 0.5 m.
const BESIDE_TO_READERS_M: f32 = 0.8;
/// Things between checks for cancellation.
const THINGS_PER_CHECK: usize = 64;

/// The common elements of all lists, which are ascending, at most `most`; shorter lists are faster.
pub(super) fn intersection(lists: &[&[ObjectId]], most: usize) -> Vec<ObjectId> {
    let Some((shortest, list)) = lists.iter().enumerate().min_by_key(|(_, list)| list.len()) else {
        return Vec::new();
    };
    let others = || lists.iter().enumerate().filter(|(k, _)| *k != shortest);
    let in_all = |id: &ObjectId| others().all(|(_, other)| other.binary_search(id).is_ok());
    list.iter().copied().filter(in_all).take(most).collect()
}

fn push(lists: &mut BTreeMap<Attribute, Vec<ObjectId>>, key: Attribute, id: ObjectId) {
    let list = lists.entry(key).or_default();
    if list.last() != Some(&id) {
        list.push(id);
    }
}

/// The things beside which readers may see a thing: neighbours, and what is a little farther away.
fn beside_to_readers(scene: &SemanticScene<'_>, object: ObjectId) -> Vec<ObjectId> {
    let own = scene.extent(object).bounds;
    scene.objects_near(&own.grown(BESIDE_TO_READERS_M), MOST_NEAR, |other| {
        other != object && scene.room_of(other) == scene.room_of(object)
    })
}

/// The room that a modifier places things in, by its noun.
fn room_noun(modifier: &Modifier) -> Option<&str> {
    match (modifier.predicate.as_str(), &modifier.arguments[..]) {
        ("in_room", [Phrase::Described(room)]) => match &room.noun {
            Noun::Room(noun) => Some(noun),
            _ => None,
        },
        _ => None,
    }
}

impl SemanticScene<'_> {
    /// The things that may be called `noun`.
    pub(crate) fn distractors(&self, noun: &str) -> Rc<DistractorSet> {
        if let Some(known) = self.distractor_cache().borrow().get(noun) {
            return known.clone();
        }
        let alike = Rc::new(DistractorSet::gather(self, noun));
        let mut all = self.distractor_cache().borrow_mut();
        all.insert(noun.to_owned(), alike.clone());
        alike
    }
}

impl DistractorSet {
    fn gather(scene: &SemanticScene<'_>, noun: &str) -> Self {
        let semantics = scene.semantics;
        let things = semantics
            .noun_index()
            .objects_of_kinds(&semantics.kinds_called(noun));
        let mut pace = CancelPoller::new(THINGS_PER_CHECK);
        let mut in_rooms = BTreeMap::new();
        for id in &things {
            pace.count_one();
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

    /// Returns the number of them in each room, where there are some.
    pub(crate) fn counts_by_room(&self) -> &BTreeMap<RoomId, usize> {
        &self.in_rooms
    }

    fn with_attribute(&self, scene: &SemanticScene<'_>) -> &BTreeMap<Attribute, ObjectList> {
        self.having.get_or_init(|| {
            let mut pace = CancelPoller::new(THINGS_PER_CHECK);
            let words = ColorVocabulary::Spoken.words();
            let mut lists: BTreeMap<Attribute, Vec<ObjectId>> = BTreeMap::new();
            for id in self.things.iter().copied() {
                pace.count_one();
                let facts = scene.facts(id);
                for size in SizeClass::ALL {
                    if facts.may_be_called_size(size) {
                        push(&mut lists, Attribute::Size(size), id);
                    }
                }
                // Also the words on which people divide: what some would call white is not told apart from it as the white one.
                for word in words.iter().filter(|_| !facts.colors.is_empty()) {
                    let shows = !facts.shows_color(word).is_false();
                    if shows {
                        push(&mut lists, Attribute::Color((*word).to_owned()), id);
                    }
                    if shows || facts.shows_trace_of(word) {
                        push(&mut lists, Attribute::TraceOfColor((*word).to_owned()), id);
                    }
                }
                for word in facts.material_words() {
                    push(&mut lists, Attribute::Material(word.to_owned()), id);
                }
                let Some(room) = scene.room_of(id) else {
                    continue;
                };
                let room = scene.semantics.room(room);
                for name in room.names.iter().chain([&room.label]) {
                    push(&mut lists, Attribute::Room(name.clone()), id);
                }
            }
            let lists = lists.into_iter();
            lists.map(|(key, list)| (key, list.into())).collect()
        })
    }

    /// The things that a description with their noun fits, regardless of its relation to a landmark; ascending.
    pub(super) fn matching(
        &self,
        scene: &SemanticScene<'_>,
        description: &Description,
    ) -> ObjectList {
        self.matching_by(scene, description, Attribute::Color)
    }

    /// The same of things that show at least a trace of its first colour: a row of books may have a yellow one.
    pub(super) fn matching_by_trace(
        &self,
        scene: &SemanticScene<'_>,
        description: &Description,
    ) -> ObjectList {
        self.matching_by(scene, description, Attribute::TraceOfColor)
    }

    fn matching_by(
        &self,
        scene: &SemanticScene<'_>,
        description: &Description,
        first: fn(String) -> Attribute,
    ) -> ObjectList {
        let colors = description.colors.iter().cloned().enumerate();
        // The worktop of one unit makes it no other than the next one, whose worktop is narrower.
        let colors = colors.map(|(k, word)| match k {
            0 => first(word),
            _ => Attribute::TraceOfColor(word),
        });
        let material = description.material.iter().cloned();
        let material = material.map(Attribute::Material);
        let size = description.size.map(Attribute::Size);
        let room = description.modifiers.iter().filter_map(room_noun);
        let room = room.map(|noun| Attribute::Room(noun.to_owned()));
        let traits: Vec<Attribute> = colors.chain(material).chain(size).chain(room).collect();
        if traits.is_empty() {
            return self.things.clone();
        }
        if let Some(known) = self.having_all.borrow().get(&traits) {
            return known.clone();
        }
        let having = self.with_attribute(scene);
        let lists: Option<Vec<&[ObjectId]>> = traits
            .iter()
            .map(|key| having.get(key).map(|list| &**list))
            .collect();
        let found = lists.map_or_else(Vec::new, |lists| intersection(&lists, usize::MAX));
        let found: ObjectList = found.into();
        let mut known = self.having_all.borrow_mut();
        known.insert(traits, found.clone());
        found
    }

    fn pairs(&self, scene: &SemanticScene<'_>) -> &BTreeMap<(&'static str, u32), RelatedPairs> {
        self.pairs.get_or_init(|| {
            let mut pace = CancelPoller::new(1);
            let mut pairs: BTreeMap<(&'static str, u32), RelatedPairs> = BTreeMap::new();
            for predicate in predicates::all() {
                if !TELLING.contains(&predicate.name()) {
                    continue;
                }
                for id in self.things.iter().copied() {
                    pace.count_one();
                    let related = match predicate.name() {
                        "next_to" => beside_to_readers(scene, id),
                        _ => predicates::related_objects(scene, *predicate, id),
                    };
                    for other in related {
                        let kind = scene.semantics.noun_index().kind_of(other);
                        let list = pairs.entry((predicate.name(), kind)).or_default();
                        list.push((id, other));
                    }
                }
            }
            pairs
        })
    }

    /// The things that have an informative relation to something that the landmark of `modifier` fits; ascending.
    pub(super) fn with_landmark(
        &self,
        scene: &SemanticScene<'_>,
        modifier: &Modifier,
    ) -> ObjectList {
        let [Phrase::Described(landmark)] = &modifier.arguments[..] else {
            return ObjectList::default();
        };
        let Noun::Object(noun) = &landmark.noun else {
            return ObjectList::default();
        };
        let mark = LandmarkQuery {
            predicate: modifier.predicate.clone(),
            noun: noun.clone(),
            colors: landmark.colors.clone(),
        };
        if let Some(known) = self.marked.borrow().get(&mark) {
            return known.clone();
        }
        let pairs = self.pairs(scene);
        // What stands on a bookcase is not told by that from what stands in one.
        let names: &[&'static str] = match modifier.predicate.as_str() {
            "in" | "on" => &["in", "on"],
            name => TELLING
                .iter()
                .find(|own| **own == name)
                .map_or(&[], std::slice::from_ref),
        };
        let mut found: Vec<ObjectId> = Vec::new();
        let look_alikes = LOOK_ALIKES.iter().filter(|(own, ..)| own == noun);
        let nouns = look_alikes
            .map(|(_, other, _)| *other)
            .chain([noun.as_str()]);
        for kind in nouns.flat_map(|noun| scene.semantics.kinds_called(noun)) {
            let pairs = names.iter().filter_map(|name| pairs.get(&(*name, kind)));
            for (id, other) in pairs.flatten() {
                if found.last() != Some(id) && scene.facts(*other).may_match_properties(landmark) {
                    found.push(*id);
                }
            }
        }
        found.sort_unstable();
        found.dedup();
        let found: ObjectList = found.into();
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
        assert_eq!(intersection(&[&a, &b, &c], usize::MAX), ids(&[2, 9]));
        assert_eq!(intersection(&[&a, &b, &c], 1), ids(&[2]));
        assert_eq!(intersection(&[&a], 2), ids(&[1, 2]));
        assert!(intersection(&[&a, &[]], 2).is_empty());
        assert!(intersection(&[], 2).is_empty());
    }
}
