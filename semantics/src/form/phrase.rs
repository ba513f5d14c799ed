//! Noun phrases: the things that a form is about.

use crate::size::SizeClass;
use serde::{Deserialize, Serialize};

/// The number of things that a clause holds of, among those that a description fits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantifier {
    /// At least one: "a chair".
    Some,
    /// The only one: "the chair". Where none fits, the clause is false; where several fit, undecided unless all decide alike.
    The,
    /// All of them: "every chair"; true where none fits.
    Every,
    /// All that are meant: "the chairs", those that the listener sees where it sees some. False where none fits.
    ThePlural,
    /// All of exactly this number: "both chairs", "all three chairs"; false where another number fits.
    All(u32),
    /// None: "no chair".
    No,
    /// This number: "two chairs".
    Exactly(u32),
    /// This number or more: "at least two chairs".
    AtLeast(u32),
    /// This number or fewer: "at most two chairs".
    AtMost(u32),
}

/// The noun of a description, singular.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Noun {
    /// An object: "chair", "pair of shoes".
    Object(String),
    /// A room: "kitchen".
    Room(String),
    /// A piece of the building, by its kind: "wall", "floor", "ceiling".
    Structure(String),
    /// A storey.
    Storey,
    /// The noun of a thing that was named before: "the red one". [`crate::form::Form::resolve_anaphora`] puts that in its place.
    SameNoun,
    /// All that was said of things that were named before: "both of them". As [`Self::SameNoun`].
    SameThings,
}

impl Noun {
    /// The noun that names every object.
    pub const ANY_OBJECT: &'static str = "thing";
    /// The noun that names every room.
    pub const ANY_ROOM: &'static str = "room";
}

/// A modifier of a description: a relation, a place or the negation of one.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Modifier {
    /// True for a negation: "but not on the table".
    pub negated: bool,
    /// The predicate's name; its first argument is the described thing.
    pub predicate: String,
    /// Its other arguments.
    pub arguments: Vec<Phrase>,
}

impl Modifier {
    /// The predicate of being one and the same thing.
    pub const IDENTICAL: &'static str = "identical";

    /// Returns a modifier that is not negated.
    pub fn new(predicate: &str, arguments: impl Into<Vec<Phrase>>) -> Self {
        Self {
            negated: false,
            predicate: predicate.to_owned(),
            arguments: arguments.into(),
        }
    }
}

/// The choice of one of the things that a description fits, by its place in an order.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct OrdinalSelection {
    /// The order's name: `"from_left"`, `"largest"`, `"closest_to"`.
    pub order: String,
    /// The place in it, counted from 1.
    pub place: u32,
    /// The reference of an order that needs one: the bed in "closest to the bed".
    pub reference: Option<Box<Phrase>>,
}

impl OrdinalSelection {
    /// The order of rooms in the house's own list, as in "the second bedroom".
    pub const OF_HOUSE: &'static str = "house";
}

/// A description: a noun phrase that picks out things by their kind, qualities and relations.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Description {
    /// The quantifier.
    pub quantifier: Quantifier,
    /// The noun.
    pub noun: Noun,
    /// Its size for its kind; never [`SizeClass::Normal`].
    pub size: Option<SizeClass>,
    /// A state by name: `"open"`, `"switched_off"`.
    pub state: Option<String>,
    /// Colour words, at most two; the thing shows all of them.
    pub colors: Vec<String>,
    /// The adjective of a substance.
    pub material: Option<String>,
    /// The modifiers, all of which hold.
    pub modifiers: Vec<Modifier>,
    /// The choice by an order; with one the quantifier is [`Quantifier::The`].
    pub selection: Option<OrdinalSelection>,
}

impl Description {
    /// The room that the listener is in.
    pub(crate) fn room_of_listener() -> Self {
        let room = Noun::Room(Noun::ANY_ROOM.to_owned());
        let with = Modifier::new("room_contains", [Phrase::Listener]);
        Self::new(Quantifier::The, room).with_modifier(with)
    }

    /// Returns a description by a noun alone.
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

    /// Returns the same description with another modifier at the end.
    #[must_use]
    pub fn with_modifier(mut self, modifier: Modifier) -> Self {
        self.modifiers.push(modifier);
        self
    }

    /// Returns the same description for another thing than the one of its noun that was named before: "the other chair".
    #[must_use]
    pub fn other(self) -> Self {
        self.with_modifier(Modifier {
            negated: true,
            ..Modifier::new(Modifier::IDENTICAL, [Phrase::NamedBefore])
        })
    }

    /// Returns the same description with another quantifier.
    #[must_use]
    pub fn with_quantifier(self, quantifier: Quantifier) -> Self {
        Self { quantifier, ..self }
    }
}

/// A noun phrase: an argument of a clause.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Phrase {
    /// A thing by the id that sensors and scene graph give it: "object 12".
    Id(u32),
    /// Things by a description.
    Described(Box<Description>),
    /// The listener: "you".
    Listener,
    /// A storey, counted upwards from 1: "on the second floor".
    Storey(u32),
    /// A list of which a clause holds one by one: "a table and two chairs".
    List(Vec<Phrase>),
    /// The thing that "the other lamp" is other than: one with the same noun that was named before.
    /// [`crate::form::Form::resolve_anaphora`] puts that in its place.
    NamedBefore,
    /// The others of several: "the chairs are next to each other", each to another one.
    EachOther,
    /// The speaker: "me". Undecided in clauses: a scene does not know who speaks.
    Speaker,
    /// "It": a thing that was named before. [`crate::form::Form::resolve_anaphora`] puts that in its place.
    Pronoun,
    /// The open argument of a question.
    Hole,
}

impl From<Description> for Phrase {
    fn from(description: Description) -> Self {
        Self::Described(Box::new(description))
    }
}
