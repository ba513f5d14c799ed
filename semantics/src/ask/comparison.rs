//! "Is the sofa closer to the table than to the television?"

use super::question_generator::{AnswerEvidence, QuestionGenerator};
use super::{AskedQuestion, QuestionKind};
use crate::form::{Clause, Description, Question};
use crate::predicates;
use crate::scene::Term;
use dwell_scene::{ObjectId, RoomId};

/// The largest things of a room that are compared.
const MOST: usize = 6;
/// Least ratio of the distances between the middles of the things, of which nobody is in doubt.
const LEAST_RATIO: f32 = 1.5;

pub(super) fn candidates(asker: &QuestionGenerator<'_>) -> Vec<AskedQuestion> {
    let mut found = Vec::new();
    for room in asker.scene.house().rooms.ids() {
        let things = largest_things(asker, room);
        for first in &things {
            for near in &things {
                for far in &things {
                    found.extend(ask(asker, [first, near, far], room));
                }
            }
        }
    }
    found
}

/// The largest things of a room that have a name.
fn largest_things(asker: &QuestionGenerator<'_>, room: RoomId) -> Vec<(ObjectId, Description)> {
    let own = asker.things.iter().filter(|(_, own)| *own == room);
    let volume = |object: ObjectId| asker.scene.extent(object).bounds.volume();
    let mut own: Vec<ObjectId> = own.map(|(object, _)| *object).collect();
    own.sort_by(|p, q| volume(*q).total_cmp(&volume(*p)));
    let named = own
        .into_iter()
        .filter_map(|object| Some((object, asker.referring_expressions(object).next()?)));
    named.take(MOST).collect()
}

/// Asked both ways round, with "yes" and "no" as answers.
fn ask(
    asker: &QuestionGenerator<'_>,
    things: [&(ObjectId, Description); 3],
    room: RoomId,
) -> Option<AskedQuestion> {
    let [first, second, third] = things.map(|(object, _)| *object);
    if first == second || first == third || second == third {
        return None;
    }
    let middle = |object: ObjectId| asker.scene.extent(object).bounds.center();
    let [to_second_m, to_third_m] =
        [second, third].map(|other| middle(first).distance(middle(other)));
    let nearer_m = to_second_m.min(to_third_m);
    if to_second_m.max(to_third_m) < LEAST_RATIO * nearer_m {
        return None;
    }
    let closer = predicates::find("closer_to").ok()?;
    let is_closer = |near: ObjectId, far: ObjectId| {
        let terms = [first, near, far].map(Term::Object);
        closer.holds(asker.scene, &terms, None).is_true()
    };
    // By the outlines as by the middles.
    let agrees = if to_second_m < to_third_m {
        is_closer(second, third)
    } else {
        is_closer(third, second)
    };
    if !agrees {
        return None;
    }
    let arguments = things.map(|(_, name)| name.clone().into()).to_vec();
    let question = Question::Whether(Clause::Holds {
        predicate: "closer_to".to_owned(),
        arguments,
    });
    let sight = AnswerEvidence {
        seen: vec![first, second, third],
        target: None,
        room,
    };
    asker.compose(QuestionKind::Comparison, question, sight)
}
