//! "What color is the sofa?", "What color is the chair in the kitchen?"

use super::question_generator::{AnswerEvidence, QuestionGenerator};
use super::{AskedQuestion, QuestionKind};
use crate::form::{AttributeKind, Description, Modifier, Question};
use crate::refer::property_descriptions;
use crate::scene::Term;
use dwell_scene::{ObjectId, RoomId};

fn ask(
    asker: &QuestionGenerator<'_>,
    kind: QuestionKind,
    name: Description,
    (object, room): (ObjectId, RoomId),
) -> Option<AskedQuestion> {
    let question = Question::Attribute {
        kind: AttributeKind::Color,
        of: name.into(),
    };
    let sight = AnswerEvidence {
        seen: vec![object],
        target: Some(object),
        room,
    };
    asker.compose(kind, question, sight)
}

fn colorless(asker: &QuestionGenerator<'_>, object: ObjectId) -> Option<Description> {
    asker
        .referring_expressions(object)
        .find(|name| name.colors.is_empty())
}

pub(super) fn candidates(asker: &QuestionGenerator<'_>) -> Vec<AskedQuestion> {
    let things = asker.things.iter();
    things
        .filter_map(|thing| {
            let name = colorless(asker, thing.0)?;
            ask(asker, QuestionKind::Color, name, *thing)
        })
        .collect()
}

/// Of things that only their room tells apart.
pub(super) fn candidates_in_rooms(asker: &QuestionGenerator<'_>) -> Vec<AskedQuestion> {
    let things = asker.things.iter();
    things
        .filter_map(|thing| {
            let (object, room) = *thing;
            let place = asker.room_description(room)?;
            if colorless(asker, object).is_some() {
                return None;
            }
            let names = property_descriptions(asker.scene, object).into_iter();
            let names = names.filter(|name| name.colors.is_empty());
            let mut there = names
                .map(|name| name.with_modifier(Modifier::new("in_room", [place.clone().into()])));
            let name = there.find(|name| asker.refers_uniquely_to(name, Term::Object(object)))?;
            ask(asker, QuestionKind::ColorRoom, name, *thing)
        })
        .collect()
}
