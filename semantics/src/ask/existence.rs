//! "Is there a piano in the living room?"

use super::question_generator::{AnswerEvidence, QuestionGenerator};
use super::{AskedQuestion, QuestionKind};
use crate::form::{Clause, Question};
use dwell_scene::ObjectId;
use dwell_scene::interrupt;

/// Of every kind of thing that the house has somewhere, and every room that has a name.
pub(super) fn candidates(asker: &QuestionGenerator<'_>) -> Vec<AskedQuestion> {
    let (nouns, mut found) = (asker.nouns(), Vec::new());
    for (room, name) in asker.named_rooms() {
        for noun in &nouns {
            interrupt::unwind_if_cancelled();
            let things = QuestionGenerator::noun_in_room(noun, &name);
            let volume = |object: &ObjectId| asker.scene.extent(*object).bounds.volume();
            let fits = asker.matching_objects(&things).into_iter();
            // One is enough, and the largest is seen best.
            let largest = fits.max_by(|p, q| volume(p).total_cmp(&volume(q)));
            let question = Question::Whether(Clause::Exists(things.into()));
            let sight = AnswerEvidence {
                seen: largest.into_iter().collect(),
                target: None,
                room,
            };
            found.extend(asker.compose(QuestionKind::Existence, question, sight));
        }
    }
    found
}
