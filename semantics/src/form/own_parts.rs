//! Sentences about parts of things, which are no things of their own in a scene: "a wardrobe with three doors".

use super::visit::Relation;
use super::{Form, Modifier, Noun, Phrase};

/// Nouns of things that are also what parts of other things are called.
const PART_NOUNS: [&str; 2] = ["door", "shelf"];

/// Nouns of parts of things alone.
const NOUNS_OF_PARTS_ALONE: [&str; 7] = [
    "armrest",
    "drawer",
    "frame",
    "handle",
    "headboard",
    "lampshade",
    "lid",
];

impl Noun {
    /// Returns whether it is that of parts alone, which a scene does not tell apart.
    pub(crate) fn is_of_parts_alone(&self) -> bool {
        matches!(self, Self::Object(noun) if NOUNS_OF_PARTS_ALONE.contains(&noun.as_str()))
    }
}

fn is_part(phrase: &Phrase) -> bool {
    matches!(
        phrase,
        Phrase::Described(own)
            if matches!(&own.noun, Noun::Object(noun) if PART_NOUNS.contains(&noun.as_str()))
    )
}

fn is_whole(phrase: &Phrase) -> bool {
    match phrase {
        Phrase::Id(_) => true,
        Phrase::Described(own) => matches!(own.noun, Noun::Object(_)),
        _ => false,
    }
}

impl Form {
    /// Returns whether it is about doors or shelves that belong to a thing. A scene knows things, not their parts: it can neither affirm
    /// nor deny that.
    pub(crate) fn asks_for_parts(&self) -> bool {
        let asks = |relation: &Relation| {
            let [one, other] = &relation.arguments[..] else {
                return false;
            };
            match relation.predicate.as_str() {
                "has" => is_whole(one) && is_part(other),
                "belongs_to" => is_part(one) && is_whole(other),
                _ => false,
            }
        };
        self.relations().iter().any(asks)
    }

    /// Returns whether something with a load is said to stand on a shelf in an order: "a bookcase with two vases on the lowest shelf",
    /// where the shelf is the bookcase's own and the vases stand on it.
    pub(crate) fn has_load_on_own_shelf(&self) -> bool {
        let is_nth_shelf = |place: &Modifier| {
            matches!(
                &place.arguments[..],
                [shelf @ Phrase::Described(own)] if own.selection.is_some() && is_part(shelf)
            )
        };
        self.phrases().iter().any(|phrase| match phrase {
            Phrase::Described(own) => own.modifiers.windows(2).any(|pair| {
                pair[0].predicate == "has" && pair[1].predicate == "on" && is_nth_shelf(&pair[1])
            }),
            _ => false,
        })
    }
}
