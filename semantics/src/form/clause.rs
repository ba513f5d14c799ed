//! Clauses: what is true or false.

use super::phrase::Phrase;
use crate::size::SizeClass;
use serde::{Deserialize, Serialize};

/// What "is" ascribes to a thing.
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

/// Something that is true or false of a scene.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Clause {
    /// A predicate of its arguments: "the cup is on the table".
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
    /// So many things are there: "there are two chairs in the kitchen".
    Exists(Phrase),
    /// The opposite.
    Not(Box<Clause>),
    /// All of several.
    All(Vec<Clause>),
    /// At least one of several.
    Any(Vec<Clause>),
}
