//! Witnesses: the facts that decide a clause.

use crate::scene::Term;
use crate::truth::{Truth, UndecidedReason};

/// Largest number of witnesses of one clause.
pub(super) const MOST_WITNESSES: usize = 16;

/// A fact that decided a clause.
#[derive(Clone, Debug, PartialEq)]
pub struct Witness {
    /// The predicate's name, the word of a quality, or `"exists"`.
    pub predicate: String,
    /// Its arguments.
    pub terms: Vec<Term>,
    /// Its truth value.
    pub truth: Truth,
}

/// A truth value with the facts that suffice for it.
#[derive(Clone, Debug)]
pub(super) struct WitnessedTruth {
    pub(super) truth: Truth,
    pub(super) witnesses: Vec<Witness>,
}

impl WitnessedTruth {
    pub(super) fn fact(predicate: &str, terms: &[Term], truth: Truth) -> Self {
        let witness = Witness {
            predicate: predicate.to_owned(),
            terms: terms.to_vec(),
            truth,
        };
        Self {
            truth,
            witnesses: vec![witness],
        }
    }

    pub(super) fn undecided(reason: UndecidedReason) -> Self {
        Self::without_witnesses(Truth::Undecided(reason))
    }

    pub(super) fn without_witnesses(truth: Truth) -> Self {
        Self {
            truth,
            witnesses: Vec::new(),
        }
    }

    pub(super) fn negated(self) -> Self {
        Self {
            truth: !self.truth,
            ..self
        }
    }

    /// Conjunction, with the facts of all parts, or of the first that is false.
    pub(super) fn all(parts: impl Iterator<Item = Self>) -> Self {
        Self::fold_until(parts, Truth::False, Truth::and)
    }

    /// Disjunction, with the facts of the first part that is true, or of all.
    pub(super) fn any(parts: impl Iterator<Item = Self>) -> Self {
        Self::fold_until(parts, Truth::True, Truth::or)
    }

    fn fold_until(
        parts: impl Iterator<Item = Self>,
        decisive: Truth,
        join: fn(Truth, Truth) -> Truth,
    ) -> Self {
        let mut whole = Self::without_witnesses(!decisive);
        for part in parts {
            if part.truth == decisive {
                return part;
            }
            whole.truth = join(whole.truth, part.truth);
            let room = MOST_WITNESSES - whole.witnesses.len().min(MOST_WITNESSES);
            whole
                .witnesses
                .extend(part.witnesses.into_iter().take(room));
        }
        whole
    }
}
