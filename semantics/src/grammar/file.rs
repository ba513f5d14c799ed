//! The file format of grammars.

use super::GrammarError;
use serde::Deserialize;
use std::collections::BTreeMap;

/// `grammar.toml`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct GrammarFile {
    /// The categories of whole texts.
    pub(super) start: Vec<String>,
    /// The variants of categories and of lexicon classes; those not named have one.
    #[serde(default)]
    pub(super) variants: BTreeMap<String, Vec<String>>,
    /// Lexicon classes of whose entries any form may be said; of others the first is.
    #[serde(default)]
    pub(super) drawn: Vec<String>,
    /// Phrases with others that mean the same, for texts that are not understood as they stand; the other may be empty.
    #[serde(default)]
    pub(super) paraphrases: Vec<[String; 2]>,
    /// Endings of words that are words of their own, with these: "n't" is "not". Without one they say nothing: "cream-coloured".
    #[serde(default)]
    pub(super) endings: Vec<[String; 2]>,
    /// Words that agree with an argument, by name: their forms by variant.
    #[serde(default)]
    pub(super) words: BTreeMap<String, BTreeMap<String, String>>,
    /// The rules.
    pub(super) rule: Vec<RuleFile>,
}

/// A function of the abstract syntax with its wordings.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RuleFile {
    /// The function's name.
    pub(super) function: String,
    /// The category of its result, with a variant: `cn.n`.
    pub(super) result: String,
    /// The categories or classes of its arguments.
    #[serde(default)]
    pub(super) arguments: Vec<String>,
    /// Wordings that are said and read.
    #[serde(default)]
    pub(super) texts: Vec<String>,
    /// Wordings that are only read.
    #[serde(default)]
    pub(super) reads: Vec<String>,
    /// Readings of less cost are preferred.
    #[serde(default)]
    pub(super) cost: u32,
}

impl GrammarFile {
    /// Reads TOML.
    ///
    /// # Errors
    /// [`GrammarError::Syntax`] with its line.
    pub(super) fn read(text: &str) -> Result<Self, GrammarError> {
        toml::from_str(text).map_err(|error| GrammarError::Syntax(error.to_string()))
    }
}
