//! Descriptions of rooms that fit exactly one.

use crate::form::{Description, Modifier, Noun, OrdinalSelection, Phrase, Quantifier};
use crate::scene::SemanticScene;
use dwell_scene::RoomId;
use dwell_scene::interrupt;
use std::collections::BTreeMap;

/// The phrase that fits `room` and no other by noun and place in the house's own list: "the kitchen", "the second bedroom".
pub fn room_phrase(scene: &SemanticScene<'_>, room: RoomId) -> Phrase {
    let facts = scene.semantics.room(room);
    let noun = Noun::Room(facts.noun.clone());
    Description {
        selection: facts.number.map(|place| OrdinalSelection {
            order: OrdinalSelection::OF_HOUSE.to_owned(),
            place,
            reference: None,
        }),
        ..Description::new(Quantifier::The, noun)
    }
    .into()
}

/// The shortest description of `room` that fits no other: its noun, and a kind of thing that it alone holds where there are
/// several such rooms. `None` when there is none, and for rooms without a kind.
///
/// Of the things that only this room holds, the largest kind is named: it is seen first.
pub fn refer_to_room(scene: &SemanticScene<'_>, room: RoomId) -> Option<Description> {
    let facts = scene.semantics.room(room);
    let unnamed = facts.kind.is_none_or(|kind| kind.name == Noun::ANY_ROOM);
    let plain = Description::new(Quantifier::The, Noun::Room(facts.noun.clone()));
    if !unnamed && facts.number.is_none() {
        return Some(plain);
    }
    let rooms = scene.house().rooms.ids();
    let alike = rooms.filter(|other| scene.semantics.room(*other).is_called(&facts.noun));
    let alike: Vec<RoomId> = alike.collect();
    let mut things: BTreeMap<&str, f32> = BTreeMap::new();
    for object in scene.objects_in(room).iter().copied() {
        let worth_naming = |row: &crate::category::SemanticCategory| {
            !row.structure
                && !["door", "window", "curtain", "blinds", "unknown"].contains(&row.name)
        };
        interrupt::unwind_if_cancelled();
        if scene.facts(object).category.is_some_and(worth_naming) {
            let volume = scene.extent(object).bounds.volume();
            let largest = things.entry(&scene.facts(object).noun).or_insert(0.0);
            *largest = largest.max(volume);
        }
    }
    let mut things: Vec<(&str, f32)> = things.into_iter().collect();
    things.sort_by(|p, q| q.1.total_cmp(&p.1).then(p.0.cmp(q.0)));
    let alone = |noun: &&str| {
        let things = scene.distractors(noun);
        let mut holding = alike
            .iter()
            .filter(|other| things.counts_by_room().contains_key(other));
        holding.next() == Some(&room) && holding.next().is_none()
    };
    let noun = things.into_iter().map(|(noun, _)| noun).find(alone)?;
    let thing = Description::new(Quantifier::Some, Noun::Object(noun.to_owned()));
    Some(plain.with_modifier(Modifier::new("room_contains", [thing.into()])))
}
