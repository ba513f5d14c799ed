//! Requests: steps for an agent to carry out.

use super::clause::Clause;
use super::phrase::Phrase;
use serde::{Deserialize, Serialize};

/// A step of a request.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RequestStep {
    /// Go to a room.
    GoTo(Phrase),
    /// Act on a thing, by a verb of the lexicon such as `"pick_up"`.
    Do {
        /// The verb.
        verb: String,
        /// The thing.
        object: Phrase,
    },
    /// Refrain from acting on a thing.
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
        /// The destination.
        to: Phrase,
    },
    /// A step to carry out if a clause is true when its turn comes, and possibly another one if not.
    If {
        /// The condition.
        condition: Clause,
        /// The step if it is true.
        then: Box<RequestStep>,
        /// The step if it is not.
        otherwise: Option<Box<RequestStep>>,
    },
}
