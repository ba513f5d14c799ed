//! The description of a room.

use super::contents::grouped;
use super::hanging::{MountedObject, clauses};
use super::object::landmark;
use super::openings::openings;
use crate::english::{be, capitalized, list, with_article};
use crate::predicates;
use crate::scene::SemanticScene;
use dwell_scene::interrupt;
use dwell_scene::{ObjectId, RoomId};
use std::collections::{BTreeMap, BTreeSet};

pub(super) fn is_a(scene: &SemanticScene<'_>, object: ObjectId, names: &[&str]) -> bool {
    scene
        .facts(object)
        .category
        .is_some_and(|row| names.contains(&row.name))
}

fn shell(scene: &SemanticScene<'_>, room: RoomId) -> String {
    let facts = scene.semantics.room(room);
    let area = facts.area_m2.round().max(1.0);
    let mut with = Vec::new();
    let floor = [facts.floor_color, facts.floor_word];
    let floor: Vec<&str> = floor.into_iter().flatten().collect();
    if !floor.is_empty() {
        with.push(with_article(&format!("{} floor", floor.join(" "))));
    }
    with.extend(facts.wall_color.map(|word| format!("{word} walls")));
    let with = if with.is_empty() {
        String::new()
    } else {
        format!(", with {}", list(&with))
    };
    let unit = if area <= 1.0 { "metre" } else { "metres" };
    format!("The {} is about {area} square {unit}{with}.", facts.label)
}

/// The contents of a room off the floor: things by what carries them and how, and what hangs.
#[derive(Default)]
struct RoomContents {
    carried: BTreeMap<(ObjectId, &'static str), Vec<ObjectId>>,
    hanging: Vec<MountedObject>,
}

fn placed(scene: &SemanticScene<'_>, room: RoomId, objects: &[ObjectId]) -> RoomContents {
    let mut placed = RoomContents::default();
    for object in objects {
        interrupt::check();
        let related = ["in", "on"].into_iter().find_map(|name| {
            let predicate = predicates::find(name).ok()?;
            let others = predicates::related_objects(scene, predicate, *object);
            let carrier = others.into_iter().find(|other| {
                scene.room_of(*other) == Some(room) && !(name == "in" && scene.is_lain_upon(*other))
            })?;
            Some((name, carrier))
        });
        // Furniture on a rug stands in the room; it is the rug's mention that matters.
        if let Some((name, carrier)) =
            related.filter(|(_, carrier)| !is_a(scene, *carrier, &["rug"]))
        {
            placed
                .carried
                .entry((carrier, name))
                .or_default()
                .push(*object);
            continue;
        }
        let hanging = MountedObject::of(scene, *object);
        placed
            .hanging
            .extend(hanging.filter(|hanging| !hanging.is_in_noun(scene)));
    }
    placed
}

/// The carriers of things, the largest kinds first, as lists have them: a table before the bowl on it.
fn in_order(
    scene: &SemanticScene<'_>,
    carried: BTreeMap<(ObjectId, &'static str), Vec<ObjectId>>,
) -> Vec<(ObjectId, &'static str, Vec<ObjectId>)> {
    let mut carriers: Vec<ObjectId> = carried.keys().map(|(carrier, _)| *carrier).collect();
    carriers.dedup();
    let groups = grouped(scene, &carriers);
    let mut ordered: Vec<(ObjectId, &'static str, Vec<ObjectId>)> = Vec::new();
    let mut places: BTreeMap<ObjectId, usize> = BTreeMap::new();
    for (place, group) in groups.iter().enumerate() {
        places.extend(group.objects.iter().map(|object| (*object, place)));
    }
    for ((carrier, words), things) in carried {
        ordered.push((carrier, words, things));
    }
    // Stable: within a kind as the house has them.
    ordered.sort_by_key(|(carrier, ..)| places.get(carrier).copied());
    ordered
}

/// The description of a room: its size and surfaces, its openings, what stands in it, and what lies on what.
pub fn describe_room(scene: &SemanticScene<'_>, room: RoomId) -> String {
    let mut sentences = vec![shell(scene, room)];
    sentences.extend(openings(scene, room));
    let objects: Vec<ObjectId> = scene
        .objects_in(room)
        .iter()
        .copied()
        .filter(|object| !scene.facts(*object).is_door() && !is_a(scene, *object, &["window"]))
        .filter(|object| scene.holder(*object).is_none())
        .collect();
    let RoomContents { carried, hanging } = placed(scene, room, &objects);
    let hung = hanging.iter().map(|hanging| hanging.thing);
    let elsewhere: BTreeSet<ObjectId> = carried.values().flatten().copied().chain(hung).collect();
    let standing = objects.iter().filter(|object| !elsewhere.contains(object));
    let standing: Vec<ObjectId> = standing.copied().collect();
    let texts = |objects: &[ObjectId]| -> Vec<String> {
        grouped(scene, objects)
            .iter()
            .map(|group| group.text(scene))
            .collect()
    };
    if objects.is_empty() {
        sentences.push("It is empty.".to_owned());
    }
    if !standing.is_empty() {
        // "There is a bed, ..." agrees with the first thing of the list, as people speak.
        let first = grouped(scene, &standing)[0].objects.len();
        sentences.push(format!("There {} {}.", be(first), list(&texts(&standing))));
    }
    let mut last: Option<ObjectId> = None;
    let mut told: BTreeSet<&str> = BTreeSet::new();
    for (carrier, words, things) in in_order(scene, carried) {
        let noun = &scene.facts(carrier).noun;
        let place = match last {
            Some(last) if last == carrier => "it".to_owned(),
            _ if told.contains(noun.as_str()) => format!("another {noun}"),
            _ => landmark(scene, carrier, Some(room)),
        };
        last = Some(carrier);
        told.insert(noun);
        sentences.push(format!(
            "{} {place} {} {}.",
            capitalized(words),
            be(things.len()),
            list(&texts(&things))
        ));
    }
    for clause in clauses(scene, &hanging) {
        sentences.push(format!("{}.", capitalized(&clause)));
    }
    sentences.join(" ")
}
