//! The closed list of answers, and the answers of the checker as words of it.

use crate::category::categories;
use crate::check::QuestionAnswer;
use crate::color::ColorVocabulary;
use crate::form::Noun;
use crate::instruct::is_search_target;
use crate::room_kind::room_kinds;
use crate::scene::{SemanticScene, Term};
use crate::truth::Truth;
use std::sync::LazyLock;

/// The largest number that is an answer.
const LARGEST: usize = 10;

/// Every answer, in the order of their numbers: yes, no, the numbers from 0 to 10, the plain colour words, kinds of rooms, kinds of
/// things. The same in all houses.
pub fn answers() -> &'static [String] {
    static ANSWERS: LazyLock<Vec<String>> = LazyLock::new(|| {
        let colors = ColorVocabulary::Plain.words().into_iter();
        let named = |name: &str| name != Noun::ANY_ROOM;
        let rooms = room_kinds().rows().iter();
        let rooms = rooms
            .filter(|row| named(row.name))
            .map(|row| row.singular.to_owned());
        let things = categories()
            .rows()
            .iter()
            .filter(|row| is_search_target(row));
        let all = ["yes", "no"]
            .map(str::to_owned)
            .into_iter()
            .chain((0..=LARGEST).map(|number| number.to_string()))
            .chain(colors.map(str::to_owned))
            .chain(rooms)
            .chain(things.map(|row| row.singular.to_owned()));
        let mut once: Vec<String> = Vec::new();
        for word in all {
            if !once.contains(&word) {
                once.push(word);
            }
        }
        once
    });
    &ANSWERS
}

/// The number of an answer in [`answers`].
pub fn answer_index(word: &str) -> Option<usize> {
    answers().iter().position(|answer| answer == word)
}

/// An answer of the checker as one of [`answers`]; `None` where it is undecided, has several words, or other ones.
pub(super) fn answer_word(
    scene: &SemanticScene<'_>,
    answer: &QuestionAnswer,
) -> Option<&'static str> {
    match answer {
        QuestionAnswer::Truth(verdict) => match verdict.truth {
            Truth::True => listed("yes"),
            Truth::False => listed("no"),
            Truth::Undecided(_) => None,
        },
        QuestionAnswer::Number(number) => listed(&number.to_string()),
        QuestionAnswer::Words(words) => match &words[..] {
            [word] => listed(word),
            _ => None,
        },
        QuestionAnswer::Things(things) => {
            let (first, others) = things.split_first()?;
            let word = noun(scene, *first)?;
            let alike = others.iter().all(|other| noun(scene, *other) == Some(word));
            alike.then_some(word)
        }
        QuestionAnswer::Alternatives(_) | QuestionAnswer::None(_) => None,
    }
}

fn listed(word: &str) -> Option<&'static str> {
    Some(answers().get(answer_index(word)?)?.as_str())
}

/// What a thing or room is called, where that is the noun of its kind.
pub(super) fn noun(scene: &SemanticScene<'_>, term: Term) -> Option<&'static str> {
    match term {
        Term::Object(object) => {
            let facts = scene.facts(object);
            let row = facts.category.filter(|row| is_search_target(row))?;
            (facts.noun == row.singular).then_some(())?;
            listed(row.singular)
        }
        Term::Room(room) => {
            let facts = scene.semantics.room(room);
            let kind = facts.kind.filter(|kind| kind.name != Noun::ANY_ROOM)?;
            listed(kind.singular)
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_answer_is_listed_once_and_found_by_its_word() {
        let unique: BTreeSet<&String> = answers().iter().collect();
        assert_eq!(unique.len(), answers().len());
        for (number, word) in answers().iter().enumerate() {
            assert_eq!(answer_index(word), Some(number));
        }
        // The first ones never change their numbers.
        let first = [
            "yes", "no", "0", "1", "2", "3", "4", "5", "6", "7", "8", "9", "10", "black",
        ];
        assert_eq!(answers()[..first.len()], first);
        for word in ["kitchen", "living room", "chair", "coffee table", "beige"] {
            assert!(answer_index(word).is_some(), "{word}");
        }
        assert_eq!(answer_index("wall"), None);
    }
}
