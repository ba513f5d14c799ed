//! Evaluation of quantified phrases; the first of a clause has the widest scope.

use super::Checker;
use super::witness::Judged;
use crate::form::{Description, Phrase, Quantifier};
use crate::scene::Term;
use crate::truth::{Truth, UndecidedReason};

/// A clause as a function of its arguments.
type Body<'a> = &'a dyn Fn(&[Term]) -> Judged;

impl Checker<'_> {
    /// Evaluates `body` for the `chosen` terms followed by all that the `arguments` range over.
    pub(super) fn quantify(
        &self,
        arguments: &[Phrase],
        chosen: &mut Vec<Term>,
        body: Body<'_>,
    ) -> Judged {
        let Some((first, rest)) = arguments.split_first() else {
            return body(chosen);
        };
        let mut with = |term: Term| {
            chosen.push(term);
            let judged = self.quantify(rest, chosen, body);
            chosen.pop();
            judged
        };
        match (self.named(first), first) {
            (Some(Ok(term)), _) => with(term),
            (Some(Err(reason)), _) => Judged::undecided(reason),
            (None, Phrase::Described(description)) => {
                self.quantify_description(description, &mut with)
            }
            (None, _) => Judged::undecided(UndecidedReason::UnknownTerm),
        }
    }

    fn quantify_description(
        &self,
        description: &Description,
        with: &mut dyn FnMut(Term) -> Judged,
    ) -> Judged {
        let extension = self.extension(description);
        if let Some(reason) = extension.fault {
            return Judged::undecided(reason);
        }
        // Of a thing that may or may not fit the clause is undecided, except where the result is the same either way.
        let fitting = extension.fits.iter().map(|term| (*term, None));
        let undecided = extension
            .undecided
            .iter()
            .map(|(term, reason)| (*term, Some(*reason)));
        let mut fitting = fitting.chain(undecided);
        match description.quantifier {
            Quantifier::Some => Judged::any(fitting.map(|(term, undecided)| {
                let mut judged = with(term);
                if let Some(reason) = undecided {
                    judged.truth = judged.truth.and(Truth::Undecided(reason));
                }
                judged
            })),
            Quantifier::Every => Judged::all(fitting.map(|(term, undecided)| {
                let mut judged = with(term);
                if let Some(reason) = undecided {
                    judged.truth = judged.truth.or(Truth::Undecided(reason));
                }
                judged
            })),
            Quantifier::No => Judged::all(fitting.map(|(term, undecided)| {
                let mut judged = with(term).negated();
                if let Some(reason) = undecided {
                    judged.truth = judged.truth.or(Truth::Undecided(reason));
                }
                judged
            })),
            Quantifier::The => self.quantify_definite(&extension.fits, &extension.undecided, with),
            Quantifier::Exactly(number) => {
                let bounds = CountBounds::of(&mut fitting, with);
                bounds.judged(|low, high| {
                    if low > number || high < number {
                        Some(false)
                    } else {
                        (low == number && high == number).then_some(true)
                    }
                })
            }
            Quantifier::AtLeast(number) => {
                let bounds = CountBounds::of(&mut fitting, with);
                bounds.judged(|low, high| {
                    if high < number {
                        Some(false)
                    } else {
                        (low >= number).then_some(true)
                    }
                })
            }
        }
    }

    /// Evaluates a definite description: false where nothing fits; where several fit, the common truth value, else undecided.
    fn quantify_definite(
        &self,
        fits: &[Term],
        undecided: &[(Term, UndecidedReason)],
        with: &mut dyn FnMut(Term) -> Judged,
    ) -> Judged {
        if fits.is_empty() {
            return match undecided.first() {
                Some((_, reason)) => Judged::undecided(*reason),
                None => Judged::plain(Truth::False),
            };
        }
        let all: Vec<Judged> = fits.iter().map(|term| with(*term)).collect();
        let first = all[0].truth;
        if all.iter().all(|judged| judged.truth == first) {
            return Judged::all(all.into_iter());
        }
        Judged {
            truth: Truth::Undecided(UndecidedReason::SeveralFit),
            witnesses: all
                .into_iter()
                .flat_map(|judged| judged.witnesses)
                .take(8)
                .collect(),
        }
    }
}

/// Bounds on the number of things of which a clause is true.
struct CountBounds {
    low: u32,
    high: u32,
    reason: Option<UndecidedReason>,
    examples: Vec<Judged>,
}

impl CountBounds {
    fn of(
        things: &mut dyn Iterator<Item = (Term, Option<UndecidedReason>)>,
        with: &mut dyn FnMut(Term) -> Judged,
    ) -> Self {
        let mut bounds = Self {
            low: 0,
            high: 0,
            reason: None,
            examples: Vec::new(),
        };
        for (term, undecided) in things {
            let mut judged = with(term);
            if let Some(reason) = undecided {
                judged.truth = judged.truth.and(Truth::Undecided(reason));
            }
            match judged.truth {
                Truth::False => continue,
                Truth::True => bounds.low += 1,
                Truth::Undecided(reason) => bounds.reason = bounds.reason.or(Some(reason)),
            }
            bounds.high += 1;
            bounds.examples.push(judged);
        }
        bounds
    }

    /// Evaluates `decide` on the lower and upper bound; `None` is undecided.
    fn judged(self, decide: impl Fn(u32, u32) -> Option<bool>) -> Judged {
        let reason = self.reason.unwrap_or(UndecidedReason::SeveralFit);
        let decided = decide(self.low, self.high);
        let truth = decided.map_or(Truth::Undecided(reason), Truth::from);
        let witnesses = self
            .examples
            .into_iter()
            .flat_map(|judged| judged.witnesses);
        Judged {
            truth,
            witnesses: witnesses.take(16).collect(),
        }
    }
}
