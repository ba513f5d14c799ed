//! The description of a house.

use super::options::{TextLength, TextOptions};
use super::room::say_room;
use super::text::{GroundedText, TextWriter};
use crate::check::{Addressee, Checker};
use crate::form::{Description, Modifier, Noun, Phrase, Quantifier};
use crate::scene::SemanticScene;
use dwell_scene::{Id, LevelId, RoomId};
use std::collections::BTreeMap;

fn exactly(number: usize, noun: Noun) -> Description {
    let quantifier = match number {
        0 => Quantifier::No,
        1 => Quantifier::Some,
        number => Quantifier::Exactly(number as u32),
    };
    Description::new(quantifier, noun)
}

/// Rooms of one storey as items: "two bedrooms", "a kitchen".
fn room_items(scene: &SemanticScene<'_>, rooms: &[RoomId]) -> Vec<Description> {
    let mut nouns: BTreeMap<&str, usize> = BTreeMap::new();
    for room in rooms {
        nouns.insert(&scene.semantics.room(*room).noun, 0);
    }
    for (noun, number) in &mut nouns {
        let called = rooms
            .iter()
            .filter(|room| scene.semantics.room(**room).is_called(noun));
        *number = called.count();
    }
    // "Seven rooms" are told already.
    nouns.remove(Noun::ANY_ROOM);
    let nouns = nouns.into_iter();
    nouns
        .map(|(noun, number)| exactly(number, Noun::Room(noun.to_owned())))
        .collect()
}

/// The description of a house: the numbers of storeys, rooms and things, its rooms, then each of them, storey by storey; a short one
/// ends before the rooms' own texts.
pub fn describe_house(scene: &SemanticScene<'_>, options: TextOptions) -> GroundedText {
    let checker = Checker::new(scene, Addressee::default());
    let mut writer = TextWriter::new(&checker, options.wording);
    let house = scene.house();
    let storeys = house.levels.len();
    let mut numbers = Vec::new();
    if storeys > 1 {
        numbers.push(exactly(storeys, Noun::Storey));
    }
    numbers.push(exactly(
        house.rooms.len(),
        Noun::Room(Noun::ANY_ROOM.to_owned()),
    ));
    numbers.push(exactly(
        house.objects.len(),
        Noun::Object(Noun::ANY_OBJECT.to_owned()),
    ));
    if numbers.iter().any(|item| item.quantifier == Quantifier::No) {
        // "There are two rooms and nothing" is no English.
        for item in numbers {
            writer.there_are(&[item], &[]);
        }
    } else {
        writer.there_are(&numbers, &[]);
    }
    let mut order: Vec<RoomId> = house.rooms.ids().collect();
    order.sort_by_key(|room| (house.rooms[*room].level, *room));
    let on =
        |level: LevelId| Modifier::new("on_storey", [Phrase::Storey(level.index() as u32 + 1)]);
    for storey in order.chunk_by(|p, q| house.rooms[*p].level == house.rooms[*q].level) {
        let items = room_items(scene, storey);
        let level = house.rooms[storey[0]].level;
        let place = if storeys > 1 {
            vec![on(level)]
        } else {
            Vec::new()
        };
        writer.there_are(&items, &place);
    }
    if options.length > TextLength::Short {
        scene.measure_places();
        for room in order {
            writer.end_paragraph();
            say_room(&mut writer, scene, room, options);
        }
    }
    writer.finish()
}
