//! Things of a set: "one of the chairs", "the two cups", "none of them", "both bedrooms".

use super::from_tree::{entry_id, number, parts};
use super::phrases::nominal;
use crate::form::{Description, Noun, Phrase, Quantifier};
use crate::grammar::Tree;

/// The phrase of some, all or none of a set; `None` for other trees.
pub(super) fn partitive_phrase(function: &str, arguments: &[Tree]) -> Option<Phrase> {
    let (quantifier, of) = match (function, arguments) {
        ("one_of", [of]) => (Quantifier::Some, of),
        ("only_one_of", [of]) => (Quantifier::Exactly(1), of),
        ("all_of", [of]) => (every_member(of)?, of),
        ("both_of", [of]) => (Quantifier::All(2), of),
        ("none_of", [of]) => (Quantifier::No, of),
        ("several_of", [of]) => (Quantifier::AtLeast(2), of),
        ("number_of", [count, of]) => (Quantifier::Exactly(number(count)?), of),
        ("at_least_of", [count, of]) => (Quantifier::AtLeast(number(count)?), of),
        ("at_most_of", [count, of]) => (Quantifier::AtMost(number(count)?), of),
        ("more_than_of", [count, of]) => (more_than(count)?, of),
        ("fewer_than_of", [count, of]) => (fewer_than(count)?, of),
        _ => return None,
    };
    Some(set_description(of)?.with_quantifier(quantifier).into())
}

/// All of a set: of a counted one, "all of the three chairs", of exactly that number.
fn every_member(set: &Tree) -> Option<Quantifier> {
    Some(match parts(set)? {
        ("set_counted" | "room_set_counted", [count, _]) => Quantifier::All(number(count)?),
        _ => Quantifier::Every,
    })
}

/// "More than three" is at least four.
pub(super) fn more_than(count: &Tree) -> Option<Quantifier> {
    Some(Quantifier::AtLeast(number(count)?.checked_add(1)?))
}

/// "Fewer than three" is at most two.
pub(super) fn fewer_than(count: &Tree) -> Option<Quantifier> {
    Some(Quantifier::AtMost(number(count)?.checked_sub(1)?))
}

/// The description of the members of a set; the caller sets its quantifier.
pub(super) fn set_description(tree: &Tree) -> Option<Description> {
    let room = |noun: &Tree| {
        Some(Description::new(
            Quantifier::Some,
            Noun::Room(entry_id(noun)?),
        ))
    };
    match parts(tree)? {
        // Of "one of the two chairs" it is taken for granted that there are two, as one is of "the chair"; "all of the two" says it.
        ("set" | "set_counted", [.., noun]) => nominal(noun),
        ("set_other", [noun]) => Some(nominal(noun)?.other()),
        ("set_same", []) => Some(Description::new(Quantifier::Some, Noun::SameThings)),
        ("room_set" | "room_set_counted", [.., noun]) => room(noun),
        ("room_set_other", [noun]) => Some(room(noun)?.other()),
        _ => None,
    }
}
