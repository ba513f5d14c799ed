//! What surrounds a thing: where it stands in its room, and what is around it.

use super::hanging::MountedObject;
use super::item::items;
use super::options::TextStyle;
use super::text::{TextWriter, claim};
use crate::form::{Description, Modifier, Noun, Phrase, Quantifier};
use crate::predicates;
use crate::refer::{refer, room_phrase};
use crate::scene::{SemanticScene, Term};
use dwell_scene::ObjectId;

/// Largest number of landmarks that are told for a thing.
const MAX_LANDMARKS: usize = 3;
/// Smallest volume of a landmark, as share of that of the thing.
const MIN_LANDMARK_SHARE: f32 = 0.3;

/// Relations to landmarks in the order of telling; the first ones say more. Each landmark is told by one of them.
const RELATIONS: [&str; 4] = ["above", "below", "facing", "next_to"];
/// Places within a room, the first that holds is told.
const SPOTS: [&str; 2] = ["in_corner_of", "in_middle_of"];

/// The landmarks that no description confuses with others, by their relation to a thing, the largest first. Rugs, openings and
/// what lies on the thing are none.
fn landmarks(scene: &SemanticScene<'_>, object: ObjectId) -> Vec<(&'static str, Phrase)> {
    let volume = |id: ObjectId| scene.extent(id).bounds.volume();
    let mut told: Vec<ObjectId> = Vec::new();
    let mut found = Vec::new();
    for name in RELATIONS {
        let Ok(predicate) = predicates::find(name) else {
            continue;
        };
        let mut others = predicates::related_objects(scene, predicate, object);
        others.retain(|other| {
            scene.room_of(*other) == scene.room_of(object)
                && !told.contains(other)
                && !scene.facts(*other).belongs_to_opening()
                && volume(*other) >= MIN_LANDMARK_SHARE * volume(object)
        });
        others.sort_by(|p, q| volume(*q).total_cmp(&volume(*p)).then(p.cmp(q)));
        for other in others {
            if told.len() == MAX_LANDMARKS {
                return found;
            }
            if let Some(description) = refer(scene, other) {
                told.push(other);
                found.push((name, description.into()));
            }
        }
    }
    found
}

/// Returns whether a thing stands on the floor, as far as relations tell: it is in and on nothing, and mounted on nothing.
fn stands(scene: &SemanticScene<'_>, object: ObjectId) -> bool {
    let is_carried = ["in", "on"].into_iter().any(|name| {
        predicates::find(name).is_ok_and(|predicate| {
            !predicates::related_objects(scene, predicate, object).is_empty()
        })
    });
    !is_carried && MountedObject::of(scene, object).is_none()
}

/// Says where a thing that `subject` describes stands: its spot in the room, then the landmarks around it, those of one relation
/// in one sentence. Relations by which it is described are not said again.
pub(super) fn say_surroundings(
    writer: &mut TextWriter<'_>,
    scene: &SemanticScene<'_>,
    object: ObjectId,
    subject: &Description,
    caption: Option<&Description>,
) {
    let is_told = |name: &str| {
        let described = [Some(subject), caption].into_iter().flatten();
        let mut modifiers = described.flat_map(|description| &description.modifiers);
        modifiers.any(|modifier| modifier.predicate == name)
    };
    let subject: Phrase = subject.clone().into();
    if let Some(room) = scene.room_of(object).filter(|_| stands(scene, object)) {
        let in_spot = |name: &&str| {
            let terms = [Term::Object(object), Term::Room(room)];
            predicates::is_true(scene, name, &terms, None)
        };
        if let Some(spot) = SPOTS.iter().find(|name| in_spot(name)) {
            writer.say(claim(spot, vec![subject.clone(), room_phrase(scene, room)]));
        }
    }
    let mut landmarks = landmarks(scene, object);
    landmarks.retain(|(name, _)| !is_told(name));
    for of_one in landmarks.chunk_by(|(one, _), (other, _)| one == other) {
        let phrases = of_one.iter().map(|(_, phrase)| phrase.clone());
        let mut phrases: Vec<Phrase> = phrases.collect();
        let object = match phrases.len() {
            1 => phrases.remove(0),
            _ => Phrase::List(phrases),
        };
        writer.say(claim(of_one[0].0, vec![subject.clone(), object]));
    }
}

/// Says what lies in and on a thing that `subject` describes; of a container without contents that it is empty.
pub(super) fn say_contents(
    writer: &mut TextWriter<'_>,
    scene: &SemanticScene<'_>,
    object: ObjectId,
    subject: &Description,
    style: TextStyle,
) {
    for (place, converse) in [("on", "supports"), ("in", "contains")] {
        let Ok(predicate) = predicates::find(converse) else {
            continue;
        };
        let load = predicates::related_objects(scene, predicate, object);
        let there = Modifier::new(place, [subject.clone().into()]);
        if !load.is_empty() {
            writer.there_are(&items(scene, &load, &load, style), &[there]);
        } else if place == "in"
            && predicates::is_true(scene, "empty", &[Term::Object(object)], None)
        {
            let nothing = Noun::Object(Noun::ANY_OBJECT.to_owned());
            writer.there_are(&[Description::new(Quantifier::No, nothing)], &[there]);
        }
    }
}
