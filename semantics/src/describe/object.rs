//! A caption of one object.

use super::hanging::MountedObject;
use crate::english::{qualified, with_article};
use crate::predicates;
use crate::scene::SemanticScene;
use dwell_scene::interrupt;
use dwell_scene::{ObjectId, RoomId};

/// Openness above which a thing is called open, and below which closed.
const OPEN: f32 = 0.5;
const CLOSED: f32 = 0.02;

/// The adjectives of a thing: size, openness, colour, substance.
pub(super) type Adjectives = [Option<String>; 4];

pub(super) fn adjectives(scene: &SemanticScene<'_>, object: ObjectId) -> Adjectives {
    let facts = scene.facts(object);
    let size = facts.size.word().map(str::to_owned);
    let openness =
        scene
            .state
            .openness(scene.house(), object)
            .and_then(|openness| match openness {
                o if o > OPEN => Some("open"),
                o if o > CLOSED => Some("half-open"),
                // A cupboard is closed as a rule; a door's state is always of interest.
                _ => facts.is_opening().then_some("closed"),
            });
    let material = facts.material_word();
    let color = facts.color_phrase();
    [
        size,
        openness.map(str::to_owned),
        color,
        material.map(str::to_owned),
    ]
}

/// A noun with its adjectives, of which there may be none.
pub(super) fn described(adjectives: &Adjectives, noun: &str) -> String {
    let row = |words: &[Option<String>]| -> String {
        let words: Vec<&str> = words.iter().flatten().map(String::as_str).collect();
        words.join(" ")
    };
    qualified(&row(&adjectives[..2]), &row(&adjectives[2..]), noun)
}

/// Adjectives and noun.
pub(super) fn phrase(scene: &SemanticScene<'_>, object: ObjectId) -> String {
    described(&adjectives(scene, object), &scene.facts(object).noun)
}

/// Returns the number of things in a room that may be called as `object` is; as if there were several outside of all rooms.
pub(super) fn alike(scene: &SemanticScene<'_>, object: ObjectId, room: Option<RoomId>) -> usize {
    let noun = &scene.facts(object).noun;
    room.map_or(2, |room| {
        let alike = scene.distractors(noun);
        alike.in_rooms().get(&room).copied().unwrap_or_default()
    })
}

/// A landmark in a room: "the table" when it is the only one there, else "a table".
pub(super) fn landmark(
    scene: &SemanticScene<'_>,
    object: ObjectId,
    room: Option<RoomId>,
) -> String {
    let noun = &scene.facts(object).noun;
    if alike(scene, object, room) == 1 {
        format!("the {noun}")
    } else {
        with_article(noun)
    }
}

fn first_related(scene: &SemanticScene<'_>, object: ObjectId, name: &str) -> Option<ObjectId> {
    let predicate = predicates::find(name).ok()?;
    let mut found = predicates::related_objects(scene, predicate, object);
    // A thing is placed by something larger than itself; the largest is the easiest to find.
    let marks = |id: ObjectId| scene.facts(id).category.is_some() && !scene.facts(id).is_opening();
    found.retain(|other| name != "next_to" || marks(*other));
    found.retain(|other| name != "in" || !scene.is_lain_upon(*other));
    let volume = |id: ObjectId| scene.extent(id).bounds.volume();
    let largest = found
        .into_iter()
        .max_by(|p, q| volume(*p).total_cmp(&volume(*q)).then(q.cmp(p)))?;
    (name != "next_to" || volume(largest) > 0.3 * volume(object)).then_some(largest)
}

/// The rooms that a door connects: " from the kitchen to the outside"; `None` when that is not known, and for other things.
fn between(scene: &SemanticScene<'_>, door: ObjectId, room: Option<RoomId>) -> Option<String> {
    let doorway = scene.semantics.doorway(door)?;
    let the = |room: RoomId| format!("the {}", scene.semantics.room(room).label);
    match doorway.rooms[..] {
        [one] if doorway.outside => Some(format!(" from {} to the outside", the(one))),
        [one, other] if room == Some(other) => {
            Some(format!(" from {} to {}", the(other), the(one)))
        }
        [one, other] => Some(format!(" from {} to {}", the(one), the(other))),
        _ => None,
    }
}

/// Returns its place beside something else: " on the table"; empty when nothing is near.
fn place(scene: &SemanticScene<'_>, object: ObjectId, room: Option<RoomId>) -> String {
    for (name, words) in [("in", "in"), ("on", "on")] {
        if let Some(other) = first_related(scene, object, name) {
            return format!(" {words} {}", landmark(scene, other, room));
        }
    }
    if let Some(hanging) = MountedObject::of(scene, object) {
        return hanging.place(scene);
    }
    first_related(scene, object, "next_to").map_or_else(String::new, |other| {
        format!(" next to {}", landmark(scene, other, room))
    })
}

/// A caption: "a brown wooden chair next to the table in the kitchen".
pub fn caption(scene: &SemanticScene<'_>, object: ObjectId) -> String {
    interrupt::check();
    let room = scene.room_of(object);
    let mut text = with_article(&phrase(scene, object));
    let between = between(scene, object, room);
    if let Some(between) = &between {
        text.push_str(between);
    } else if scene.holder(object).is_some() {
        text.push_str(" in somebody's hand");
    } else {
        text.push_str(&place(scene, object, room));
    }
    if let Some(room) = room.filter(|_| between.is_none()) {
        text.push(' ');
        text.push_str(&scene.semantics.room(room).place());
    }
    if scene.house().objects[object].switch.is_some() && scene.state.switched_on[object] {
        text.push_str(", switched on");
    }
    text
}
