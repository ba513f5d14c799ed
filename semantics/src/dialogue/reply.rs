//! An oracle's replies in words.

use crate::check::QuestionAnswer;
use crate::english;
use crate::form::Form;
use crate::refer::room_phrase;
use crate::scene::{SemanticScene, Term};
use crate::truth::Truth;
use crate::vocabulary;
use std::collections::BTreeSet;

/// Most things that a reply names.
const MOST_NAMED: usize = 3;

/// What an oracle says to a question. All its fixed words are words of `assets/vocabulary.txt`.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Reply {
    /// The words.
    pub text: String,
    /// Whether the question was understood.
    pub understood: bool,
}

impl Reply {
    fn said(text: &str) -> Self {
        Self {
            text: text.to_owned(),
            understood: true,
        }
    }

    /// The reply to a question without a decided answer.
    pub fn undecided() -> Self {
        Self::said("I do not know.")
    }

    /// The reply to what is no question of the grammar.
    pub fn not_understood() -> Self {
        Self {
            understood: false,
            ..Self::said("What do you mean?")
        }
    }

    /// The words of an answer.
    pub(super) fn of(scene: &SemanticScene<'_>, answer: &QuestionAnswer) -> Self {
        match answer {
            QuestionAnswer::Truth(verdict) => match verdict.truth {
                Truth::True => Self::said("That is true."),
                Truth::False => Self::said("That is not true."),
                Truth::Undecided(_) => Self::undecided(),
            },
            QuestionAnswer::Things(things) => Self::naming(scene, things),
            QuestionAnswer::Number(0) => Self::said("None."),
            QuestionAnswer::Number(number @ 1..=12) => Self::sentence(&english::cardinal(*number)),
            QuestionAnswer::Number(_) => Self::said("Many."),
            QuestionAnswer::Words(words) => Self::sentence(&english::list(words)),
            QuestionAnswer::Alternatives(fits) => match fits[..] {
                [] => Self::said("Neither."),
                [one] => Self::sentence(&format!("the {}", english::ordinal(one + 1))),
                [_, _] => Self::said("Both."),
                _ => Self::said("All."),
            },
            QuestionAnswer::None(_) => Self::undecided(),
        }
    }

    fn sentence(words: &str) -> Self {
        Self::said(&format!("{}.", english::capitalized(words)))
    }

    /// The kinds of some things, each once.
    fn naming(scene: &SemanticScene<'_>, things: &[Term]) -> Self {
        let names: BTreeSet<String> = things
            .iter()
            .filter_map(|term| name(scene, *term))
            .collect();
        let mut names: Vec<String> = names.into_iter().collect();
        names.truncate(MOST_NAMED);
        match (&names[..], things) {
            ([], []) => Self::said("Nothing."),
            ([], _) => Self::undecided(),
            (names, _) => Self::sentence(&english::list(names)),
        }
    }

    /// The words as numbers of the vocabulary, without those that it lacks (names that a house's own file gives), padded with 0.
    /// Shape (`length`,).
    pub fn tokens(&self, length: usize) -> Vec<i32> {
        let words = vocabulary::words(&self.text).into_iter();
        let known = words.filter_map(|word| Some(vocabulary::tokenize(&word).ok()?[0]));
        let mut tokens: Vec<i32> = known.take(length).collect();
        tokens.resize(length, vocabulary::PAD);
        tokens
    }
}

/// "A table", "the second bedroom".
fn name(scene: &SemanticScene<'_>, term: Term) -> Option<String> {
    match term {
        Term::Object(object) => Some(english::with_article(&scene.facts(object).noun)),
        Term::Room(room) => {
            let form = Form::NounPhrase(room_phrase(scene, room));
            let said = scene.semantics.language().say(&form, None)?;
            Some(said.text.trim_end_matches('.').to_owned())
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::CheckResult;
    use crate::truth::UndecidedReason;
    use std::collections::BTreeSet;

    /// Every reply without names is in words of the vocabulary, and no two answers that differ are one reply.
    #[test]
    fn fixed_replies_differ_and_have_words_of_the_vocabulary() {
        let materials = dwell_scene::ShoeboxMaterials::default();
        let house = dwell_scene::House::shoebox([4.0, 2.5, 3.0], &materials).unwrap();
        let house = std::sync::Arc::new(house);
        let semantics = crate::Semantics::new(&house);
        let state = dwell_scene::State::new(&house);
        let scene = semantics.scene(&state);
        let truth = |truth| {
            QuestionAnswer::Truth(CheckResult {
                truth,
                witnesses: Vec::new(),
            })
        };
        let mut answers = vec![
            truth(Truth::True),
            truth(Truth::False),
            truth(Truth::Undecided(UndecidedReason::NoColor)),
            QuestionAnswer::Things(Vec::new()),
            QuestionAnswer::Alternatives(Vec::new()),
            QuestionAnswer::Alternatives(vec![0]),
            QuestionAnswer::Alternatives(vec![1]),
            QuestionAnswer::Alternatives(vec![0, 1]),
            QuestionAnswer::Alternatives(vec![0, 1, 2]),
            QuestionAnswer::Words(vec!["red".to_owned(), "white".to_owned()]),
        ];
        answers.extend((0..=13).map(QuestionAnswer::Number));
        let mut replies: Vec<Reply> = answers.iter().map(|own| Reply::of(&scene, own)).collect();
        replies.push(Reply::not_understood());
        let texts: BTreeSet<&str> = replies.iter().map(|reply| reply.text.as_str()).collect();
        assert_eq!(texts.len(), replies.len());
        for Reply { text, .. } in &replies {
            assert!(vocabulary::tokenize(text).is_ok(), "{text}");
        }
        assert_eq!(replies[9].text, "Red and white.");
        let tokens = Reply::said("The zyx table.").tokens(5);
        assert_eq!(vocabulary::detokenize(&tokens), "the table .");
        assert_eq!(tokens[3..], [0, 0]);
    }
}
