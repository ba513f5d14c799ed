//! Doors and passages of a room.

use super::text::TextWriter;
use crate::form::{Clause, Description, Form, Modifier, Noun, Phrase, Quantifier};
use crate::refer::room_phrase;
use crate::scene::SemanticScene;
use dwell_scene::{ObjectId, RoomId};
use std::collections::BTreeMap;

/// The places that a door leads to from a room.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord)]
struct DoorDestination {
    rooms: Vec<RoomId>,
    outside: bool,
}

impl DoorDestination {
    fn modifiers(&self, scene: &SemanticScene<'_>) -> Vec<Modifier> {
        let rooms = self.rooms.iter();
        let rooms = rooms.map(|room| Modifier::new("leads_to", [room_phrase(scene, *room)]));
        let outside = self.outside.then(|| Modifier::new("leads_outside", []));
        rooms.chain(outside).collect()
    }
}

/// Says where the doors of a room lead: "From the kitchen there are two doors to the hall and a door to the outside."
pub(super) fn say_doors(writer: &mut TextWriter<'_>, scene: &SemanticScene<'_>, room: RoomId) {
    let mut groups: BTreeMap<(&str, DoorDestination), Vec<ObjectId>> = BTreeMap::new();
    let mut all: Vec<ObjectId> = Vec::new();
    for (door, doorway) in scene.semantics.doorways() {
        if !doorway.rooms.contains(&room) {
            continue;
        }
        all.push(door);
        let destination = DoorDestination {
            rooms: doorway.rooms_beyond(room).collect(),
            outside: doorway.outside,
        };
        let noun = scene.facts(door).noun.as_str();
        groups.entry((noun, destination)).or_default().push(door);
    }
    let mut items = Vec::new();
    let mut groups: Vec<_> = groups.into_iter().collect();
    // To rooms, to the outside, and last those of which nothing is known.
    groups.sort_by_key(|((_, to), _)| (to.rooms.is_empty(), !to.outside && to.rooms.is_empty()));
    for ((noun, destination), objects) in groups {
        let leads = |door: &ObjectId| {
            let doorway = scene.semantics.doorway(*door);
            doorway.is_some_and(|doorway| {
                let mut rooms = destination.rooms.iter();
                rooms.all(|room| doorway.rooms.contains(room))
                    && (!destination.outside || doorway.outside)
            })
        };
        let called = |door: &ObjectId| scene.facts(*door).is_called(noun);
        let quantifier = match objects.len() {
            1 => Quantifier::Some,
            _ => Quantifier::Exactly(
                all.iter()
                    .filter(|door| leads(door) && called(door))
                    .count() as u32,
            ),
        };
        let mut item = Description::new(quantifier, Noun::Object(noun.to_owned()));
        item.modifiers = destination.modifiers(scene);
        items.push(item);
    }
    writer.there_are(
        &items,
        &[Modifier::new("leads_from", [room_phrase(scene, room)])],
    );
}

/// Says to which rooms a room is open without a door: "The kitchen is open to the hall."
pub(super) fn say_passages(writer: &mut TextWriter<'_>, scene: &SemanticScene<'_>, room: RoomId) {
    let open = scene.semantics.room(room).passages.iter();
    let mut rooms: Vec<Phrase> = open.map(|other| room_phrase(scene, *other)).collect();
    let to = match rooms.len() {
        0 => return,
        1 => rooms.remove(0),
        _ => Phrase::List(rooms),
    };
    writer.say(Form::Claim(Clause::Holds {
        predicate: "open_to".to_owned(),
        arguments: vec![room_phrase(scene, room), to],
    }));
}
