//! What has another thing in a relation to itself: "a sink with a mirror above it".

use super::from_tree::atomic_clause;
use crate::form::{Clause, Modifier, Phrase, Quantifier};
use crate::predicates;

/// The relation that b has to a where a has this one to b; `None` where none is defined.
fn converse_of(relation: &str) -> Option<&'static str> {
    let predicate = predicates::find(relation).ok()?;
    let properties = predicate.properties();
    if properties.symmetric {
        return Some(predicate.name());
    }
    properties.converse
}

/// The modifier of what `other` has a relation to: "with a lamp above it".
pub(super) fn modifier(relation: &str, other: Phrase) -> Option<Modifier> {
    Some(Modifier::new(converse_of(relation)?, [other]))
}

/// The clause of "the sink has a mirror above it"; the holder has the widest scope.
pub(super) fn clause(holder: Phrase, relation: &str, other: Phrase) -> Option<Clause> {
    if let Some(converse) = converse_of(relation) {
        return Some(atomic_clause(converse, vec![holder, other]));
    }
    let is_one = match &holder {
        Phrase::Id(_) | Phrase::Pronoun => true,
        Phrase::Described(own) => own.quantifier == Quantifier::The,
        _ => false,
    };
    is_one.then(|| atomic_clause(relation, vec![other, holder]))
}
