//! Noun phrases: the things that a form is about.

use crate::size::SizeClass;
use serde::{Deserialize, Serialize};

/// How many of the things that fit a description are meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantifier {
    /// At least one: "a chair".
    Some,
    /// The only one that fits: "the chair". Where none or several fit, nothing is said that could be true.
    The,
    /// All of them: "every chair"; true of none.
    Every,
    /// None: "no chair".
    No,
    /// So many and no more: "two chairs".
    Exactly(u32),
    /// So many or more: "at least two chairs".
    AtLeast(u32),
}

/// The kind of thing that is described, by its spoken noun for one.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Noun {
    /// An object: "chair", "pair of shoes".
    Object(String),
    /// A room: "kitchen".
    Room(String),
}

/// A relation, a place or its negation, said of what is described.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Modifier {
    /// Set for "but not on the table".
    pub negated: bool,
    /// The predicate's name; what is described is its first argument.
    pub predicate: String,
    /// Its other arguments.
    pub arguments: Vec<Phrase>,
}

/// One thing out of those that a description fits, by an order.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Selection {
    /// The order's name: `"from_left"`, `"largest"`, `"closest_to"`.
    pub order: String,
    /// The place in it, counted from 1.
    pub place: u32,
    /// What the order refers to, where it refers to something.
    pub reference: Option<Box<Phrase>>,
}

/// A thing by what is true of it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Description {
    /// How many are meant.
    pub quantifier: Quantifier,
    /// The kind of thing.
    pub noun: Noun,
    /// Its size for its kind; never [`SizeClass::Normal`].
    pub size: Option<SizeClass>,
    /// A state by name: `"open"`, `"switched_off"`.
    pub state: Option<String>,
    /// Plain colour words, all of which it shows; at most two.
    pub colors: Vec<String>,
    /// The adjective of a substance.
    pub material: Option<String>,
    /// What else is true of it.
    pub modifiers: Vec<Modifier>,
    /// Which of those that fit, where an order decides; then the quantifier is [`Quantifier::The`].
    pub selection: Option<Selection>,
}

impl Description {
    /// A description by its noun alone.
    pub fn new(quantifier: Quantifier, noun: Noun) -> Self {
        Self {
            quantifier,
            noun,
            size: None,
            state: None,
            colors: Vec::new(),
            material: None,
            modifiers: Vec::new(),
            selection: None,
        }
    }

    /// The same of another quantifier.
    #[must_use]
    pub fn with_quantifier(self, quantifier: Quantifier) -> Self {
        Self { quantifier, ..self }
    }
}

/// What a form is about.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Phrase {
    /// A thing by the id that sensors and graph give it: "object 12".
    Id(u32),
    /// Things by what is true of them.
    Described(Box<Description>),
    /// Who is spoken to: "you".
    Listener,
    /// A storey, counted from 1 from below: "on the second floor".
    Storey(u32),
    /// What a question asks for.
    Hole,
}

impl From<Description> for Phrase {
    fn from(description: Description) -> Self {
        Self::Described(Box::new(description))
    }
}
