//! Numbers compared: forms to trees, and trees to forms.

use super::from_tree::number;
use super::phrases::{modifier, nominal, phrase};
use super::to_tree::TreeBuilder;
use super::{sets, verb_phrases};
use crate::form::{Clause, Description, Modifier, Phrase, Quantifier};
use crate::grammar::Tree;

/// More of one than of the other. What is said of the second alone is said of both: "more chairs than tables in the kitchen".
pub(super) fn comparative(more: &Tree, than: &Tree) -> Option<Clause> {
    let (mut more, than) = (nominal(more)?, nominal(than)?);
    if more.modifiers.is_empty() {
        more.modifiers.clone_from(&than.modifiers);
    }
    Some(clause(more, than))
}

fn clause(more: Description, than: Description) -> Clause {
    Clause::More {
        more: Box::new(more),
        than: Box::new(than),
    }
}

/// More of a kind in or on one thing than in or on another.
pub(super) fn comparative_by_holder(one: &Tree, what: &Tree, other: &Tree) -> Option<Clause> {
    let what = nominal(what)?;
    let within = |place: &Tree| {
        let place = phrase(place)?;
        Some(
            what.clone()
                .with_modifier(Modifier::new("belongs_to", [place])),
        )
    };
    Some(clause(within(one)?, within(other)?))
}

/// More of a kind of which one modifier holds than of which another does.
pub(super) fn comparative_by_modifier(what: &Tree, one: &Tree, other: &Tree) -> Option<Clause> {
    let what = nominal(what)?;
    let there = |place: &Tree| Some(what.clone().with_modifier(modifier(place)?));
    Some(clause(there(one)?, there(other)?))
}

/// More of a kind in one place than of another kind in another: "more jars on the shelf than mugs on the table".
pub(super) fn comparative_by_place(more: [&Tree; 2], than: [&Tree; 2]) -> Option<Clause> {
    let there = |[what, place]: [&Tree; 2]| Some(nominal(what)?.with_modifier(modifier(place)?));
    Some(clause(there(more)?, there(than)?))
}

/// "Most of the books are on the shelf": more of them are than are not. Only what a modifier can deny.
pub(super) fn majority(set: &Tree, said: &Tree) -> Option<Clause> {
    let all = sets::set_description(set)?;
    let what = verb_phrases::with_predications(all.clone(), said)?;
    let added = what.modifiers.get(all.modifiers.len()..)?;
    let said = match (added, &what.state, &all.state) {
        ([one], own, known) if own == known => one.clone(),
        ([], Some(state), None) => Modifier::new(state, []),
        _ => return None,
    };
    let rest = Description {
        modifiers: all.modifiers.clone(),
        state: all.state.clone(),
        ..what
    };
    (rest == all).then_some(())?;
    let not = Modifier {
        negated: !said.negated,
        ..said.clone()
    };
    Some(clause(
        all.clone().with_modifier(said),
        all.with_modifier(not),
    ))
}

/// Equal numbers: more of neither.
pub(super) fn equative(one: &Tree, other: &Tree) -> Option<Clause> {
    let not = |clause: Clause| Clause::Not(Box::new(clause));
    Some(Clause::All(vec![
        not(comparative(one, other)?),
        not(comparative(other, one)?),
    ]))
}

/// The clauses of "two or three chairs".
pub(super) fn alternative_count_clauses(
    counts: [&Tree; 2],
    what: &Description,
    clause: impl Fn(Phrase) -> Clause,
) -> Option<Vec<Clause>> {
    let exactly = |count: &Tree| {
        let quantifier = Quantifier::Exactly(number(count)?);
        Some(clause(what.clone().with_quantifier(quantifier).into()))
    };
    counts.into_iter().map(exactly).collect()
}

impl TreeBuilder<'_> {
    /// The nouns of "more chairs than tables in the kitchen".
    pub(super) fn compared_nouns(
        &self,
        more: &Description,
        than: &Description,
    ) -> Option<(Tree, Tree)> {
        let plain = |description: &Description| {
            description.quantifier == Quantifier::Some && description.selection.is_none()
        };
        if !plain(more) || !plain(than) {
            return None;
        }
        let bare = Description {
            modifiers: Vec::new(),
            ..more.clone()
        };
        let first = match (&more.modifiers[..], &than.modifiers[..]) {
            (own, other) if own == other => &bare,
            ([], _) => return None,
            _ => more,
        };
        Some((self.with_modifiers(first)?, self.with_modifiers(than)?))
    }
}
