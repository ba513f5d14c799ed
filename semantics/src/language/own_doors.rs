//! Doors of things, which have no terms of their own: "the fridge door".

use super::phrases::{nominal, phrase};
use crate::category::categories;
use crate::form::{Noun, Phrase, Quantifier};
use crate::grammar::Tree;
use crate::room_kind::room_kinds;

/// Returns whether a noun is that of furniture or of an appliance that opens.
fn opens(noun: &Noun) -> bool {
    let Noun::Object(noun) = noun else {
        return false;
    };
    // "The door of the toilet" is that of the room.
    let mut rooms = room_kinds().rows().iter();
    if rooms.any(|kind| kind.singular == noun || kind.synonyms.contains(&noun.as_str())) {
        return false;
    }
    let mut rows = categories().rows().iter();
    let row = rows.find(|row| row.singular == noun || row.synonyms.contains(&noun.as_str()));
    row.is_some_and(|row| row.openable && !["door", "window"].contains(&row.nyu40_name))
}

/// The thing that "the fridge door" and "the door of the fridge" are a part of: sensors give a part the id of its thing.
pub(super) fn with_door(tree: &Tree) -> Option<Phrase> {
    let whole = match phrase(tree) {
        Some(Phrase::Described(own)) => *own,
        Some(_) => return None,
        None => nominal(tree)?.with_quantifier(Quantifier::The),
    };
    opens(&whole.noun).then(|| whole.into())
}
