//! "What color is the sofa?", "What color is the chair in the kitchen?"

use super::asker::{Asker, Sight};
use super::{AskedQuestion, QuestionKind};
use crate::form::{AttributeKind, Description, Modifier, Question};
use crate::refer::by_properties;
use crate::scene::Term;
use dwell_scene::{ObjectId, RoomId};

fn ask(
    asker: &Asker<'_>,
    kind: QuestionKind,
    name: Description,
    (object, room): (ObjectId, RoomId),
) -> Option<AskedQuestion> {
    let question = Question::Attribute {
        kind: AttributeKind::Color,
        of: name.into(),
    };
    let sight = Sight {
        seen: vec![object],
        target: Some(object),
        room,
    };
    asker.ask(kind, question, sight)
}

fn colorless(asker: &Asker<'_>, object: ObjectId) -> Option<Description> {
    asker.names(object).find(|name| name.colors.is_empty())
}

pub(super) fn candidates(asker: &Asker<'_>) -> Vec<AskedQuestion> {
    let things = asker.things.iter();
    things
        .filter_map(|thing| {
            let name = colorless(asker, thing.0)?;
            ask(asker, QuestionKind::Color, name, *thing)
        })
        .collect()
}

/// Of things that only their room tells apart.
pub(super) fn candidates_in_rooms(asker: &Asker<'_>) -> Vec<AskedQuestion> {
    let things = asker.things.iter();
    things
        .filter_map(|thing| {
            let (object, room) = *thing;
            let place = asker.room_name(room)?;
            if colorless(asker, object).is_some() {
                return None;
            }
            let names = by_properties(asker.scene, object).into_iter();
            let names = names.filter(|name| name.colors.is_empty());
            let mut there = names
                .map(|name| name.with_modifier(Modifier::new("in_room", [place.clone().into()])));
            let name = there.find(|name| asker.means(name, Term::Object(object)))?;
            ask(asker, QuestionKind::ColorRoom, name, *thing)
        })
        .collect()
}
