//! Clauses: forms that are true or false of a scene.

use super::phrase::Phrase;
use crate::size::SizeClass;
use serde::{Deserialize, Serialize};

/// A quality that "is" ascribes to a thing.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quality {
    /// A plain colour word.
    Color(String),
    /// The adjective of a substance.
    Material(String),
    /// Its size for its kind.
    Size(SizeClass),
    /// A state by its predicate: `"open"`, `"switched_off"`.
    State(String),
}

/// A clause: true, false or undecided of a scene.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Clause {
    /// A predicate applied to arguments: "the cup is on the table".
    Holds {
        /// The predicate's name.
        predicate: String,
        /// Its arguments.
        arguments: Vec<Phrase>,
    },
    /// A thing has a quality: "the door is open".
    Is {
        /// The thing.
        subject: Phrase,
        /// The quality.
        quality: Quality,
    },
    /// The existence of things: "there are two chairs in the kitchen".
    Exists(Phrase),
    /// The negation of a clause.
    Not(Box<Clause>),
    /// The conjunction of clauses.
    All(Vec<Clause>),
    /// The disjunction of clauses.
    Any(Vec<Clause>),
}
