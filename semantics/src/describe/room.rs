//! The description of a room.

use super::contents::grouped;
use super::hanging::{Hanging, clauses};
use super::object::landmark;
use super::openings::openings;
use crate::english::{be, capitalized, list, with_article};
use crate::predicates;
use crate::scene::{Scene, Term};
use dwell_scene::{ObjectId, RoomId};
use std::collections::BTreeMap;

pub(super) fn is_a(scene: &Scene<'_>, object: ObjectId, names: &[&str]) -> bool {
    scene
        .facts(object)
        .category
        .is_some_and(|row| names.contains(&row.name))
}

fn shell(scene: &Scene<'_>, room: RoomId) -> String {
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

/// What does not stand on the floor: things by what carries them and how, and what hangs.
#[derive(Default)]
struct Placed {
    carried: BTreeMap<(ObjectId, &'static str), Vec<ObjectId>>,
    hanging: Vec<Hanging>,
}

fn placed(scene: &Scene<'_>, room: RoomId, objects: &[ObjectId]) -> Placed {
    let mut placed = Placed::default();
    let house = scene.house();
    for object in objects {
        let related = ["in", "on"].into_iter().find_map(|name| {
            let predicate = predicates::find(name).ok()?;
            let carrier = house.objects.ids().find(|other| {
                other != object
                    && scene.room_of(*other) == Some(room)
                    && !(name == "in" && scene.is_lain_upon(*other))
                    && predicate.holds(scene, Term::Object(*object), Term::Object(*other), None)
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
        let hanging = Hanging::of(scene, *object);
        placed
            .hanging
            .extend(hanging.filter(|hanging| !hanging.is_in_noun(scene)));
    }
    placed
}

/// The carriers of things, the largest kinds first, as lists have them: a table before the bowl on it.
fn in_order(
    scene: &Scene<'_>,
    carried: BTreeMap<(ObjectId, &'static str), Vec<ObjectId>>,
) -> Vec<(ObjectId, &'static str, Vec<ObjectId>)> {
    let mut carriers: Vec<ObjectId> = carried.keys().map(|(carrier, _)| *carrier).collect();
    carriers.dedup();
    let groups = grouped(scene, &carriers);
    let mut ordered: Vec<(ObjectId, &'static str, Vec<ObjectId>)> = Vec::new();
    let place = |carrier: ObjectId| {
        let mut groups = groups.iter();
        groups.position(|group| group.objects.contains(&carrier))
    };
    for ((carrier, words), things) in carried {
        ordered.push((carrier, words, things));
    }
    // Stable: within a kind as the house has them.
    ordered.sort_by_key(|(carrier, ..)| place(*carrier));
    ordered
}

/// The description of a room: its size and surfaces, its openings, what stands in it, and what lies on what.
pub fn describe_room(scene: &Scene<'_>, room: RoomId) -> String {
    let mut sentences = vec![shell(scene, room)];
    sentences.extend(openings(scene, room));
    let objects: Vec<ObjectId> = scene
        .objects_in(room)
        .into_iter()
        .filter(|object| !scene.facts(*object).is_door() && !is_a(scene, *object, &["window"]))
        .filter(|object| scene.holder(*object).is_none())
        .collect();
    let Placed { carried, hanging } = placed(scene, room, &objects);
    let standing: Vec<ObjectId> = objects
        .iter()
        .filter(|object| {
            !hanging.iter().any(|hanging| hanging.thing == **object)
                && !carried.values().flatten().any(|other| other == *object)
        })
        .copied()
        .collect();
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
    let mut told: Vec<ObjectId> = Vec::new();
    for (carrier, words, things) in in_order(scene, carried) {
        let noun = &scene.facts(carrier).noun;
        let is_other = |other: &ObjectId| scene.facts(*other).noun == *noun;
        let place = match told.last() {
            Some(last) if *last == carrier => "it".to_owned(),
            _ if told.iter().any(is_other) => format!("another {noun}"),
            _ => landmark(scene, carrier, Some(room)),
        };
        told.push(carrier);
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
