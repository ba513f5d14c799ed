//! Claims that a thing is itself.

use super::{Form, Modifier};

impl Form {
    /// Returns whether a thing is said to be one of its own kind: where "it" has no antecedent, "It is a lamp" says nothing.
    pub(crate) fn is_tautology(&self) -> bool {
        self.relations().iter().any(|relation| {
            matches!(
                &relation.arguments[..],
                [one, other] if relation.predicate == Modifier::IDENTICAL && one == other
            )
        })
    }
}
