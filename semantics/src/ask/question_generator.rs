//! What questions of all kinds share: the things and rooms that have names of their own, and words with their answer.

use super::guessable::is_guessable;
use super::{AskedQuestion, QuestionKind, StateArrangement, answers};
use crate::check::{Addressee, Checker};
use crate::form::{Description, Form, Modifier, Noun, Quantifier, Question};
use crate::instruct::{self, is_search_target};
use crate::refer::property_descriptions;
use crate::scene::{SemanticScene, Term};
use dwell_scene::interrupt;
use dwell_scene::{ObjectId, RoomId};
use std::collections::BTreeSet;

/// Where the answer of a question is seen.
#[derive(Clone, Debug)]
pub(super) struct AnswerEvidence {
    /// The things that one must see.
    pub(super) seen: Vec<ObjectId>,
    /// The thing to go to; `None`: the room.
    pub(super) target: Option<ObjectId>,
    pub(super) room: RoomId,
}

/// Asks questions about a scene.
pub(super) struct QuestionGenerator<'a> {
    pub(super) scene: &'a SemanticScene<'a>,
    pub(super) checker: Checker<'a>,
    /// The things that are asked about, with their rooms.
    pub(super) things: Vec<(ObjectId, RoomId)>,
}

impl<'a> QuestionGenerator<'a> {
    pub(super) fn new(scene: &'a SemanticScene<'a>) -> Self {
        let objects = scene.house().objects.ids();
        let things = objects.filter_map(|object| {
            let sought = scene.facts(object).category.is_some_and(is_search_target);
            let room = scene.room_of(object).filter(|_| sought)?;
            scene.holder(object).is_none().then_some((object, room))
        });
        Self {
            scene,
            checker: Checker::new(scene, Addressee::default()),
            things: things.collect(),
        }
    }

    /// The names of a thing by its own properties, shortest first, of which each means it alone.
    pub(super) fn referring_expressions(
        &self,
        object: ObjectId,
    ) -> impl Iterator<Item = Description> {
        interrupt::unwind_if_cancelled();
        let own = property_descriptions(self.scene, object).into_iter();
        own.filter(move |name| self.refers_uniquely_to(name, Term::Object(object)))
    }

    /// Returns whether a description means one thing or room alone, in the eyes of all who may divide on it.
    pub(super) fn refers_uniquely_to(&self, description: &Description, term: Term) -> bool {
        self.checker.certain_referent(description) == Some(term)
    }

    /// The name of a room that is the only one of its kind.
    pub(super) fn room_description(&self, room: RoomId) -> Option<Description> {
        let facts = self.scene.semantics.room(room);
        answers::noun(self.scene, Term::Room(room))?;
        let name = Description::new(Quantifier::The, Noun::Room(facts.noun.clone()));
        self.refers_uniquely_to(&name, Term::Room(room))
            .then_some(name)
    }

    /// The rooms that have names, with these.
    pub(super) fn named_rooms(&self) -> Vec<(RoomId, Description)> {
        let rooms = self.scene.house().rooms.ids();
        rooms
            .filter_map(|room| Some((room, self.room_description(room)?)))
            .collect()
    }

    /// The nouns of the things that are asked about, each once.
    pub(super) fn nouns(&self) -> BTreeSet<&'a str> {
        let things = self.things.iter();
        things
            .map(|(object, _)| self.scene.facts(*object).noun.as_str())
            .collect()
    }

    /// "Chairs in the kitchen".
    pub(super) fn noun_in_room(noun: &str, room: &Description) -> Description {
        let things = Description::new(Quantifier::Some, Noun::Object(noun.to_owned()));
        things.with_modifier(Modifier::new("in_room", [room.clone().into()]))
    }

    /// The things that a description fits.
    pub(super) fn matching_objects(&self, description: &Description) -> Vec<ObjectId> {
        let fits = self.checker.matching_terms(description).into_iter();
        fits.filter_map(Term::object).collect()
    }

    /// The question, where there are words for it that do not give its answer away, and one answer.
    pub(super) fn compose(
        &self,
        kind: QuestionKind,
        question: Question,
        sight: AnswerEvidence,
    ) -> Option<AskedQuestion> {
        let text = self.text(&question)?;
        let answer = answers::answer_word(self.scene, &self.checker.answer(&question))?;
        Some(asked(kind, question, (text, answer), sight, None))
    }

    /// The question whose answer is `answer` once something is arranged.
    pub(super) fn compose_rearranged(
        &self,
        kind: QuestionKind,
        question: Question,
        (sets, answer): (StateArrangement, &'static str),
        sight: AnswerEvidence,
    ) -> Option<AskedQuestion> {
        let text = self.text(&question)?;
        Some(asked(kind, question, (text, answer), sight, Some(sets)))
    }

    fn text(&self, question: &Question) -> Option<String> {
        let form = Form::Question(question.clone());
        let sentence = instruct::say(self.scene.semantics.language(), &form, None)?;
        (!is_guessable(&sentence.text)).then_some(sentence.text)
    }
}

fn asked(
    kind: QuestionKind,
    question: Question,
    (text, answer): (String, &'static str),
    AnswerEvidence { seen, target, room }: AnswerEvidence,
    sets: Option<StateArrangement>,
) -> AskedQuestion {
    AskedQuestion {
        kind,
        question,
        text,
        answer,
        seen,
        target,
        room,
        sets,
    }
}
