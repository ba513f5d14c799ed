//! Forms to text.

use super::Language;
use super::to_tree::TreeBuilder;
use crate::form::Form;
use crate::grammar::{Span, Tree};
use dwell_scene::random::RandomKey;

/// A noun phrase of a form in its text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PhraseSpan {
    /// The first byte.
    pub start: usize,
    /// The byte behind the last.
    pub end: usize,
}

/// A form in words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Said {
    /// One sentence, with its capital letter and its mark.
    pub text: String,
    /// The places of noun phrases, the outer before the inner, from left to right.
    pub phrases: Vec<PhraseSpan>,
}

/// The functions that make noun phrases of things.
const NOUN_PHRASES: [&str; 29] = [
    "the",
    "some",
    "every",
    "no",
    "exactly_one",
    "exactly",
    "at_least_one",
    "at_least",
    "nth",
    "superlative",
    "selected_to",
    "by_id",
    "you",
    "i_the",
    "i_some",
    "i_every",
    "i_exactly",
    "i_the_that",
    "i_some_that",
    "i_the_that_verb",
    "i_some_that_verb",
    "i_the_that_place",
    "i_some_that_place",
    "i_by_id",
    "i_you",
    "room_the",
    "room_a",
    "room_nth",
    "room_with",
];

fn at<'a>(tree: &'a Tree, path: &[usize]) -> Option<&'a Tree> {
    path.iter().try_fold(tree, |tree, step| match tree {
        Tree::Apply { arguments, .. } => arguments.get(*step),
        Tree::Entry { .. } | Tree::Number { .. } => None,
    })
}

fn is_noun_phrase(tree: &Tree, span: &Span) -> bool {
    let part = at(tree, &span.path);
    matches!(part, Some(Tree::Apply { function, .. }) if NOUN_PHRASES.contains(&function.as_str()))
}

impl Language {
    /// The text of `form`; `None` where the grammar has no words for it: an unknown noun, a modifier where none may stand.
    /// Without a key every rule has its first wording; with one wordings are drawn.
    ///
    /// # Determinism
    /// Equal forms and keys give equal texts.
    pub fn say(&self, form: &Form, key: Option<RandomKey>) -> Option<Said> {
        let builder = TreeBuilder {
            lexicon: self.grammar.lexicon(),
        };
        let tree = builder.form(form)?;
        let mut stream = key.map(|key| key.child("wording").stream());
        let mut choose = |count: usize| {
            stream
                .as_mut()
                .map_or(0, |stream| (stream.bits() % count as u64) as usize)
        };
        let (text, spans) = self.grammar.linearize(&tree, &mut choose)?;
        let mut phrases: Vec<PhraseSpan> = spans
            .iter()
            .filter(|span| is_noun_phrase(&tree, span))
            .map(|span| PhraseSpan {
                start: span.start,
                end: span.end,
            })
            .collect();
        phrases.sort_by_key(|span| (span.start, usize::MAX - span.end));
        Some(Said { text, phrases })
    }
}
