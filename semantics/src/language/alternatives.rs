//! Questions for those of several clauses that are true: forms to trees, and trees to forms.

use super::from_tree::{atomic_clause, entry_id, parts};
use super::phrases::{nominal, phrase};
use super::questions::question;
use super::sets;
use super::to_tree::TreeBuilder;
use super::verb_phrases::clause;
use crate::form::{Clause, Description, Noun, Phrase, Quality, Question};
use crate::grammar::Tree;

/// The clauses of a tree that asks which is true; `None` for other trees.
pub(super) fn from_tree(function: &str, arguments: &[Tree]) -> Option<Vec<Clause>> {
    Some(match (function, arguments) {
        ("alternatives", [first, second]) => {
            let mut all = whether_clauses(first)?;
            all.extend(whether_clauses(second)?);
            all
        }
        ("alternatives_of", [subject, one, other]) => {
            // "On the left or to the right of the chair" is of the chair, both.
            let is_side = |said: &Tree| matches!(parts(said), Some(("vp_side", _)));
            if is_side(one) != is_side(other) {
                return None;
            }
            let subject = phrase(subject)?;
            vec![clause(subject.clone(), one)?, clause(subject, other)?]
        }
        ("alternatives_of_three", [subject, one, second, third]) => {
            let subject = phrase(subject)?;
            let said = [one, second, third].into_iter();
            said.map(|said| clause(subject.clone(), said))
                .collect::<Option<_>>()?
        }
        ("alternatives_stands", [subject, _, one, other]) => {
            let subject = phrase(subject)?;
            vec![clause(subject.clone(), one)?, clause(subject, other)?]
        }
        ("which_is_farther", [of, one, other]) => {
            let mut clauses = closer(&phrase(of)?, [phrase(one)?, phrase(other)?]);
            clauses.reverse();
            clauses
        }
        ("alternatives_landmark", [subject, relation, one, other]) => {
            related(subject, [relation; 2], [one, other])?
        }
        ("alternatives_relation", [subject, one, other, landmark]) => {
            related(subject, [one, other], [landmark; 2])?
        }
        ("alternatives_left_right" | "alternatives_stand", [subject, landmark]) => {
            let (subject, landmark) = (phrase(subject)?, phrase(landmark)?);
            let side = |name| atomic_clause(name, vec![subject.clone(), landmark.clone()]);
            vec![side("left_of"), side("right_of")]
        }
        ("alternatives_subject", [kind, said, one, other]) => {
            let kind = nominal(kind)?;
            of_kind(&kind, said, [phrase(one)?, phrase(other)?])?
        }
        ("alternatives_bare", [said, one, other]) => {
            subjects(said, [phrase(one)?, phrase(other)?])?
        }
        ("which_compared", [word, one, other]) => {
            comparison_both_ways(word, phrase(one)?, phrase(other)?)?
        }
        ("which_of_compared", [set, word, one, other]) => {
            let kind = sets::set_description(set)?;
            let [one, other] = with_noun_of(&kind, [phrase(one)?, phrase(other)?]);
            comparison_both_ways(word, one, other)?
        }
        ("which_compared_less", [word, one, other]) => {
            let mut clauses = comparison_both_ways(word, phrase(one)?, phrase(other)?)?;
            // The smaller of two is the one that the other is larger than.
            clauses.reverse();
            clauses
        }
        ("which_closer_or" | "which_is_closer", [of, one, other]) => {
            closer(&phrase(of)?, [phrase(one)?, phrase(other)?])
        }
        ("which_kind_is_closer_than", [kind, of, one, other]) => {
            let named = with_noun_of(&nominal(kind)?, [phrase(one)?, phrase(other)?]);
            closer(&phrase(of)?, named)
        }
        ("which_is_closest", [order, of, one, other]) => {
            let mut clauses = closer(&phrase(of)?, [phrase(one)?, phrase(other)?]);
            if entry_id(order)? == "farthest_from" {
                clauses.reverse();
            }
            clauses
        }
        ("which_kind_is_farther", [kind, of, one, other]) => {
            let named = with_noun_of(&nominal(kind)?, [phrase(one)?, phrase(other)?]);
            let mut clauses = closer(&phrase(of)?, named);
            clauses.reverse();
            clauses
        }
        ("which_kind_is_closer", [kind, order, of, one, other]) => {
            let named = with_noun_of(&nominal(kind)?, [phrase(one)?, phrase(other)?]);
            let mut clauses = closer(&phrase(of)?, named);
            if entry_id(order)? == "farthest_from" {
                clauses.reverse();
            }
            clauses
        }
        ("which_kind_compared" | "which_kind_compared_less", [kind, word, one, other]) => {
            let [one, other] = with_noun_of(&nominal(kind)?, [phrase(one)?, phrase(other)?]);
            let mut clauses = comparison_both_ways(word, one, other)?;
            if function.ends_with("_less") {
                clauses.reverse();
            }
            clauses
        }
        ("which_kind_selected", [kind, order, one, other]) => {
            let [one, other] = with_noun_of(&nominal(kind)?, [phrase(one)?, phrase(other)?]);
            let (relation, is_less) = comparison_of(&entry_id(order)?)?;
            let mut clauses = both_ways(relation, one, other);
            if is_less {
                clauses.reverse();
            }
            clauses
        }
        ("alternatives_made_of" | "alternatives_made_of_three", [subject, words @ ..]) => {
            qualities(subject, words, Quality::Material)?
        }
        ("alternatives_color", [subject, words @ ..]) => qualities(subject, words, Quality::Color)?,
        _ => return None,
    })
}

fn whether_clauses(tree: &Tree) -> Option<Vec<Clause>> {
    match question(tree)? {
        Question::Whether(clause) => Some(vec![clause]),
        Question::Alternatives(clauses) => Some(clauses),
        _ => None,
    }
}

fn related(subject: &Tree, relations: [&Tree; 2], landmarks: [&Tree; 2]) -> Option<Vec<Clause>> {
    let subject = phrase(subject)?;
    let mut clauses = Vec::with_capacity(2);
    for (relation, landmark) in relations.into_iter().zip(landmarks) {
        clauses.push(atomic_clause(
            &entry_id(relation)?,
            vec![subject.clone(), phrase(landmark)?],
        ));
    }
    Some(clauses)
}

/// "Which door is open, the left one or the right one?" "One" is a door.
fn of_kind(kind: &Description, said: &Tree, named: [Phrase; 2]) -> Option<Vec<Clause>> {
    subjects(said, with_noun_of(kind, named))
}

fn with_noun_of(kind: &Description, mut named: [Phrase; 2]) -> [Phrase; 2] {
    for subject in &mut named {
        if let Phrase::Described(own) = subject
            && own.noun == Noun::SameNoun
        {
            own.noun.clone_from(&kind.noun);
        }
    }
    named
}

fn subjects(said: &Tree, subjects: [Phrase; 2]) -> Option<Vec<Clause>> {
    let mut clauses = Vec::with_capacity(2);
    for subject in subjects {
        clauses.push(clause(subject, said)?);
    }
    Some(clauses)
}

fn comparison_both_ways(word: &Tree, one: Phrase, other: Phrase) -> Option<Vec<Clause>> {
    Some(both_ways(&entry_id(word)?, one, other))
}

fn both_ways(relation: &str, one: Phrase, other: Phrase) -> Vec<Clause> {
    vec![
        atomic_clause(relation, vec![one.clone(), other.clone()]),
        atomic_clause(relation, vec![other, one]),
    ]
}

/// The comparison of which an order names the extreme, and whether that is the one that has less of it.
fn comparison_of(order: &str) -> Option<(&'static str, bool)> {
    Some(match order {
        "largest" => ("larger_than", false),
        "smallest" => ("larger_than", true),
        "tallest" => ("taller_than", false),
        "widest" => ("wider_than", false),
        _ => return None,
    })
}

fn qualities(
    subject: &Tree,
    words: &[Tree],
    quality: impl Fn(String) -> Quality,
) -> Option<Vec<Clause>> {
    let subject = phrase(subject)?;
    let mut clauses = Vec::with_capacity(words.len());
    for word in words {
        clauses.push(Clause::Is {
            subject: subject.clone(),
            quality: quality(entry_id(word)?),
        });
    }
    Some(clauses)
}

fn closer(subject: &Phrase, [one, other]: [Phrase; 2]) -> Vec<Clause> {
    let to = |near: &Phrase, far: &Phrase| {
        atomic_clause(
            "closer_to",
            vec![subject.clone(), near.clone(), far.clone()],
        )
    };
    vec![to(&one, &other), to(&other, &one)]
}

impl TreeBuilder<'_> {
    /// "Is the cup on the table, or is the cup in the sink?"
    pub(super) fn alternatives(&self, clauses: &[Clause]) -> Option<Tree> {
        match clauses {
            [first, second] => Some(Tree::apply(
                "alternatives",
                [
                    self.whether_question(first)?,
                    self.whether_question(second)?,
                ],
            )),
            [first, rest @ ..] if rest.len() > 1 => Some(Tree::apply(
                "alternatives",
                [self.whether_question(first)?, self.alternatives(rest)?],
            )),
            _ => None,
        }
    }
}
