//! "In which room is the guitar?"

use super::question_generator::{AnswerEvidence, QuestionGenerator};
use super::{AskedQuestion, QuestionKind};
use crate::form::{AttributeKind, Question};

pub(super) fn candidates(asker: &QuestionGenerator<'_>) -> Vec<AskedQuestion> {
    let things = asker.things.iter();
    things
        .filter_map(|(object, room)| {
            let question = Question::Attribute {
                kind: AttributeKind::Room,
                of: asker.referring_expressions(*object).next()?.into(),
            };
            let sight = AnswerEvidence {
                seen: vec![*object],
                target: Some(*object),
                room: *room,
            };
            asker.compose(QuestionKind::Location, question, sight)
        })
        .collect()
}
