//! Errors of grammars.

/// A fault of a grammar or a lexicon.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum GrammarError {
    /// A file that is not TOML of this schema.
    #[error("{0}")]
    Syntax(String),
    /// A template that cannot be read.
    #[error("template {template:?}: {why}")]
    Template {
        /// The template.
        template: String,
        /// The fault.
        why: &'static str,
    },
    /// A name that nothing defines.
    #[error("rule {rule:?}: no {kind} {name:?}; there are {known:?}")]
    Unknown {
        /// The function of the rule.
        rule: String,
        /// Category, variant or word.
        kind: &'static str,
        /// The name.
        name: String,
        /// The names that are defined.
        known: Vec<String>,
    },
    /// A wording that leaves out an argument.
    #[error("rule {rule:?}: {template:?} leaves out argument {argument}")]
    LeftOut {
        /// The function of the rule.
        rule: String,
        /// The template.
        template: String,
        /// The argument, counted from 1.
        argument: usize,
    },
    /// Two rules of one function that differ in their arguments or in the category of their result.
    #[error("rule {rule:?} stands twice with other arguments or another result")]
    Signature {
        /// The function.
        rule: String,
    },
    /// Rules that lead from a category to itself without a word between.
    #[error("category {category:?} leads to itself without a word")]
    Circle {
        /// The category.
        category: String,
    },
}
