//! The shortest description that fits exactly one thing.

use super::distractors::{LOOK_ALIKES, TELLING, intersection};
use crate::category::SemanticCategory;
use crate::color::Oklab;
use crate::form::{Description, Modifier, Noun, Quantifier};
use crate::predicates;
use crate::scene::{DistractorSet, ObjectList, SemanticScene};
use dwell_scene::ObjectId;
use dwell_scene::interrupt;
use glam::Vec2;
use std::collections::BTreeSet;
use std::rc::Rc;

/// The descriptions of `target` by its own properties, shortest first.
pub(crate) fn property_descriptions(
    scene: &SemanticScene<'_>,
    target: ObjectId,
) -> Vec<Description> {
    let facts = scene.facts(target);
    let noun = Description::new(Quantifier::The, Noun::Object(facts.noun.clone()));
    // A thing without a prevailing colour is not identified by one.
    let spoken: &[_] = if facts.spoken_colors().is_empty() {
        &[]
    } else {
        &facts.colors
    };
    let words = |count: usize| -> Option<Vec<String>> {
        let words = spoken.get(..count)?.iter();
        Some(words.map(|(word, _)| (*word).to_owned()).collect())
    };
    let (color, two) = (words(1), words(2));
    let material = facts.material_word().map(str::to_owned);
    let size = facts.size.word().map(|_| facts.size);
    let mut found = vec![noun.clone()];
    found.extend(color.iter().map(|colors| Description {
        colors: colors.clone(),
        ..noun.clone()
    }));
    found.extend(material.iter().map(|word| Description {
        material: Some(word.clone()),
        ..noun.clone()
    }));
    found.extend(size.map(|size| Description {
        size: Some(size),
        ..noun.clone()
    }));
    if let (Some(colors), Some(word)) = (&color, &material) {
        found.push(Description {
            colors: colors.clone(),
            material: Some(word.clone()),
            ..noun.clone()
        });
    }
    if let (Some(colors), Some(size)) = (&color, size) {
        found.push(Description {
            colors: colors.clone(),
            size: Some(size),
            ..noun.clone()
        });
    }
    found.extend(two.map(|colors| Description { colors, ..noun }));
    found
}

/// Share of a thing's longest edge below which what lies beside it does not lead to it.
const LEAST_LANDMARK: f32 = 0.25;
/// Distance of the main colours of two things, in `OKLab`, below which readers do not tell them apart by these: three times what is just
/// noticeable.
const ALIKE: f32 = 0.06;

/// The relations of `target` to other things, each named by its noun and at most one adjective; each once.
pub(crate) fn relation_modifiers(scene: &SemanticScene<'_>, target: ObjectId) -> Vec<Modifier> {
    let mut found: Vec<Modifier> = Vec::new();
    let mut known: BTreeSet<(&str, &str, Option<&str>)> = BTreeSet::new();
    let longest = |id| scene.facts(id).extents_m.max_element();
    // Nobody looks for the bread on a table beside a chair.
    let own_carrier = carrier(scene, target);
    for name in TELLING {
        let Ok(predicate) = predicates::find(name) else {
            continue;
        };
        for landmark in predicates::related_objects(scene, predicate, target) {
            let row = scene.facts(landmark).category;
            if row.is_none_or(SemanticCategory::is_vague)
                || scene.facts(landmark).belongs_to_opening()
                || (name == "in" && scene.is_seat_or_bed(landmark))
                || (name == "next_to" && longest(landmark) < LEAST_LANDMARK * longest(target))
                || (name == "next_to" && carrier(scene, landmark) != own_carrier)
                || (name == "next_to" && stands_between(scene, target, landmark))
            {
                continue;
            }
            let facts = scene.facts(landmark);
            let color = facts.spoken_colors().first().map(|(color, _)| *color);
            let words = [None].into_iter().chain(color.map(Some));
            for color in words {
                if !known.insert((name, facts.noun.as_str(), color)) {
                    continue;
                }
                let noun = Noun::Object(facts.noun.clone());
                let landmark = Description {
                    colors: color.map(str::to_owned).into_iter().collect(),
                    ..Description::new(Quantifier::Some, noun)
                };
                found.push(Modifier::new(name, [landmark.into()]));
            }
        }
    }
    found
}

/// Returns whether a neighbour of a thing stands between it and another one: readers call that the nearer one's neighbour.
pub(crate) fn stands_between(
    scene: &SemanticScene<'_>,
    target: ObjectId,
    landmark: ObjectId,
) -> bool {
    let [from, to] = [target, landmark].map(|id| scene.extent(id).bounds.center());
    let way = Vec2::new(to.x - from.x, to.z - from.z);
    let reaches_over = |other: &ObjectId| {
        let bounds = scene.extent(*other).bounds;
        // The part of the way that lies between both faces of the box, axis by axis.
        let part = |start: f32, step: f32, low: f32, high: f32| {
            if step == 0.0 {
                return if (low..=high).contains(&start) {
                    [0.0, 1.0]
                } else {
                    [1.0, 0.0]
                };
            }
            let (a, b) = ((low - start) / step, (high - start) / step);
            [a.min(b), a.max(b)]
        };
        let x = part(from.x, way.x, bounds.min.x, bounds.max.x);
        let z = part(from.z, way.y, bounds.min.z, bounds.max.z);
        let (enter, leave) = (x[0].max(z[0]).max(0.0), x[1].min(z[1]).min(1.0));
        enter < leave
    };
    let neighbours = scene.neighbours(target).iter();
    let others = neighbours.filter(|other| **other != landmark && !scene.facts(**other).is_rug());
    let both = [target, landmark].map(|id| scene.extent(id).bounds);
    // A chair under the table's edge is before it, not between.
    let is_apart = |other: &&ObjectId| {
        let own = scene.extent(**other).bounds;
        both.iter().all(|bounds| !bounds.intersects(&own))
    };
    others.filter(is_apart).any(reaches_over)
}

/// What a thing stands on or in; `None` on floors, rugs and walls.
fn carrier(scene: &SemanticScene<'_>, object: ObjectId) -> Option<ObjectId> {
    ["on", "in"].iter().find_map(|name| {
        let predicate = predicates::find(name).ok()?;
        let under = predicates::related_objects(scene, predicate, object).into_iter();
        under.filter(|other| !scene.facts(*other).is_rug()).min()
    })
}

/// Returns whether the main colours of two things are too near to tell them apart.
fn have_near_colors(scene: &SemanticScene<'_>, one: ObjectId, other: ObjectId) -> bool {
    let main = |id| {
        let patch = scene.facts(id).patches.first()?;
        Some(Oklab::from_linear(patch.linear?))
    };
    let near = main(one).zip(main(other));
    near.is_some_and(|(one, other)| one.distance(other) < ALIKE)
}

/// The same relation with "the" before a landmark that is the only one of its description in the house.
fn with_article(scene: &SemanticScene<'_>, relation: Modifier) -> Modifier {
    let [crate::form::Phrase::Described(landmark)] = &relation.arguments[..] else {
        return relation;
    };
    let Noun::Object(noun) = &landmark.noun else {
        return relation;
    };
    let is_only = scene.distractors(noun).matching(scene, landmark).len() == 1;
    if !is_only {
        return relation;
    }
    let definite = landmark.as_ref().clone().with_quantifier(Quantifier::The);
    Modifier::new(&relation.predicate, [definite.into()])
}

/// The shortest description of `target` that fits nothing else in the house, or `None` when properties, room and one
/// landmark do not tell it apart.
///
/// # Source
/// After the incremental algorithm of R. Dale and E. Reiter, Cognitive Science 19, 233 (1995); here every candidate is
/// checked against all objects, so that a result is unique by construction.
pub fn refer(scene: &SemanticScene<'_>, target: ObjectId) -> Option<Description> {
    // All candidates share the noun, so only things that it may name can fit them.
    let facts = scene.facts(target);
    let alike = scene.distractors(&facts.noun);
    let look_alikes = LOOK_ALIKES.iter().filter(|(noun, ..)| *noun == facts.noun);
    let look_alikes: Vec<_> = look_alikes
        .map(|(_, other, colored)| (scene.distractors(other), *colored))
        .collect();
    // Those of another noun that a description may be taken to mean.
    let confused = |description: &Description| -> Vec<ObjectList> {
        let of = |(things, colored): &(Rc<DistractorSet>, bool)| {
            let mut seen = description.clone();
            if !colored {
                seen.colors.clear();
            }
            things.matching_by_trace(scene, &seen)
        };
        look_alikes.iter().map(of).collect()
    };
    let fitting = |description: &Description| -> ObjectList {
        let mut found = alike.matching(scene, description).to_vec();
        if !description.colors.is_empty() {
            let plain = Description {
                colors: Vec::new(),
                ..description.clone()
            };
            let others = alike.matching(scene, &plain);
            found.extend(
                others
                    .iter()
                    .filter(|other| have_near_colors(scene, **other, target)),
            );
            found.sort_unstable();
            found.dedup();
        }
        found.into()
    };
    let unique = |description: &Description| {
        let others = confused(description);
        *fitting(description) == [target] && others.iter().all(|things| things.is_empty())
    };
    let room = scene.room_of(target).map(|room| {
        let facts = scene.semantics.room(room);
        // "A bedroom" of several: no list of the house's own numbers them for whoever reads it.
        let quantifier = match facts.number {
            None => Quantifier::The,
            Some(_) => Quantifier::Some,
        };
        let room = Description::new(quantifier, Noun::Room(facts.noun.clone()));
        Modifier::new("in_room", [room.into()])
    });
    let own = property_descriptions(scene, target);
    let in_room: Vec<Description> = match &room {
        None => own.clone(),
        Some(room) => {
            let own = own.iter().cloned();
            own.map(|description| description.with_modifier(room.clone()))
                .collect()
        }
    };
    // The noun, then the noun with the room, then adjectives without and with the room.
    let plain = own[..1]
        .iter()
        .chain(&in_room[..1])
        .chain(&own)
        .chain(&in_room);
    if let Some(found) = plain.into_iter().find(|description| unique(description)) {
        return Some(found.clone());
    }
    let relations = relation_modifiers(scene, target);
    let marked = relations.iter().map(|relation| {
        interrupt::unwind_if_cancelled();
        alike.with_landmark(scene, relation)
    });
    let marked: Vec<ObjectList> = marked.collect();
    for description in own.iter().chain(&in_room).take(8) {
        let (fitting, confused) = (fitting(description), confused(description));
        for (relation, marked) in relations.iter().zip(&marked) {
            let is_taken = |(things, own): (&ObjectList, &(Rc<DistractorSet>, bool))| {
                let marked = own.0.with_landmark(scene, relation);
                !intersection(&[things, &marked], 1).is_empty()
            };
            let only = intersection(&[&fitting, marked], 2) == [target];
            if only && !confused.iter().zip(&look_alikes).any(is_taken) {
                let mut description = description.clone();
                let relation = with_article(scene, relation.clone());
                // "The lamp on the table in the kitchen": the relation before the room.
                description.modifiers.insert(0, relation);
                return Some(description);
            }
        }
    }
    None
}
