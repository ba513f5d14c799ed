//! A grammar as it stands in its file.

use super::GrammarError;
use serde::Deserialize;
use std::collections::BTreeMap;

/// `grammar.toml`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct GrammarFile {
    /// The categories of whole texts.
    pub(super) start: Vec<String>,
    /// The variants of categories and of classes of the lexicon; of others there is one.
    #[serde(default)]
    pub(super) variants: BTreeMap<String, Vec<String>>,
    /// Words that agree with others: forms by variant.
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
    /// The category that it makes: `cn.n`.
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
