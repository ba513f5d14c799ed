//! Sentences about a thing and itself, which nobody means: those come of a wrong antecedent.

use super::{Clause, Description, Form, Modifier, Phrase, Quantifier, RequestStep};

/// Returns whether a description excludes all that it fits: "the bed other than the bed".
fn excludes_itself(own: &Description) -> bool {
    let is_own = |modifier: &Modifier| {
        let [Phrase::Described(other)] = &modifier.arguments[..] else {
            return false;
        };
        let mut rest = own.clone();
        rest.modifiers.retain(|kept| kept != modifier);
        modifier.negated
            && modifier.predicate == Modifier::IDENTICAL
            && other.quantifier == Quantifier::The
            && rest.with_quantifier(Quantifier::The) == **other
    };
    own.quantifier == Quantifier::The && own.modifiers.iter().any(is_own)
}

fn puts_into_itself(step: &RequestStep) -> bool {
    match step {
        RequestStep::Put { object, to, .. } => match (object, to) {
            (Phrase::Described(object), Phrase::Described(to)) => {
                object.clone().with_quantifier(to.quantifier) == **to
                    && object.quantifier != Quantifier::Some
            }
            _ => false,
        },
        RequestStep::If {
            then, otherwise, ..
        } => then.iter().chain(otherwise).any(puts_into_itself),
        _ => false,
    }
}

/// "There are two jars in the bookcase, one above the other" has no bookcase other than the bookcase.
fn has_wrong_other(clause: &Clause) -> bool {
    match clause {
        Clause::Holds { arguments, .. } => matches!(
            &arguments[..],
            [Phrase::Described(subject), Phrase::Described(landmark)]
                if subject.noun != landmark.noun && excludes_itself(landmark)
        ),
        Clause::All(clauses) | Clause::Any(clauses) => clauses.iter().any(has_wrong_other),
        Clause::Not(inner) | Clause::Now(inner) => has_wrong_other(inner),
        _ => false,
    }
}

impl Form {
    /// Returns whether it says that a thing is itself, puts it into itself, or speaks of another one than a landmark where
    /// another one than the subject is meant.
    pub(crate) fn is_about_itself(&self) -> bool {
        let relations = self.relations();
        let is_itself = relations.iter().any(|relation| {
            matches!(
                &relation.arguments[..],
                [one, other] if relation.predicate == Modifier::IDENTICAL && one == other
            )
        });
        // "Nobody on the sofa and nothing on the rug" is not on a sofa and nothing.
        let is_nothing = |item: &Phrase| matches!(item, Phrase::Described(own) if own.quantifier == Quantifier::No);
        let is_at_nothing = relations.iter().any(|relation| {
            relation.arguments.iter().skip(1).any(
                |landmark| matches!(landmark, Phrase::List(items) if items.iter().any(is_nothing)),
            )
        });
        is_itself
            || is_at_nothing
            || match self {
                Self::Request(steps) => steps.iter().any(puts_into_itself),
                Self::Claim(clause) => has_wrong_other(clause),
                _ => false,
            }
    }
}
