//! The description of a room.

use super::hanging::{MountKind, MountedObject};
use super::item::{grouped, items};
use super::openings::{say_doors, say_passages};
use super::options::{TextLength, TextOptions, TextStyle};
use super::surroundings::say_surroundings;
use super::text::{GroundedText, TextWriter};
use crate::check::{Addressee, Checker, rounded_area_m2};
use crate::form::{
    Clause, Description, Form, Modifier, Noun, Phrase, Quantifier, RoomSurface, RoomSurfaceKind,
};
use crate::predicates;
use crate::refer::{refer, room_phrase};
use crate::scene::SemanticScene;
use dwell_scene::interrupt;
use dwell_scene::{ObjectId, RoomId};
use std::collections::{BTreeMap, BTreeSet};

/// Says the room's area.
fn say_area(writer: &mut TextWriter<'_>, scene: &SemanticScene<'_>, room: RoomId) {
    writer.say(Form::Claim(Clause::Area {
        room: room_phrase(scene, room),
        square_metres: rounded_area_m2(scene.semantics.room(room).area_m2),
    }));
}

/// The look of a room's floor and walls, as far as one colour or substance prevails.
pub(super) fn surfaces(scene: &SemanticScene<'_>, room: RoomId) -> Vec<RoomSurface> {
    let facts = scene.semantics.room(room);
    let mut surfaces = Vec::new();
    if facts.floor_color.is_some() || facts.floor_word.is_some() {
        surfaces.push(RoomSurface {
            kind: RoomSurfaceKind::Floor,
            color: facts.floor_color.map(str::to_owned),
            material: facts.floor_word.map(str::to_owned),
        });
    }
    surfaces.extend(facts.wall_color.map(|word| RoomSurface {
        kind: RoomSurfaceKind::Walls,
        color: Some(word.to_owned()),
        material: None,
    }));
    surfaces
}

/// Says the look of the room's floor and walls.
fn say_surfaces(writer: &mut TextWriter<'_>, scene: &SemanticScene<'_>, room: RoomId) {
    let surfaces = surfaces(scene, room);
    if !surfaces.is_empty() {
        let room = room_phrase(scene, room);
        writer.say(Form::Claim(Clause::HasSurfaces { room, surfaces }));
    }
}

/// The contents of a room by their places.
#[derive(Default)]
struct RoomContents {
    /// Things in and on others, by the relation and the description of their carrier.
    carried: BTreeMap<(ObjectId, &'static str), Vec<ObjectId>>,
    hanging: Vec<MountedObject>,
    standing: Vec<ObjectId>,
}

fn contents(scene: &SemanticScene<'_>, room: RoomId, objects: &[ObjectId]) -> RoomContents {
    let mut contents = RoomContents::default();
    for object in objects {
        interrupt::unwind_if_cancelled();
        let carrier = ["in", "on"].into_iter().find_map(|name| {
            let predicate = predicates::find(name).ok()?;
            let others = predicates::related_objects(scene, predicate, *object);
            let carrier = others.into_iter().find(|other| {
                scene.room_of(*other) == Some(room)
                    && !(name == "in" && scene.is_seat_or_bed(*other))
            })?;
            Some((carrier, name))
        });
        // Furniture on a rug stands in the room.
        if let Some(key) = carrier.filter(|(carrier, _)| !scene.facts(*carrier).is_rug()) {
            contents.carried.entry(key).or_default().push(*object);
            continue;
        }
        match MountedObject::of(scene, *object).filter(|hanging| !hanging.noun_names_mount(scene)) {
            Some(hanging) => contents.hanging.push(hanging),
            None => contents.standing.push(*object),
        }
    }
    contents
}

/// Largest number of carriers of one noun that no description tells apart of which each has its own sentence.
const MAX_SEPARATE_CARRIERS: usize = 8;

/// Things on or in a carrier, or on or in carriers that no description tells apart.
struct CarrierGroup {
    predicate: &'static str,
    carrier: Description,
    objects: Vec<ObjectId>,
    /// All things on or in the carriers that the description fits; `None` where others than these carry things, too.
    candidates: Option<Vec<ObjectId>>,
}

impl CarrierGroup {
    fn items(&self, scene: &SemanticScene<'_>, style: TextStyle) -> Vec<Description> {
        if let Some(candidates) = &self.candidates {
            return items(scene, &self.objects, candidates, style);
        }
        let mut items = items(scene, &self.objects, &self.objects, style);
        // "On a table there are two cups" of this table, whatever is on the others that are tables, too.
        for item in &mut items {
            if let Quantifier::Exactly(number) = item.quantifier {
                item.quantifier = Quantifier::AtLeast(number);
            }
        }
        items
    }
}

/// The carriers of things, the largest kinds first, as lists have them: a table before the bowl on it.
fn carrier_groups(
    scene: &SemanticScene<'_>,
    room: RoomId,
    carried: BTreeMap<(ObjectId, &'static str), Vec<ObjectId>>,
) -> Vec<CarrierGroup> {
    let mut carriers: Vec<ObjectId> = carried.keys().map(|(carrier, _)| *carrier).collect();
    carriers.dedup();
    let mut ranks: BTreeMap<ObjectId, usize> = BTreeMap::new();
    for (rank, group) in grouped(scene, &carriers).iter().enumerate() {
        ranks.extend(group.objects.iter().map(|object| (*object, rank)));
    }
    let mut ordered: Vec<((ObjectId, &'static str), Vec<ObjectId>)> = carried.into_iter().collect();
    // Stable: within a kind as the house has them.
    ordered.sort_by_key(|((carrier, _), _)| ranks.get(carrier).copied());
    let mut groups: Vec<CarrierGroup> = Vec::new();
    // The groups of carriers that no description tells apart, by noun and relation.
    let mut alike: BTreeMap<(&str, &str), Vec<usize>> = BTreeMap::new();
    for ((carrier, predicate), objects) in ordered {
        let told_apart = refer(scene, carrier);
        if told_apart.is_none() {
            let noun = scene.facts(carrier).noun.as_str();
            alike
                .entry((noun, predicate))
                .or_default()
                .push(groups.len());
        }
        let candidates = told_apart
            .is_some()
            .then(|| carried_by(scene, predicate, &[carrier]));
        groups.push(CarrierGroup {
            predicate,
            carrier: told_apart.unwrap_or_else(|| object_in_room(scene, carrier, room)),
            objects,
            candidates,
        });
    }
    for ((noun, predicate), own) in alike {
        let distractors = scene.distractors(noun);
        let here = distractors.things.iter().copied();
        let here: Vec<ObjectId> = here
            .filter(|other| scene.room_of(*other) == Some(room))
            .collect();
        let all = carried_by(scene, predicate, &here);
        if own.len() > MAX_SEPARATE_CARRIERS {
            let rest: Vec<ObjectId> = own[1..]
                .iter()
                .flat_map(|k| std::mem::take(&mut groups[*k].objects))
                .collect();
            groups[own[0]].objects.extend(rest);
        }
        let told = own
            .iter()
            .filter(|k| !groups[**k].objects.is_empty())
            .count();
        if told == 1 {
            groups[own[0]].candidates = Some(all);
        }
    }
    groups.retain(|group| !group.objects.is_empty());
    groups
}

/// "A table in the kitchen."
pub(super) fn object_in_room(
    scene: &SemanticScene<'_>,
    object: ObjectId,
    room: RoomId,
) -> Description {
    let noun = Noun::Object(scene.facts(object).noun.clone());
    let in_room = Modifier::new("in_room", [room_phrase(scene, room)]);
    Description::new(Quantifier::Some, noun).with_modifier(in_room)
}

/// The things in or on some carriers, ascending.
fn carried_by(scene: &SemanticScene<'_>, predicate: &str, carriers: &[ObjectId]) -> Vec<ObjectId> {
    let converse = if predicate == "in" {
        "contains"
    } else {
        "supports"
    };
    let Ok(converse) = predicates::find(converse) else {
        return Vec::new();
    };
    let carried = carriers
        .iter()
        .flat_map(|carrier| predicates::related_objects(scene, converse, *carrier));
    let carried: BTreeSet<ObjectId> = carried.collect();
    carried.into_iter().collect()
}

/// Largest number of kinds of things in a short text.
const MAX_SHORT_KINDS: usize = 4;
/// Largest number of things of which a long text says where they stand.
const MAX_PLACED: usize = 8;

/// Says a room: its size and surfaces, its openings, what it has in it, what lies on what, and what hangs; in a short text only its size
/// and the largest things that stand in it, in a long one also where the largest of them stand.
pub(super) fn say_room(
    writer: &mut TextWriter<'_>,
    scene: &SemanticScene<'_>,
    room: RoomId,
    options: TextOptions,
) {
    let TextOptions { length, style, .. } = options;
    say_area(writer, scene, room);
    if length != TextLength::Short {
        if style == TextStyle::Rich {
            say_surfaces(writer, scene, room);
        }
        say_passages(writer, scene, room);
        say_doors(writer, scene, room);
    }
    let in_room = Modifier::new("in_room", [room_phrase(scene, room)]);
    let all = scene.objects_in(room);
    if all.is_empty() {
        let nothing = Noun::Object(Noun::ANY_OBJECT.to_owned());
        writer.there_are(&[Description::new(Quantifier::No, nothing)], &[in_room]);
        return;
    }
    let told: Vec<ObjectId> = all
        .iter()
        .copied()
        .filter(|object| !scene.facts(*object).is_door() && scene.holder(*object).is_none())
        .collect();
    let RoomContents {
        carried,
        hanging,
        standing,
    } = contents(scene, room, &told);
    let place = std::slice::from_ref(&in_room);
    let mut largest = items(scene, &standing, all, style);
    if length == TextLength::Short {
        largest.truncate(MAX_SHORT_KINDS);
        writer.there_are(&largest, place);
        return;
    }
    writer.there_are(&largest, place);
    if length == TextLength::Long {
        say_places(writer, scene, &standing);
    }
    for group in carrier_groups(scene, room, carried) {
        let items = group.items(scene, style);
        let carrier = Phrase::from(group.carrier);
        writer.there_are(&items, &[Modifier::new(group.predicate, [carrier])]);
    }
    if hanging.is_empty() {
        return;
    }
    // With those whose nouns say it: a wall lamp is a lamp on the wall.
    let mounted = all
        .iter()
        .filter_map(|object| MountedObject::of(scene, *object));
    let mounted: Vec<MountedObject> = mounted.collect();
    for mount in MountKind::ALL {
        let on_mount = |all: &[MountedObject]| -> Vec<ObjectId> {
            let own = all.iter().filter(|one| one.mount == mount);
            own.map(|one| one.object).collect()
        };
        let items = items(scene, &on_mount(&hanging), &on_mount(&mounted), style);
        writer.there_are(&items, &[mount.modifier(), in_room.clone()]);
    }
}

/// Says where the largest of the things that stand in a room stand, as far as a description fits each alone.
fn say_places(writer: &mut TextWriter<'_>, scene: &SemanticScene<'_>, standing: &[ObjectId]) {
    let groups = grouped(scene, standing);
    let largest = groups.iter().flat_map(|group| &group.objects);
    for object in largest.take(MAX_PLACED) {
        if let Some(subject) = refer(scene, *object) {
            say_surroundings(writer, scene, *object, &subject, None);
        }
    }
}

/// The description of a room.
pub fn describe_room(
    scene: &SemanticScene<'_>,
    room: RoomId,
    options: TextOptions,
) -> GroundedText {
    let checker = Checker::new(scene, Addressee::default());
    describe_with(&checker, room, options)
}

/// The descriptions of all rooms, in order.
pub fn describe_rooms(scene: &SemanticScene<'_>, options: TextOptions) -> Vec<GroundedText> {
    scene.measure_places();
    let checker = Checker::new(scene, Addressee::default());
    let rooms = scene.house().rooms.ids().enumerate();
    rooms
        .map(|(k, room)| describe_with(&checker, room, options.for_nth_text(k)))
        .collect()
}

fn describe_with(checker: &Checker<'_>, room: RoomId, options: TextOptions) -> GroundedText {
    let mut writer = TextWriter::new(checker, options.wording);
    say_room(&mut writer, checker.scene(), room, options);
    writer.finish()
}
