//! Forms and text: saying and reading by one grammar.
//!
//! What is said by a [`Language`] is read back by it as the same form, the first of its readings; `docs/words.md` shows the
//! grammar.

mod from_tree;
mod lexicon;
mod read;
mod say;
mod to_tree;

pub use read::{MAX_TEXT_BYTES, MAX_WORDS, Reading, UnknownWord, Unread};
pub use say::{PhraseSpan, Said};

use crate::grammar::{Grammar, GrammarError};
use std::sync::LazyLock;

/// A grammar whose functions are those of forms.
#[derive(Clone, Debug)]
pub struct Language {
    grammar: Grammar,
}

impl Language {
    /// A language of the rules in `grammar` (TOML) and the words in `lexicon` (TOML), with the nouns of the tables that ship with
    /// the engine.
    ///
    /// # Errors
    /// [`GrammarError`] names the rule and what is wrong in it.
    pub fn new(grammar: &str, lexicon: &str) -> Result<Self, GrammarError> {
        let lexicon = lexicon::english(lexicon)?;
        Ok(Self {
            grammar: Grammar::new(grammar, lexicon)?,
        })
    }

    /// A language of a grammar whose functions are those of `assets/language/en/grammar.toml`; of those it lacks nothing is said
    /// or read.
    pub fn of(grammar: Grammar) -> Self {
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

    /// The same language with more nouns, each for one and for several.
    #[must_use]
    pub fn with_nouns<'a>(&self, nouns: impl IntoIterator<Item = (&'a str, &'a str)>) -> Self {
        let mut lexicon = self.grammar.lexicon().clone();
        for (one, several) in nouns {
            lexicon::add_noun(&mut lexicon, one, several);
        }
        Self {
            grammar: self.grammar.with_lexicon(lexicon),
        }
    }

    /// The same language with more nouns of rooms, each with the word that says where one is: "in" or "on".
    #[must_use]
    pub fn with_rooms<'a>(&self, rooms: impl IntoIterator<Item = (&'a str, &'a str)>) -> Self {
        let mut lexicon = self.grammar.lexicon().clone();
        for (noun, preposition) in rooms {
            lexicon::add_room(&mut lexicon, noun, preposition);
        }
        Self {
            grammar: self.grammar.with_lexicon(lexicon),
        }
    }

    /// The rules and words.
    pub fn grammar(&self) -> &Grammar {
        &self.grammar
    }
}
