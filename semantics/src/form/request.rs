//! Requests: what somebody is to do.

use super::clause::Clause;
use super::phrase::Phrase;
use serde::{Deserialize, Serialize};

/// One thing to do.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Step {
    /// Be in a room.
    GoTo(Phrase),
    /// Do something with a thing: a verb of the lexicon, such as `"pick_up"`.
    Do {
        /// The verb.
        verb: String,
        /// The thing.
        object: Phrase,
    },
    /// Do not do it.
    DoNot {
        /// The verb.
        verb: String,
        /// The thing.
        object: Phrase,
    },
    /// Make a relation true of a thing: "put the cup on the table".
    Put {
        /// The thing.
        object: Phrase,
        /// The predicate's name.
        predicate: String,
        /// Its second argument.
        to: Phrase,
    },
    /// Carry a thing to a thing or room.
    Bring {
        /// The thing.
        object: Phrase,
        /// Where to.
        to: Phrase,
    },
}

/// Steps in their order, with conditions.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Plan {
    /// One after the other.
    Sequence(Vec<Step>),
    /// A step if something is true when it is said.
    If(Clause, Step),
}
