//! "What is on the desk?", "What is next to the sofa?"

use super::question_generator::{AnswerEvidence, QuestionGenerator};
use super::{AskedQuestion, QuestionKind, answers};
use crate::form::{Clause, Phrase, Question};
use crate::predicates;
use crate::scene::Term;
use dwell_scene::{ObjectId, RoomId};

/// Relations that are asked for, each with the one that lists what has it to a thing.
const RELATIONS: [(&str, &str); 2] = [("on", "supports"), ("next_to", "next_to")];

pub(super) fn candidates(asker: &QuestionGenerator<'_>) -> Vec<AskedQuestion> {
    let mut found = Vec::new();
    for (landmark, room) in asker.things.iter().copied() {
        for relation in RELATIONS {
            found.extend(ask(asker, relation, (landmark, room)));
        }
    }
    found
}

fn ask(
    asker: &QuestionGenerator<'_>,
    (relation, converse): (&str, &str),
    (landmark, room): (ObjectId, RoomId),
) -> Option<AskedQuestion> {
    let predicate = predicates::find(converse).ok()?;
    let things = predicates::related_objects(asker.scene, predicate, landmark);
    // The answer is one word: all that is there has it.
    let mut words = things
        .iter()
        .map(|thing| answers::noun(asker.scene, Term::Object(*thing)));
    let word = words.next()??;
    if words.any(|other| other != Some(word)) {
        return None;
    }
    let name = asker.referring_expressions(landmark).next()?;
    let question = Question::Which {
        kind: None,
        clause: Clause::Holds {
            predicate: relation.to_owned(),
            arguments: vec![Phrase::Hole, name.into()],
        },
    };
    let sight = AnswerEvidence {
        target: things.first().copied(),
        seen: things,
        room,
    };
    asker.compose(QuestionKind::Place, question, sight)
}
