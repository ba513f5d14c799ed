//! Forms to text.

use super::Language;
use super::from_tree;
use super::to_tree::{TreeBuilder, count};
use crate::form::{Description, Form, Noun, Phrase};
use crate::grammar::{Span, Tree, WordingChooser};
use dwell_scene::interrupt;
use dwell_scene::random::RandomKey;
use serde::{Deserialize, Serialize};

/// Most functions, words and numbers of a tree that is said. Its phrases lie in each other: finding their places takes n² steps.
const MAX_NODES: usize = 8192;

/// The place of a noun phrase in the text of a form.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
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

impl Language {
    /// Returns the question which of the things that `named` describes is meant by `kind`: "Which chair do you mean, the red chair or
    /// the chair next to the bed?" `None` where the grammar has no wording for it.
    pub fn ask_which(&self, kind: &Description, named: &[Phrase]) -> Option<String> {
        let builder = self.builder();
        let tree = Tree::apply(
            "which_meant",
            [
                builder.noun_with_adjectives(kind)?,
                builder.disjunction(named)?,
            ],
        );
        Some(self.grammar.linearize(&tree, &mut |_| 0)?.0)
    }

    /// Returns the question which of `number` things is meant by `kind`: "Which of the five chairs do you mean?"
    pub fn ask_which_of(&self, kind: &Description, number: usize) -> Option<String> {
        let builder = self.builder();
        let number = count(u32::try_from(number).ok()?);
        let noun = builder.noun_of(kind)?;
        let (counted, uncounted) = match kind.noun {
            Noun::Room(_) => ("which_room_of_meant", "which_room_meant"),
            _ => ("which_of_meant", "which_of_many_meant"),
        };
        let said = |tree: Tree| self.grammar.linearize(&tree, &mut |_| 0);
        // Larger numbers have no words.
        let (text, _) = said(Tree::apply(counted, [number, noun.clone()]))
            .or_else(|| said(Tree::apply(uncounted, [noun])))?;
        Some(text)
    }

    fn builder(&self) -> TreeBuilder<'_> {
        TreeBuilder {
            lexicon: self.grammar.lexicon(),
        }
    }

    /// Returns the text of `form`; `None` if the grammar has no wording for it: an unknown noun, a modifier where none is allowed, more
    /// than some 1000 modifiers.
    /// Without a key every rule uses its first wording; with one, wordings are drawn.
    ///
    /// # Determinism
    /// Equal forms and keys give equal texts.
    pub fn say(&self, form: &Form, key: Option<RandomKey>) -> Option<Sentence> {
        let mut stream = key.map(|key| key.child("wording").stream());
        self.say_choosing(form, &mut |count| {
            stream
                .as_mut()
                .map_or(0, |stream| (stream.bits() % count as u64) as usize)
        })
    }

    /// As [`Self::say`], with wordings that `choose` chooses.
    pub(crate) fn say_choosing(&self, form: &Form, choose: WordingChooser<'_>) -> Option<Sentence> {
        let tree = self.builder().form(form)?;
        if is_too_large(&tree) {
            return None;
        }
        let (mut text, spans) = self.grammar.linearize(&tree, choose)?;
        if matches!(form, Form::NounPhrase(_))
            && let Some(first) = text.get_mut(..1)
        {
            first.make_ascii_lowercase();
        }
        let known = from_tree::noun_phrases(&tree);
        let mut phrases: Vec<PhraseSpan> = Vec::new();
        let mut sorted: Vec<&Span> = spans.iter().collect();
        sorted.sort_by_key(|span| (span.start, usize::MAX - span.end, span.path.len()));
        for Span { path, start, end } in sorted {
            interrupt::unwind_if_cancelled();
            // A noun phrase that another wraps without adding a word is one phrase, the outer one.
            let same = phrases.last();
            if same.is_some_and(|last| (last.start, last.end) == (*start, *end)) {
                continue;
            }
            phrases.extend(known.get(path).map(|phrase| PhraseSpan {
                phrase: phrase.clone(),
                start: *start,
                end: *end,
            }));
        }
        Some(Sentence { text, phrases })
    }
}

/// Returns whether a tree has more than [`MAX_NODES`].
fn is_too_large(tree: &Tree) -> bool {
    let mut open = vec![tree];
    let mut count = 0;
    while let Some(tree) = open.pop() {
        count += 1;
        if count > MAX_NODES {
            return true;
        }
        if let Tree::Apply { arguments, .. } = tree {
            open.extend(arguments);
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::form::Clause;

    #[test]
    fn forms_of_thousands_of_modifiers_are_not_said() {
        let language = Language::english();
        let read = language
            .read("There is a red bed next to a table.")
            .unwrap();
        let with_modifiers = |count: usize| {
            let Form::Claim(Clause::Exists(Phrase::Described(mut bed))) = read.forms[0].clone()
            else {
                panic!("{:?}", read.forms[0])
            };
            let one = bed.modifiers[0].clone();
            bed.modifiers = vec![one; count];
            Form::Claim(Clause::Exists(Phrase::Described(bed)))
        };
        assert!(language.say(&with_modifiers(100), None).is_some());
        assert_eq!(language.say(&with_modifiers(3_000), None), None);
    }
}
