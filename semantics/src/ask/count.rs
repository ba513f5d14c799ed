//! "How many chairs in the kitchen are there?"

use super::asker::{Asker, Sight};
use super::{AskedQuestion, QuestionKind};
use crate::form::Question;
use dwell_scene::interrupt;

/// The most things that are to be counted.
const MOST: usize = 5;

/// Of every kind of thing that the house has somewhere, and every room that has a name; 0 to 5.
pub(super) fn candidates(asker: &Asker<'_>) -> Vec<AskedQuestion> {
    let (nouns, mut found) = (asker.nouns(), Vec::new());
    for (room, name) in asker.named_rooms() {
        for noun in &nouns {
            interrupt::unwind_if_cancelled();
            let things = Asker::in_room(noun, &name);
            let seen = asker.fitting(&things);
            if seen.len() > MOST {
                continue;
            }
            let sight = Sight {
                seen,
                target: None,
                room,
            };
            let question = Question::HowMany(Box::new(things));
            found.extend(asker.ask(QuestionKind::Count, question, sight));
        }
    }
    found
}
