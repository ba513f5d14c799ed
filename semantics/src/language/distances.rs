//! Clauses about distances.

use super::from_tree::number;
use super::phrases::phrase;
use super::to_tree::{PhrasePosition, TreeBuilder, digits};
use crate::form::{Clause, Phrase};
use crate::grammar::Tree;

impl TreeBuilder<'_> {
    /// "The sofa is about three metres away", "the sofa is about two metres from the window".
    pub(super) fn distance(&self, subject: &Phrase, from: &Phrase, metres: u32) -> Option<Tree> {
        let mut arguments = vec![self.phrase(subject, PhrasePosition::Free)?];
        let mut function = match from {
            Phrase::Listener => "distance_away",
            _ => "distance",
        }
        .to_owned();
        match metres {
            1 => function.push_str("_one"),
            metres => arguments.push(digits(metres)),
        }
        if *from != Phrase::Listener {
            arguments.push(self.phrase(from, PhrasePosition::Free)?);
        }
        Some(Tree::apply(&function, arguments))
    }
}

/// The clause of a tree about a distance; `None` for other trees.
pub(super) fn from_tree(function: &str, arguments: &[Tree]) -> Option<Clause> {
    let (subject, metres, from) = match (function, arguments) {
        ("distance_away", [subject, metres]) => (subject, number(metres)?, Phrase::Listener),
        ("distance_away_one", [subject]) => (subject, 1, Phrase::Listener),
        ("distance", [subject, metres, from]) => (subject, number(metres)?, phrase(from)?),
        ("distance_one", [subject, from]) => (subject, 1, phrase(from)?),
        _ => return None,
    };
    Some(Clause::Distance {
        subject: phrase(subject)?,
        from,
        metres,
    })
}
