//! Questions: clauses in which something is left open.

use super::clause::Clause;
use super::phrase::{Description, Phrase};
use serde::{Deserialize, Serialize};

/// An attribute that is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AttributeKind {
    /// The plain colour words.
    Color,
    /// The adjective of what it is mostly made of.
    Material,
    /// What it is in or on, or next to.
    Place,
    /// The room it is in.
    Room,
}

/// What is asked.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Question {
    /// Is it true? Answered by a truth value.
    Whether(Clause),
    /// Which things, put in place of [`Phrase::Hole`], make the clause true? Answered by ids.
    Which {
        /// The kind of things, [`None`] for "what"; its quantifier says nothing.
        kind: Option<Box<Description>>,
        /// The clause.
        clause: Clause,
    },
    /// How many things fit? Answered by a number.
    HowMany(Box<Description>),
    /// An attribute of one thing. Answered by words.
    Attribute {
        /// The attribute.
        kind: AttributeKind,
        /// The thing.
        of: Phrase,
    },
}
