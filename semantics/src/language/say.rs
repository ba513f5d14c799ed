//! Forms to text.

use super::Language;
use super::from_tree;
use super::to_tree::TreeBuilder;
use crate::form::{Form, Phrase};
use crate::grammar::Tree;
use dwell_scene::random::RandomKey;

/// A noun phrase of a form in its text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PhraseSpan {
    /// What it means.
    pub phrase: Phrase,
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

fn at<'a>(tree: &'a Tree, path: &[usize]) -> Option<&'a Tree> {
    path.iter().try_fold(tree, |tree, step| match tree {
        Tree::Apply { arguments, .. } => arguments.get(*step),
        Tree::Entry { .. } | Tree::Number { .. } => None,
    })
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
        let phrases = spans.iter().filter_map(|span| {
            Some(PhraseSpan {
                phrase: from_tree::noun_phrase(at(&tree, &span.path)?)?,
                start: span.start,
                end: span.end,
            })
        });
        let mut phrases: Vec<PhraseSpan> = phrases.collect();
        phrases.sort_by_key(|span| (span.start, usize::MAX - span.end));
        Some(Said { text, phrases })
    }
}
