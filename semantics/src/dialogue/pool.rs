//! Questions that can tell some things from each other.

use crate::check::Checker;
use crate::form::{
    AttributeKind, Clause, Description, Form, Noun, Phrase, Quality, Quantifier, Question,
};
use crate::instruct;
use crate::predicates;
use crate::refer::room_phrase;
use crate::scene::Term;
use crate::size::SizeClass;
use dwell_scene::{ObjectId, interrupt};
use std::collections::BTreeSet;

/// Relations to other things that are asked about.
const RELATIONS: [&str; 4] = ["on", "in", "hangs_on", "next_to"];

/// A question about the thing that is meant, as [`super::DialogueTopic::read_question`] gives it.
#[derive(Clone, Debug, PartialEq)]
pub struct ClarificationQuestion {
    /// The form.
    pub form: Form,
    /// The words.
    pub text: String,
}

/// The questions about rooms, colours, materials, sizes and near things that have the answer yes of one of `things`, and those for room,
/// colour, material and place, in order, each in one wording.
///
/// None depends on where anybody stands or looks.
pub fn question_pool(checker: &Checker<'_>, things: &[ObjectId]) -> Vec<ClarificationQuestion> {
    let mut questions: BTreeSet<Question> = BTreeSet::new();
    for thing in things {
        interrupt::unwind_if_cancelled();
        let clauses = clauses_of(checker, *thing).into_iter();
        questions.extend(clauses.map(Question::Whether));
    }
    let open = [
        AttributeKind::Room,
        AttributeKind::Color,
        AttributeKind::Material,
        AttributeKind::Place,
    ];
    let open = open.map(|kind| Question::Attribute {
        kind,
        of: Phrase::Pronoun,
    });
    let language = checker.scene().semantics.language();
    let worded = questions.into_iter().chain(open).filter_map(|question| {
        let form = Form::Question(question);
        let text = instruct::say(language, &form, None)?.text;
        Some(ClarificationQuestion { form, text })
    });
    worded.collect()
}

/// What is true of a thing.
fn clauses_of(checker: &Checker<'_>, thing: ObjectId) -> Vec<Clause> {
    let scene = checker.scene();
    let facts = scene.facts(thing);
    let is = |quality| Clause::Is {
        subject: Phrase::Pronoun,
        quality,
    };
    let holds = |predicate: &str, other: Phrase| Clause::Holds {
        predicate: predicate.to_owned(),
        arguments: vec![Phrase::Pronoun, other],
    };
    let mut found = Vec::new();
    let room = scene.room_of(thing);
    found.extend(room.map(|room| holds("in_room", room_phrase(scene, room))));
    let colors = facts.spoken_colors().iter();
    found.extend(colors.map(|(word, _)| is(Quality::Color((*word).to_owned()))));
    let material = facts.material_word();
    found.extend(material.map(|word| is(Quality::Material(word.to_owned()))));
    if facts.size != SizeClass::Normal {
        found.push(is(Quality::Size(facts.size)));
    }
    for name in RELATIONS {
        let Ok(predicate) = predicates::find(name) else {
            continue;
        };
        for other in predicate.related(scene, Term::Object(thing)) {
            if let Term::Object(other) = other {
                let noun = Noun::Object(scene.facts(other).noun.clone());
                found.push(holds(name, Description::new(Quantifier::Some, noun).into()));
            }
        }
    }
    found
}
