//! Forms to text and text to forms, by one grammar.
//!
//! A text that a [`Language`] makes of a form reads back as that form, the preferred one of its readings; `docs/words.md` describes
//! the grammar.

mod alternatives;
mod converse;
mod distances;
mod existence;
mod from_tree;
mod lexicon;
mod numbers;
mod other_clauses;
mod own_doors;
mod phrases;
mod places;
mod plurals;
mod questions;
mod questions_to_tree;
mod read;
mod requests;
mod rooms;
mod say;
mod sentences;
mod sets;
mod step_groups;
mod to_tree;
mod verb_phrases;

pub(crate) use read::sentence_places;
pub use read::{
    MAX_TEXT_BYTES, MAX_WORDS, ParseError, Readings, SentenceError, SentenceReadings, UnknownWord,
};
pub use say::{PhraseSpan, Sentence};

use crate::grammar::{Grammar, GrammarError};
use std::sync::LazyLock;

/// A natural language: a grammar with a function for each kind of form.
#[derive(Clone, Debug)]
pub struct Language {
    grammar: Grammar,
}

impl Language {
    /// Returns the relation that b has to a where a has `relation` to b, as sentences with "with a lamp above it" are read; `None`
    /// where there is none.
    pub fn converse_of(relation: &str) -> Option<&'static str> {
        converse::converse_of(relation)
    }

    /// Builds a language from the rules in `grammar` (TOML) and the words in `lexicon` (TOML), with the nouns of the tables that
    /// ship with the engine.
    ///
    /// # Errors
    /// [`GrammarError`] names the rule and what is wrong in it.
    pub fn new(grammar: &str, lexicon: &str) -> Result<Self, GrammarError> {
        let lexicon = lexicon::english(lexicon)?;
        Ok(Self {
            grammar: Grammar::new(grammar, lexicon)?,
        })
    }

    /// Builds a language from a grammar with functions of `assets/language/en/grammar.toml`; forms that need a function it lacks
    /// are neither said nor read.
    pub fn from_grammar(grammar: Grammar) -> Self {
        Self { grammar }
    }

    /// English as it ships with the engine.
    pub fn english() -> &'static Self {
        static ENGLISH: LazyLock<Language> = LazyLock::new(|| {
            Language::new(
                include_str!("../../../assets/language/en/grammar.toml"),
                include_str!("../../../assets/language/en/lexicon.toml"),
            )
            .expect("assets/language/en is checked by this crate's tests")
        });
        &ENGLISH
    }

    /// Returns the same language with more nouns of things, each in singular and plural, and of rooms, each in singular and plural
    /// with its preposition, "in" or "on".
    #[must_use]
    pub fn with_nouns<'a>(
        &self,
        things: impl IntoIterator<Item = (&'a str, &'a str)>,
        rooms: impl IntoIterator<Item = (&'a str, &'a str, &'a str)>,
    ) -> Self {
        let mut lexicon = self.grammar.lexicon().clone();
        for (one, several) in things {
            lexicon::add_noun(&mut lexicon, one, several);
        }
        for (noun, several, preposition) in rooms {
            lexicon::add_room(&mut lexicon, noun, several, preposition);
        }
        Self {
            grammar: self.grammar.with_lexicon(lexicon),
        }
    }

    /// The grammar, with its lexicon.
    pub fn grammar(&self) -> &Grammar {
        &self.grammar
    }
}
