//! Clauses that people say in ways of their own and the engine says otherwise.

use super::from_tree::{atomic_clause, entry_id, modifier_clause, place_of, room};
use super::phrases::{modifier, nominal, phrase};
use super::{converse, existence, numbers, places, questions, sets, verb_phrases};
use crate::form::{Clause, Description, Modifier, Phrase, Quantifier};
use crate::grammar::Tree;

/// "I see a chair but no table."
fn one_but_none(item: &Tree, noun: &Tree, added: &Modifier) -> Option<Clause> {
    let Phrase::Described(item) = existence::items_from_tree(item)? else {
        return None;
    };
    let none = nominal(noun)?.with_quantifier(Quantifier::No);
    Some(Clause::All(vec![
        Clause::Exists(item.with_modifier(added.clone()).into()),
        Clause::Exists(none.with_modifier(added.clone()).into()),
    ]))
}

/// The clause of a tree; `None` for other trees.
pub(super) fn from_tree(function: &str, arguments: &[Tree]) -> Option<Clause> {
    Some(match (function, arguments) {
        ("has_around" | "whether_has_around", [holder, item, relation]) => converse::clause(
            phrase(holder)?,
            &entry_id(relation)?,
            existence::items_from_tree(item)?,
        )?,
        ("leads_between", [door, from, to]) => {
            let Phrase::Described(door) = phrase(door)? else {
                return None;
            };
            let door = door.with_modifier(Modifier::new("leads_from", [room(from)?]));
            atomic_clause("leads_to", vec![door.into(), room(to)?])
        }
        ("structure_says", [noun, added, said]) => {
            verb_phrases::clause(places::structure(noun, Some(modifier(added)?))?, said)?
        }
        ("share_place", [one, other, relation, noun]) => {
            let place = [relation.clone(), noun.clone(), other.clone()];
            let (predicate, shared) = place_of(&Tree::apply("place_same_thing", place))?;
            atomic_clause(&predicate, vec![phrase(one)?, shared])
        }
        ("share_room" | "whether_share_room", [one, other]) => {
            let (predicate, shared) = place_of(&Tree::apply("place_same_room", [other.clone()]))?;
            atomic_clause(&predicate, vec![phrase(one)?, shared])
        }
        ("exists_each_other", [subject, relation]) => atomic_clause(
            &entry_id(relation)?,
            vec![phrase(subject)?, Phrase::EachOther],
        ),
        ("room_has_each_other", [place, subject, relation]) => {
            let Phrase::Described(own) = phrase(subject)? else {
                return None;
            };
            let there = own.with_modifier(Modifier::new("in_room", [room(place)?]));
            atomic_clause(&entry_id(relation)?, vec![there.into(), Phrase::EachOther])
        }
        ("see_but_no", [item, noun]) => one_but_none(item, noun, &Modifier::new("visible", []))?,
        ("exists_but_no", [item, noun, added]) => one_but_none(item, noun, &modifier(added)?)?,
        ("of_set_one_is" | "of_set_one_is_less", [set, added, word]) => {
            let order = questions::superlative_of(&entry_id(word)?, function.ends_with("_less"))?;
            let one = questions::with_selection(sets::set_description(set)?, order, None);
            modifier_clause(one.into(), modifier(added)?)
        }
        // "The one on the left is the bigger one": the largest of those that there are.
        ("is_most" | "is_least" | "whether_most" | "whether_least", [subject, word]) => {
            let order = questions::superlative_of(&entry_id(word)?, function.ends_with("least"))?;
            let subject = phrase(subject)?;
            let Phrase::Described(own) = &subject else {
                return None;
            };
            let all = Description::new(Quantifier::The, own.noun.clone());
            let most = questions::with_selection(all, order, None);
            atomic_clause(Modifier::IDENTICAL, vec![subject, most.into()])
        }
        ("whether_reach", [thing]) => {
            atomic_clause("reachable", vec![phrase(thing)?, Phrase::Listener])
        }
        ("most_are" | "whether_most_are", [set, said]) => numbers::majority(set, said)?,
        ("neither_says", [one, other, said]) => {
            let not = |subject: &Tree| match phrase(subject)? {
                // "Neither a chair nor a table is there": no chair is.
                Phrase::Described(own) if own.quantifier == Quantifier::Some => {
                    verb_phrases::clause(own.with_quantifier(Quantifier::No).into(), said)
                }
                subject => {
                    let clause = verb_phrases::clause(subject, said)?;
                    Some(Clause::Not(Box::new(clause)))
                }
            };
            Clause::All(vec![not(one)?, not(other)?])
        }
        ("exists_neither_of", [one, other]) => {
            let no = |noun: &Tree| {
                let noun = nominal(noun)?.with_quantifier(Quantifier::No);
                Some(Clause::Exists(noun.into()))
            };
            Clause::All(vec![no(one)?, no(other)?])
        }
        ("room_has_neither", [place, one, other]) => {
            let there = Modifier::new("in_room", [room(place)?]);
            let no = |noun: &Tree| {
                let noun = nominal(noun)?.with_modifier(there.clone());
                Some(Clause::Exists(noun.with_quantifier(Quantifier::No).into()))
            };
            Clause::All(vec![no(one)?, no(other)?])
        }
        _ => return None,
    })
}
