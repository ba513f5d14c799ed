//! What has changed between two states of a house.

use super::text::{GroundedText, TextWriter};
use crate::check::{Addressee, Checker};
use crate::form::{Clause, Description, Form, Modifier, Noun, Phrase, Quality, Quantifier};
use crate::predicates;
use crate::refer::{refer, room_phrase};
use crate::scene::{SemanticScene, Term};
use dwell_scene::ObjectId;
use dwell_scene::interrupt;
use dwell_scene::random::RandomKey;

/// Distance from which a thing that stays in its room and on what it stood on counts as moved, m.
const MOVED_M: f32 = 0.3;
/// States that may change, by the predicates of what is told.
const STATES: [&str; 5] = ["open", "half_open", "closed", "switched_on", "switched_off"];
/// Relations by which the place of a thing is told, the most telling first.
const PLACES: [&str; 2] = ["in", "on"];

/// What a thing is in or on.
fn carrier(scene: &SemanticScene<'_>, object: ObjectId) -> Option<(&'static str, ObjectId)> {
    PLACES.into_iter().find_map(|name| {
        let predicate = predicates::find(name).ok()?;
        let others = predicates::related_objects(scene, predicate, object);
        others.first().map(|other| (name, *other))
    })
}

/// A description of a thing that holds of it alone, and says nothing of its place.
fn placeless(scene: &SemanticScene<'_>, object: ObjectId) -> Option<Description> {
    refer(scene, object).filter(|own| own.modifiers.is_empty())
}

fn now(clause: Clause) -> Form {
    Form::Claim(Clause::Now(Box::new(clause)))
}

/// The place that a thing has come to, or has left.
struct PlaceChange {
    predicate: &'static str,
    landmark: Phrase,
    has_left: bool,
}

impl PlaceChange {
    fn to(predicate: &'static str, landmark: Phrase) -> Self {
        Self {
            predicate,
            landmark,
            has_left: false,
        }
    }

    fn from(predicate: &'static str, landmark: Phrase) -> Self {
        Self {
            has_left: true,
            ..Self::to(predicate, landmark)
        }
    }

    /// What of `subject` is so since the change.
    fn clause(&self, subject: Phrase) -> Clause {
        let own = Clause::Holds {
            predicate: self.predicate.to_owned(),
            arguments: vec![subject, self.landmark.clone()],
        };
        if self.has_left {
            Clause::Not(Box::new(own))
        } else {
            own
        }
    }

    /// How many things of a noun are there since the change; `None` of a place that was left.
    fn count(&self, checker: &Checker<'_>, noun: &str) -> Option<Clause> {
        let noun = Noun::Object(noun.to_owned());
        let there = Modifier::new(self.predicate, [self.landmark.clone()]);
        let what = Description::new(Quantifier::Some, noun).with_modifier(there);
        let number = checker.matching_terms(&what).len() as u32;
        let quantifier = match number {
            0 => return None,
            1 => Quantifier::Some,
            number => Quantifier::Exactly(number),
        };
        (!self.has_left).then(|| Clause::Exists(what.with_quantifier(quantifier).into()))
    }
}

/// Where a thing has come to: what it is in or on, else its room, else what it is next to; else what it is not in, on or next to
/// any more. `None` where it has not moved, or nothing of that can be said.
fn place_change(
    before: &SemanticScene<'_>,
    after: &SemanticScene<'_>,
    object: ObjectId,
) -> Option<PlaceChange> {
    let (old, new) = (carrier(before, object), carrier(after, object));
    if let Some((name, landmark)) = new.filter(|_| new != old)
        && let Some(landmark) = refer(after, landmark)
    {
        return Some(PlaceChange::to(name, landmark.into()));
    }
    if let Some(room) = after.room_of(object)
        && before.room_of(object) != Some(room)
    {
        return Some(PlaceChange::to("in_room", room_phrase(after, room)));
    }
    let moved = before.extent(object).bounds.center() - after.extent(object).bounds.center();
    if moved.length() < MOVED_M {
        let (name, landmark) = old.filter(|_| new != old)?;
        return Some(PlaceChange::from(name, refer(after, landmark)?.into()));
    }
    let beside = predicates::find("next_to").ok()?;
    let old = predicates::related_objects(before, beside, object);
    let new = predicates::related_objects(after, beside, object);
    let named = |of: &[ObjectId], without: &[ObjectId]| {
        let mut others = of
            .iter()
            .filter(|other| !without.contains(other) && !after.facts(**other).belongs_to_opening());
        others.find_map(|other| refer(after, *other))
    };
    named(&new, &old)
        .map(|landmark| PlaceChange::to("next_to", landmark.into()))
        .or_else(|| named(&old, &new).map(|landmark| PlaceChange::from("next_to", landmark.into())))
}

/// What has changed from one state of a house to another, as claims of the later one: what was opened, closed and switched, what
/// is in another place, what somebody holds, and where the listener is. Empty where nothing that can be said has changed.
///
/// A thing has moved when it is in or on something else or in another room, or 0.3 m from where it was. Things that no description without their
/// place tells apart are counted where they are: "there are two cups in the sink now". `wording` draws the wordings. Both scenes must be of one house.
pub fn describe_changes(
    before: &SemanticScene<'_>,
    after: &SemanticScene<'_>,
    listener: Addressee,
    wording: Option<RandomKey>,
) -> GroundedText {
    let checker = Checker::new(after, listener);
    let mut writer = TextWriter::new(&checker, wording);
    let room = |scene: &SemanticScene<'_>| listener.agent.and_then(|own| scene.room_of_agent(own));
    if let Some(room) = room(after).filter(|now| room(before) != Some(*now)) {
        writer.say(now(Clause::Holds {
            predicate: "in_room".to_owned(),
            arguments: vec![Phrase::Listener, room_phrase(after, room)],
        }));
    }
    // Of two cups that were put there it is said once that there are two.
    let mut counted: Vec<Clause> = Vec::new();
    for object in after.house().objects.ids() {
        interrupt::unwind_if_cancelled();
        let term = [Term::Object(object)];
        for state in STATES {
            let is_so = |scene| predicates::is_true(scene, state, &term, None);
            if is_so(after)
                && !is_so(before)
                && let Some(subject) = refer(after, object)
            {
                writer.say(now(Clause::Is {
                    subject: subject.into(),
                    quality: Quality::State(state.to_owned()),
                }));
            }
        }
        let holders = (before.holder(object), after.holder(object));
        let subject = placeless(after, object);
        if let Some(holder) = holders.1 {
            let is_new = holders.0 != Some(holder) && listener.agent == Some(holder);
            if let Some(subject) = subject.filter(|_| is_new) {
                writer.say(now(Clause::Holds {
                    predicate: "held_by".to_owned(),
                    arguments: vec![subject.into(), Phrase::Listener],
                }));
            }
            continue;
        }
        let Some(change) = place_change(before, after, object) else {
            continue;
        };
        let clause = match subject {
            Some(subject) => Some(change.clause(subject.into())),
            None => change.count(&checker, &after.facts(object).noun),
        };
        if let Some(clause) = clause.filter(|clause| !counted.contains(clause)) {
            writer.say(now(clause.clone()));
            counted.push(clause);
        }
    }
    writer.finish()
}
