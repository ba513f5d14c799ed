//! Forms to text.

use super::Language;
use super::from_tree;
use super::to_tree::TreeBuilder;
use crate::form::{Form, Phrase};
use crate::grammar::Tree;
use dwell_scene::random::RandomKey;

/// The place of a noun phrase in the text of a form.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PhraseSpan {
    /// The phrase.
    pub phrase: Phrase,
    /// The first byte.
    pub start: usize,
    /// The byte after the last.
    pub end: usize,
}

/// The text of a form.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sentence {
    /// One sentence, with capital letter and final punctuation mark.
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
    /// Returns the text of `form`; `None` if the grammar has no wording for it: an unknown noun, a modifier where none is allowed.
    /// Without a key every rule uses its first wording; with one, wordings are drawn.
    ///
    /// # Determinism
    /// Equal forms and keys give equal texts.
    pub fn say(&self, form: &Form, key: Option<RandomKey>) -> Option<Sentence> {
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
        Some(Sentence { text, phrases })
    }
}
