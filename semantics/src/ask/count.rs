//! "How many chairs in the kitchen are there?"

use super::question_generator::{AnswerEvidence, QuestionGenerator};
use super::{AskedQuestion, QuestionKind};
use crate::form::Question;
use dwell_scene::interrupt;

/// The most things that are to be counted.
const MOST: usize = 5;

/// Of every kind of thing that the house has somewhere, and every room that has a name; 0 to 5.
pub(super) fn candidates(asker: &QuestionGenerator<'_>) -> Vec<AskedQuestion> {
    let (nouns, mut found) = (asker.nouns(), Vec::new());
    for (room, name) in asker.named_rooms() {
        for noun in &nouns {
            interrupt::unwind_if_cancelled();
            let things = QuestionGenerator::noun_in_room(noun, &name);
            let seen = asker.matching_objects(&things);
            if seen.len() > MOST {
                continue;
            }
            let sight = AnswerEvidence {
                seen,
                target: None,
                room,
            };
            let question = Question::HowMany(Box::new(things));
            found.extend(asker.compose(QuestionKind::Count, question, sight));
        }
    }
    found
}
