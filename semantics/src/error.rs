//! Errors of semantics.

/// A fault of this crate.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SemanticsError {
    /// A name that no predicate has.
    #[error("no predicate {name:?}; there are {known:?}")]
    UnknownPredicate {
        /// The requested name.
        name: String,
        /// The known names.
        known: Vec<&'static str>,
    },
    /// A name that no order has.
    #[error("no selection {name:?}; there are {known:?}")]
    UnknownSelection {
        /// The requested name.
        name: String,
        /// The known names.
        known: Vec<&'static str>,
    },
    /// A house in which nothing of the wanted kind can be asked for.
    #[error("house {house:?} offers no instruction of kind {kind}: {why}")]
    NoInstruction {
        /// The house's name.
        house: String,
        /// The wanted kind.
        kind: &'static str,
        /// The missing part.
        why: &'static str,
    },
    /// A word outside the vocabulary.
    #[error("{word:?} in {text:?} is not in vocabulary version {version}")]
    UnknownWord {
        /// The word.
        word: String,
        /// The whole text.
        text: String,
        /// The vocabulary's version.
        version: u32,
    },
    /// A text with more tokens than the fixed length.
    #[error("{text:?} has {found} tokens; allowed are {allowed}")]
    TooLong {
        /// The text.
        text: String,
        /// Its number of tokens.
        found: usize,
        /// The fixed length.
        allowed: usize,
    },
    /// A table file with a fault.
    #[error("{file} line {line}: {what}")]
    Table {
        /// The file.
        file: &'static str,
        /// Counted from 1, head included.
        line: usize,
        /// The found and the allowed value.
        what: String,
    },
}
