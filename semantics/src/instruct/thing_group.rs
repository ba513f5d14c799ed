//! Several things of a kind that instructions ask for by number: "two cups", "every drawer in the kitchen".

use super::find_object::is_search_target;
use super::step_kind::StepKind;
use crate::check::{Addressee, Checker};
use crate::form::{Description, Modifier, Noun, Quantifier};
use crate::scene::{SemanticScene, Term};
use dwell_scene::interrupt;
use dwell_scene::{ObjectId, RoomId};
use std::collections::BTreeSet;

/// The most things of a group, and the most that are counted.
const MOST: usize = 16;
const MOST_COUNTED: u32 = 3;

/// Several things of a kind.
#[derive(Clone, Debug, PartialEq)]
pub struct ThingGroup {
    /// The words: a noun with its quantifier, and a room where the group is that of one.
    pub words: Description,
    /// The things that count, ascending.
    pub objects: Vec<ObjectId>,
    /// How many of them it must be so of.
    pub needed: usize,
    /// True if of no more.
    pub is_exact: bool,
    /// Those of which it is not so yet, and of which the listener can bring it about.
    pub undone: Vec<ObjectId>,
}

/// Things that words fit: those of a noun in the house or in a room.
#[derive(Clone, Debug, PartialEq)]
pub struct ThingSet {
    /// The words, with the quantifier "a".
    words: Description,
    /// The things, ascending; two or more.
    objects: Vec<ObjectId>,
}

/// The things of each noun, in the house and in each of `rooms`, where there are several.
pub fn thing_sets(scene: &SemanticScene<'_>, rooms: &[(RoomId, Description)]) -> Vec<ThingSet> {
    let checker = Checker::new(scene, Addressee::default());
    let objects = scene.house().objects.ids();
    let sought =
        objects.filter(|object| scene.facts(*object).category.is_some_and(is_search_target));
    let nouns: BTreeSet<&str> = sought
        .map(|object| scene.facts(object).noun.as_str())
        .collect();
    let mut found = Vec::new();
    for noun in nouns {
        interrupt::unwind_if_cancelled();
        let plain = Description::new(Quantifier::Some, Noun::Object(noun.to_owned()));
        let of_rooms = rooms.iter().map(|(_, words)| {
            let within = Modifier::new("in_room", [words.clone().into()]);
            plain.clone().with_modifier(within)
        });
        for words in std::iter::once(plain.clone()).chain(of_rooms) {
            let fitting = checker.matching_terms(&words);
            let is_certain = checker.possible_count(&words) == fitting.len();
            if is_certain && (2..=MOST).contains(&fitting.len()) {
                let objects: Vec<ObjectId> = fitting.into_iter().filter_map(Term::object).collect();
                found.push(ThingSet { words, objects });
            }
        }
    }
    found
}

/// The groups of which a step can be asked, of things of which it is not so yet. `to`: the room that things are brought to.
/// `is_possible`: whether the listener can do it to a thing.
///
/// "Every" asks for all that the words fit, and some of them must be left to do; a number asks for so many of those that are left, of
/// which there are more.
pub fn groups(
    scene: &SemanticScene<'_>,
    kind: StepKind,
    sets: &[ThingSet],
    to: Option<RoomId>,
    is_possible: impl Fn(ObjectId) -> bool,
) -> Vec<ThingGroup> {
    let mut found = Vec::new();
    for ThingSet { words, objects } in sets {
        let is_so = |object: &ObjectId| kind.is_satisfied(scene, *object, to);
        let (_, undone): (Vec<ObjectId>, Vec<ObjectId>) = objects.iter().copied().partition(is_so);
        let can = |object: &ObjectId| kind.applies(scene, *object) && is_possible(*object);
        let doable: Vec<ObjectId> = undone.iter().copied().filter(can).collect();
        let counted = (2..=MOST_COUNTED).filter(|number| doable.len() > *number as usize);
        found.extend(counted.map(|number| ThingGroup {
            words: words.clone().with_quantifier(Quantifier::Exactly(number)),
            objects: undone.clone(),
            needed: number as usize,
            is_exact: true,
            undone: doable.clone(),
        }));
        if doable.len() == undone.len() && !undone.is_empty() {
            found.push(ThingGroup {
                words: words.clone().with_quantifier(Quantifier::Every),
                objects: objects.clone(),
                needed: objects.len(),
                is_exact: false,
                undone,
            });
        }
    }
    found
}
