//! Questions: clauses with an open argument, counts and attributes.

use super::clause::Clause;
use super::phrase::{Description, Phrase};
use serde::{Deserialize, Serialize};

/// An attribute that a question asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AttributeKind {
    /// Its colour words.
    Color,
    /// The adjective of its main substance.
    Material,
    /// The things that it is in, else on, else hangs on, else is next to.
    Place,
    /// The room it is in.
    Room,
}

/// A question.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Question {
    /// A yes-no question: is the clause true? Answered by a truth value.
    Whether(Clause),
    /// A question for those of several clauses that are true: "is the cup on the table or in the sink?" Answered by their numbers.
    Alternatives(Vec<Clause>),
    /// A question for things that make the clause true in place of [`Phrase::Hole`]. Answered by ids.
    Which {
        /// A description of the candidates, whose quantifier is ignored; `None` for "what".
        kind: Option<Box<Description>>,
        /// The clause.
        clause: Clause,
    },
    /// A count of the things that fit a description. Answered by a number.
    HowMany(Box<Description>),
    /// The distance of two things. Answered by a number, in whole metres and at least 1, as in [`Clause::Distance`].
    HowFar {
        /// The thing.
        subject: Phrase,
        /// The other thing, or the listener.
        from: Phrase,
    },
    /// An attribute of one thing. Answered by words.
    Attribute {
        /// The attribute.
        kind: AttributeKind,
        /// The thing.
        of: Phrase,
    },
}
