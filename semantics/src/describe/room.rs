//! The description of a room.

use super::contents::grouped;
use super::object::landmark;
use crate::english::{be, capitalized, counted, list, with_article};
use crate::predicates;
use crate::scene::{Scene, Term};
use dwell_scene::{ObjectId, RoomId, StructureKind};
use glam::Vec3;
use std::collections::BTreeMap;

/// How far beyond a door's box its other side is looked for, m.
const DOORSTEP_M: f32 = 0.35;

fn is_a(scene: &Scene<'_>, object: ObjectId, names: &[&str]) -> bool {
    scene
        .facts(object)
        .category
        .is_some_and(|row| names.contains(&row.name))
}

/// The rooms on either side of a door or archway, in order; fewer than two where it leads outside.
///
/// They are looked for across the frame: a door's first part when it has several, else the whole; when that is not
/// clearly thinner one way (a single mesh with an open leaf), on all four sides.
pub(super) fn rooms_beside(scene: &Scene<'_>, door: ObjectId) -> Vec<RoomId> {
    let house = scene.house();
    let object = &house.objects[door];
    let bounds = if object.part_count > 1 {
        house.part_bounds(scene.state, object.first_part)
    } else {
        scene.extent(door).bounds
    };
    let (center, half) = (bounds.center(), bounds.size() * 0.5);
    let (across_x, across_z) = (half.x < 1.5 * half.z, half.z < 1.5 * half.x);
    let mut rooms = Vec::new();
    for (x, z, looks) in [
        (1.0, 0.0, across_x),
        (-1.0, 0.0, across_x),
        (0.0, 1.0, across_z),
        (0.0, -1.0, across_z),
    ] {
        let step = Vec3::new(x * (half.x + DOORSTEP_M), 0.0, z * (half.z + DOORSTEP_M));
        rooms.extend(house.room_at(center + step).filter(|_| looks));
    }
    rooms.sort();
    rooms.dedup();
    rooms
}

fn shell(scene: &Scene<'_>, room: RoomId) -> String {
    let facts = scene.semantics.room(room);
    let area = facts.area_m2.round().max(1.0);
    let mut with = Vec::new();
    with.extend(
        facts
            .floor_word
            .map(|word| with_article(&format!("{word} floor"))),
    );
    with.extend(facts.wall_color.map(|word| format!("{word} walls")));
    let with = if with.is_empty() {
        String::new()
    } else {
        format!(", with {}", list(&with))
    };
    let unit = if area <= 1.0 { "metre" } else { "metres" };
    format!("The {} is about {area} square {unit}{with}.", facts.label)
}

fn openings(scene: &Scene<'_>, room: RoomId) -> Option<String> {
    let house = scene.house();
    let doors: Vec<ObjectId> = house
        .objects
        .ids()
        .filter(|object| scene.facts(*object).is_door())
        .filter(|object| {
            scene.room_of(*object) == Some(room) || rooms_beside(scene, *object).contains(&room)
        })
        .collect();
    let windows = scene
        .objects_in(room)
        .into_iter()
        .filter(|object| is_a(scene, *object, &["window"]))
        .count();
    let mut parts = Vec::new();
    if windows > 0 {
        parts.push(counted(windows, "", "window", "windows"));
    }
    let leads_to = |door: &ObjectId| {
        let beside = rooms_beside(scene, *door);
        beside.into_iter().filter(|other| *other != room)
    };
    // Behind some there is no room: they lead to the outside, or to what the house does not tell.
    let (inner, further): (Vec<ObjectId>, Vec<ObjectId>) = doors
        .into_iter()
        .partition(|door| leads_to(door).next().is_some());
    if !inner.is_empty() {
        let mut beyond: Vec<RoomId> = inner.iter().flat_map(leads_to).collect();
        beyond.sort();
        beyond.dedup();
        let names: Vec<String> = beyond
            .iter()
            .map(|other| format!("the {}", scene.semantics.room(*other).label))
            .collect();
        let count = counted(inner.len(), "", "door", "doors");
        parts.push(format!("{count} to {}", list(&names)));
    }
    if !further.is_empty() {
        let what = if inner.is_empty() { "" } else { "further" };
        parts.push(counted(further.len(), what, "door", "doors"));
    }
    let open = &scene.semantics.room(room).passages;
    if !open.is_empty() {
        let names: Vec<String> = open
            .iter()
            .map(|other| format!("the {}", scene.semantics.room(*other).label))
            .collect();
        let count = counted(open.len(), "open", "passage", "passages");
        parts.push(format!("{count} to {}", list(&names)));
    }
    (!parts.is_empty()).then(|| format!("It has {}.", list(&parts)))
}

/// What does not stand on the floor: things by what carries them and how, and what hangs on walls.
#[derive(Default)]
struct Placed {
    carried: BTreeMap<(ObjectId, &'static str), Vec<ObjectId>>,
    hanging: Vec<ObjectId>,
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
                .or_insert_with(Vec::new)
                .push(*object);
            continue;
        }
        let walls = house
            .structure
            .iter_ids()
            .filter(|(_, piece)| piece.kind == StructureKind::Wall);
        let hangs = predicates::find("hangs_on").is_ok_and(|predicate| {
            walls.into_iter().any(|(wall, _)| {
                predicate.holds(scene, Term::Object(*object), Term::Structure(wall), None)
            })
        });
        if hangs && !scene.facts(*object).is_opening() {
            placed.hanging.push(*object);
        }
    }
    placed
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
    let Placed {
        carried: on,
        hanging,
    } = placed(scene, room, &objects);
    let standing: Vec<ObjectId> = objects
        .iter()
        .filter(|object| {
            !hanging.contains(object) && !on.values().flatten().any(|other| other == *object)
        })
        .copied()
        .collect();
    let texts = |objects: &[ObjectId]| -> Vec<String> {
        grouped(scene, objects)
            .iter()
            .map(|group| group.text(scene))
            .collect()
    };
    if standing.is_empty() && on.is_empty() && hanging.is_empty() {
        sentences.push("It is empty.".to_owned());
    }
    if !standing.is_empty() {
        // "There is a bed, ..." agrees with the first thing of the list, as people speak.
        let first = grouped(scene, &standing)[0].objects.len();
        sentences.push(format!("There {} {}.", be(first), list(&texts(&standing))));
    }
    for ((carrier, words), things) in &on {
        let verb = be(things.len());
        let place = landmark(scene, *carrier, Some(room));
        sentences.push(format!(
            "{} {place} {verb} {}.",
            capitalized(words),
            list(&texts(things))
        ));
    }
    if !hanging.is_empty() {
        let verb = if hanging.len() == 1 { "hangs" } else { "hang" };
        sentences.push(format!("On the wall {verb} {}.", list(&texts(&hanging))));
    }
    sentences.join(" ")
}
