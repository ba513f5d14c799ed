//! Questions: clauses with an open argument, counts and attributes.

use super::clause::Clause;
use super::phrase::{Description, Phrase};
use serde::{Deserialize, Serialize};

/// An attribute that a question asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AttributeKind {
    /// Its plain colour words.
    Color,
    /// The adjective of its main substance.
    Material,
    /// The things that it is in or on, else next to.
    Place,
    /// The room it is in.
    Room,
}

/// A question.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Question {
    /// Is it true? Answered by a truth value.
    Whether(Clause),
    /// Which things, put in place of [`Phrase::Hole`], make the clause true? Answered by ids.
    Which {
        /// A description of the candidates, whose quantifier is ignored; `None` for "what".
        kind: Option<Box<Description>>,
        /// The clause.
        clause: Clause,
    },
    /// The number of things that fit.
    HowMany(Box<Description>),
    /// An attribute of one thing. Answered by words.
    Attribute {
        /// The attribute.
        kind: AttributeKind,
        /// The thing.
        of: Phrase,
    },
}
