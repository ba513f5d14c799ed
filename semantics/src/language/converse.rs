//! What has another thing in a relation to itself: "a sink with a mirror above it".

use super::from_tree::atomic_clause;
use crate::form::{Clause, Modifier, Phrase, Quantifier};

/// Relations with their converses, as predicates declare them. The language does not depend on predicates; a test holds the two against
/// each other.
const CONVERSES: [(&str, &str); 7] = [
    ("above", "below"),
    ("behind", "in_front_of"),
    ("contains", "in"),
    ("held_by", "holds"),
    ("in_room", "room_contains"),
    ("left_of", "right_of"),
    ("on", "supports"),
];
/// Symmetric relations of two things.
const SYMMETRIC: [&str; 10] = [
    "far",
    "identical",
    "near",
    "next_to",
    "open_to",
    "opposite",
    "same_color",
    "same_kind",
    "same_material",
    "touching",
];

/// The relation that b has to a where a has this one to b; `None` where none is defined.
pub(super) fn converse_of(relation: &str) -> Option<&'static str> {
    let pairs = CONVERSES.iter();
    let found = pairs.flat_map(|(one, other)| [(*one, *other), (*other, *one)]);
    let mut known = found.chain(SYMMETRIC.iter().map(|own| (*own, *own)));
    known
        .find(|(own, _)| *own == relation)
        .map(|(_, converse)| converse)
}

/// The modifier of what `other` has a relation to: "with a lamp above it".
pub(super) fn modifier(relation: &str, other: Phrase) -> Option<Modifier> {
    Some(Modifier::new(converse_of(relation)?, [other]))
}

/// The clause of "the sink has a mirror above it"; the holder has the widest scope.
pub(super) fn clause(holder: Phrase, relation: &str, other: Phrase) -> Option<Clause> {
    let is_one = match &holder {
        Phrase::Id(_) | Phrase::Pronoun => true,
        Phrase::Described(own) => own.quantifier == Quantifier::The,
        _ => false,
    };
    if is_one {
        return Some(atomic_clause(relation, vec![other, holder]));
    }
    Some(atomic_clause(converse_of(relation)?, vec![holder, other]))
}
