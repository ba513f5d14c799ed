//! "In which room is the guitar?"

use super::asker::{Asker, Sight};
use super::{AskedQuestion, QuestionKind};
use crate::form::{AttributeKind, Question};

pub(super) fn candidates(asker: &Asker<'_>) -> Vec<AskedQuestion> {
    let things = asker.things.iter();
    things
        .filter_map(|(object, room)| {
            let question = Question::Attribute {
                kind: AttributeKind::Room,
                of: asker.names(*object).next()?.into(),
            };
            let sight = Sight {
                seen: vec![*object],
                target: Some(*object),
                room: *room,
            };
            asker.ask(QuestionKind::Location, question, sight)
        })
        .collect()
}
