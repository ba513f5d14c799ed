//! What decided a clause.

use crate::scene::Term;
use crate::truth::{Truth, UndecidedReason};

/// How many facts are named for one clause.
const MOST_WITNESSES: usize = 16;

/// A fact that decided.
#[derive(Clone, Debug, PartialEq)]
pub struct Witness {
    /// The predicate's name, a word of quality, or `"exists"`.
    pub predicate: String,
    /// The things that it was asked of.
    pub terms: Vec<Term>,
    /// What it is of them.
    pub truth: Truth,
}

/// A truth value with the facts that suffice for it.
#[derive(Clone, Debug)]
pub(super) struct Judged {
    pub(super) truth: Truth,
    pub(super) witnesses: Vec<Witness>,
}

impl Judged {
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
        Self::plain(Truth::Undecided(reason))
    }

    pub(super) fn plain(truth: Truth) -> Self {
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

    /// True where all are: with the facts of all, or of the first that is false.
    pub(super) fn all(parts: impl Iterator<Item = Self>) -> Self {
        Self::until(parts, Truth::False, Truth::and)
    }

    /// True where one is: with the facts of the first that is true, or of all.
    pub(super) fn any(parts: impl Iterator<Item = Self>) -> Self {
        Self::until(parts, Truth::True, Truth::or)
    }

    fn until(
        parts: impl Iterator<Item = Self>,
        decisive: Truth,
        join: fn(Truth, Truth) -> Truth,
    ) -> Self {
        let mut whole = Self::plain(!decisive);
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
