//! Requests: steps for an agent to carry out.

use super::clause::Clause;
use super::phrase::Phrase;
use serde::{Deserialize, Serialize};

/// A direction to turn to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TurnDirection {
    /// A quarter turn to the left.
    Left,
    /// A quarter turn to the right.
    Right,
    /// Half a turn.
    Around,
}

/// A step of a request.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RequestStep {
    /// Go to a room.
    GoTo(Phrase),
    /// Go out of a room.
    Leave(Phrase),
    /// Turn on the spot.
    Turn(TurnDirection),
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
    /// Make a relation true of a thing, or of the listener: "put the cup on the table", "stand next to the table".
    Put {
        /// The thing.
        object: Phrase,
        /// The predicate's name.
        predicate: String,
        /// Its second argument; of "between" a list of both landmarks.
        to: Phrase,
    },
    /// Carry a thing to a thing or room.
    Bring {
        /// The thing.
        object: Phrase,
        /// The destination.
        to: Phrase,
    },
    /// Steps to carry out if a clause is true when their turn comes, and others if it is not.
    If {
        /// The condition.
        condition: Clause,
        /// The steps if it is true; at least one.
        then: Vec<RequestStep>,
        /// The steps if it is not.
        otherwise: Vec<RequestStep>,
    },
}
