//! Captions of objects.

use super::hanging::MountedObject;
use super::item::appearance;
use super::options::{TextLength, TextOptions};
use super::surroundings::{say_contents, say_surroundings};
use super::text::{GroundedText, TextWriter};
use crate::check::{Addressee, Checker};
use crate::form::{Description, Modifier, Noun, Quantifier};
use crate::predicates;
use crate::refer::{refer, room_phrase};
use crate::scene::{SemanticScene, Term};
use dwell_scene::{ObjectId, RoomId};

/// A landmark by its noun: "the table" where the house has one only, else "a table".
pub(super) fn landmark(scene: &SemanticScene<'_>, object: ObjectId) -> Description {
    let noun = &scene.facts(object).noun;
    let is_only = scene.distractors(noun).things.len() == 1;
    let quantifier = if is_only {
        Quantifier::The
    } else {
        Quantifier::Some
    };
    Description::new(quantifier, Noun::Object(noun.clone()))
}

fn first_related(scene: &SemanticScene<'_>, object: ObjectId, name: &str) -> Option<ObjectId> {
    let predicate = predicates::find(name).ok()?;
    let mut found = predicates::related_objects(scene, predicate, object);
    // A thing is placed by something larger than itself; the largest is the easiest to find.
    let marks =
        |id: ObjectId| scene.facts(id).category.is_some() && !scene.facts(id).belongs_to_opening();
    found.retain(|other| name != "next_to" || marks(*other));
    found.retain(|other| name != "in" || !scene.is_seat_or_bed(*other));
    let volume = |id: ObjectId| scene.extent(id).bounds.volume();
    let largest = found
        .into_iter()
        .max_by(|p, q| volume(*p).total_cmp(&volume(*q)).then(q.cmp(p)))?;
    (name != "next_to" || volume(largest) > 0.3 * volume(object)).then_some(largest)
}

/// The sides of a door: from a room to another or to the outside; `None` when that is not known, and for other things.
fn door_side_modifiers(
    scene: &SemanticScene<'_>,
    door: ObjectId,
    room: Option<RoomId>,
) -> Option<[Modifier; 2]> {
    let doorway = scene.semantics.doorway(door)?;
    let leads = |predicate: &str, room| Modifier::new(predicate, [room_phrase(scene, room)]);
    match doorway.rooms[..] {
        [one] if doorway.outside => {
            Some([leads("leads_from", one), Modifier::new("leads_outside", [])])
        }
        [one, other] if room == Some(other) => {
            Some([leads("leads_from", other), leads("leads_to", one)])
        }
        [one, other] => Some([leads("leads_from", one), leads("leads_to", other)]),
        _ => None,
    }
}

/// Its place beside something else: "on the table"; `None` when nothing is near.
fn place(scene: &SemanticScene<'_>, object: ObjectId) -> Option<Modifier> {
    let related = |name: &str| {
        let other = first_related(scene, object, name)?;
        Some(Modifier::new(name, [landmark(scene, other).into()]))
    };
    if let Some(place) = related("in").or_else(|| related("on")) {
        return Some(place);
    }
    match MountedObject::of(scene, object) {
        Some(hanging) if hanging.noun_names_mount(scene) => None,
        Some(hanging) => Some(hanging.mount.modifier()),
        None => related("next_to"),
    }
}

/// A description of an object by its looks, place and room; in a short text by its looks.
fn description(scene: &SemanticScene<'_>, object: ObjectId, options: TextOptions) -> Description {
    let room = scene.room_of(object);
    let mut description = appearance(scene, object, options.style);
    let is_on = scene.house().objects[object].switch.is_some() && scene.state.switched_on[object];
    if is_on && description.state.is_none() {
        description.state = Some("switched_on".to_owned());
    }
    if options.length == TextLength::Short {
        return description;
    }
    if let Some(passage) = door_side_modifiers(scene, object, room) {
        description.modifiers.extend(passage);
        return description;
    }
    if scene.holder(object).is_some() {
        description.modifiers.push(Modifier::new("held", []));
    } else {
        description.modifiers.extend(place(scene, object));
    }
    let in_room = room.map(|room| Modifier::new("in_room", [room_phrase(scene, room)]));
    description.modifiers.extend(in_room);
    description
}

/// A caption: "a brown wooden chair next to the table in the kitchen"; short: "a brown wooden chair". A long one is made of
/// sentences, and goes on with where the thing stands and what lies on it, as far as a description fits it alone.
pub fn caption(scene: &SemanticScene<'_>, object: ObjectId, options: TextOptions) -> GroundedText {
    let checker = Checker::new(scene, Addressee::default());
    caption_with(&checker, object, options)
}

/// The captions of all objects, in order.
pub fn captions(scene: &SemanticScene<'_>, options: TextOptions) -> Vec<GroundedText> {
    let checker = Checker::new(scene, Addressee::default());
    let objects = scene.house().objects.ids().enumerate();
    objects
        .map(|(k, object)| caption_with(&checker, object, options.for_nth_text(k)))
        .collect()
}

fn caption_with(checker: &Checker<'_>, object: ObjectId, options: TextOptions) -> GroundedText {
    let scene = checker.scene();
    let mut writer = TextWriter::new(checker, options.wording);
    let description = description(scene, object, options);
    if options.length < TextLength::Long {
        writer.say_phrase_about(description.into(), Term::Object(object));
        return writer.finish();
    }
    writer.there_are(std::slice::from_ref(&description), &[]);
    if let Some(subject) = refer(scene, object) {
        say_surroundings(&mut writer, scene, object, &subject, Some(&description));
        say_contents(&mut writer, scene, object, &subject, options.style);
    }
    writer.finish()
}
