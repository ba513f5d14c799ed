//! Windows, doors and passages of a room.

use crate::english::{counted, list};
use crate::scene::SemanticScene;
use dwell_scene::RoomId;

/// The destination of a door from a room.
#[derive(Clone, PartialEq, Eq)]
enum DoorDestination {
    Rooms(Vec<RoomId>),
    Outside,
    /// Within the room, or to a place that the house does not name.
    Elsewhere,
}

/// Doors of one noun that lead the same way.
struct DoorGroup<'a> {
    noun: &'a str,
    plural: &'a str,
    way: DoorDestination,
    number: usize,
}

fn names(scene: &SemanticScene<'_>, rooms: &[RoomId]) -> String {
    let labels = rooms.iter().map(|room| &scene.semantics.room(*room).label);
    list(
        &labels
            .map(|label| format!("the {label}"))
            .collect::<Vec<_>>(),
    )
}

fn doors_of<'a>(scene: &SemanticScene<'a>, room: RoomId) -> Vec<DoorGroup<'a>> {
    let mut groups: Vec<DoorGroup<'a>> = Vec::new();
    for (door, doorway) in scene.semantics.doorways() {
        if scene.room_of(door) != Some(room) && !doorway.rooms.contains(&room) {
            continue;
        }
        let rooms: Vec<RoomId> = doorway.beyond(room).collect();
        let way = match (rooms.is_empty(), doorway.outside) {
            (false, _) => DoorDestination::Rooms(rooms),
            (true, true) => DoorDestination::Outside,
            (true, false) => DoorDestination::Elsewhere,
        };
        let facts = scene.facts(door);
        match groups
            .iter_mut()
            .find(|group| group.noun == facts.noun && group.way == way)
        {
            Some(group) => group.number += 1,
            None => groups.push(DoorGroup {
                noun: &facts.noun,
                plural: &facts.plural,
                way,
                number: 1,
            }),
        }
    }
    groups
}

/// "two doors to the hall and the kitchen", "a door to the outside", "another door": by noun, then by destination.
fn door_texts(scene: &SemanticScene<'_>, room: RoomId) -> Vec<String> {
    let groups = doors_of(scene, room);
    let mut nouns: Vec<(&str, &str)> = Vec::new();
    for group in &groups {
        if !nouns.contains(&(group.noun, group.plural)) {
            nouns.push((group.noun, group.plural));
        }
    }
    let mut texts = Vec::new();
    for (noun, plural) in nouns {
        let said = texts.len();
        let of = || groups.iter().filter(|group| group.noun == noun);
        // One door to each of several rooms is described in one phrase; two to one room would blur which leads where.
        let mut single: Vec<RoomId> = Vec::new();
        for group in of() {
            match &group.way {
                DoorDestination::Rooms(rooms) if group.number == 1 && rooms.len() == 1 => {
                    single.extend(rooms);
                }
                _ => {}
            }
        }
        if !single.is_empty() {
            single.sort();
            let doors = counted(single.len(), noun, plural);
            texts.push(format!("{doors} to {}", names(scene, &single)));
        }
        for group in of() {
            let doors = counted(group.number, noun, plural);
            match &group.way {
                DoorDestination::Rooms(rooms) if group.number > 1 || rooms.len() > 1 => {
                    texts.push(format!("{doors} to {}", names(scene, rooms)));
                }
                _ => {}
            }
        }
        let number = |way: &DoorDestination| {
            of().find(|group| group.way == *way)
                .map(|group| group.number)
        };
        if let Some(number) = number(&DoorDestination::Outside) {
            texts.push(format!("{} to the outside", counted(number, noun, plural)));
        }
        if let Some(number) = number(&DoorDestination::Elsewhere) {
            texts.push(match (number, texts.len() > said) {
                (_, false) => counted(number, noun, plural),
                (1, true) => format!("another {noun}"),
                (_, true) => counted(number, noun, &format!("other {plural}")),
            });
        }
    }
    texts
}

/// Returns the openings of the room: "It has two windows, a door to the hall and an open passage to the kitchen."
pub(super) fn openings(scene: &SemanticScene<'_>, room: RoomId) -> Option<String> {
    let windows = scene.windows_in(room);
    let mut parts = Vec::new();
    if windows > 0 {
        parts.push(counted(windows, "window", "windows"));
    }
    parts.extend(door_texts(scene, room));
    let open = &scene.semantics.room(room).passages;
    if !open.is_empty() {
        let passages = counted(open.len(), "open passage", "open passages");
        parts.push(format!("{passages} to {}", names(scene, open)));
    }
    (!parts.is_empty()).then(|| format!("It has {}.", list(&parts)))
}
