//! Evaluation of quantified phrases; the first of a clause has the widest scope.

use super::Checker;
use super::witness::{MOST_WITNESSES, WitnessedTruth};
use crate::form::{Description, Phrase, Quantifier};
use crate::scene::Term;
use crate::truth::{Truth, UndecidedReason};
use dwell_scene::interrupt::CancelPoller;

/// Terms that a phrase ranges over between checks for cancellation.
const TERMS_PER_CHECK: usize = 64;

/// A clause as a function of its arguments.
type Body<'a> = &'a dyn Fn(&[Term]) -> WitnessedTruth;

impl Checker<'_> {
    /// Evaluates `body` for the `chosen` terms followed by all that the `arguments` range over.
    pub(super) fn quantify(
        &self,
        arguments: &[Phrase],
        chosen: &mut Vec<Term>,
        body: Body<'_>,
    ) -> WitnessedTruth {
        let Some((first, rest)) = arguments.split_first() else {
            return body(chosen);
        };
        if let Phrase::List(items) = first {
            // A list is decided item by item: each takes its place in turn.
            return WitnessedTruth::all(items.iter().map(|item| {
                let mut arguments = vec![item.clone()];
                arguments.extend_from_slice(rest);
                self.quantify(&arguments, &mut chosen.clone(), body)
            }));
        }
        let mut with = |term: Term| {
            chosen.push(term);
            let judged = self.quantify(rest, chosen, body);
            chosen.pop();
            judged
        };
        match (self.direct_referent(first), first) {
            (Some(Ok(term)), _) => with(term),
            (Some(Err(reason)), _) => WitnessedTruth::undecided(reason),
            (None, Phrase::Described(description)) => {
                self.quantify_description(description, &mut with)
            }
            (None, _) => WitnessedTruth::undecided(UndecidedReason::UnknownTerm),
        }
    }

    fn quantify_description(
        &self,
        description: &Description,
        with: &mut dyn FnMut(Term) -> WitnessedTruth,
    ) -> WitnessedTruth {
        let extension = self.extension(description);
        if let Some(reason) = extension.fault {
            return WitnessedTruth::undecided(reason);
        }
        let mut poll = CancelPoller::new(TERMS_PER_CHECK);
        let with: &mut dyn FnMut(Term) -> WitnessedTruth = &mut |term| {
            poll.count_one();
            with(term)
        };
        // Of a thing that may or may not fit the clause is undecided, except where the result is the same either way.
        let fitting = extension.fits.iter().map(|term| (*term, None));
        let undecided = extension
            .undecided
            .iter()
            .map(|(term, reason)| (*term, Some(*reason)));
        let mut fitting = fitting.chain(undecided);
        match description.quantifier {
            Quantifier::Some => WitnessedTruth::any(fitting.map(|(term, undecided)| {
                let mut judged = with(term);
                if let Some(reason) = undecided {
                    judged.truth = judged.truth.and(Truth::Undecided(reason));
                }
                judged
            })),
            Quantifier::ThePlural
                if extension.fits.is_empty() && extension.undecided.is_empty() =>
            {
                WitnessedTruth::without_witnesses(Truth::False)
            }
            Quantifier::Every | Quantifier::ThePlural => {
                WitnessedTruth::all(fitting.map(|(term, undecided)| {
                    let mut judged = with(term);
                    if let Some(reason) = undecided {
                        judged.truth = judged.truth.or(Truth::Undecided(reason));
                    }
                    judged
                }))
            }
            Quantifier::All(number) => {
                let sure = extension.fits.len();
                let possible = sure + extension.undecided.len();
                let number = number as usize;
                if number < sure || number > possible {
                    return WitnessedTruth::without_witnesses(Truth::False);
                }
                let all = WitnessedTruth::all(fitting.map(|(term, _)| with(term)));
                // Which of them fit is open; where the clause holds of all of them, only their number is.
                match extension.undecided.first() {
                    Some((_, reason)) if sure != possible => WitnessedTruth {
                        truth: Truth::Undecided(*reason),
                        ..all
                    },
                    _ => all,
                }
            }
            Quantifier::No => WitnessedTruth::all(fitting.map(|(term, undecided)| {
                let mut judged = with(term).negated();
                if let Some(reason) = undecided {
                    judged.truth = judged.truth.or(Truth::Undecided(reason));
                }
                judged
            })),
            Quantifier::The => quantify_definite(&extension.fits, &extension.undecided, with),
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
            Quantifier::AtMost(number) => {
                let bounds = CountBounds::of(&mut fitting, with);
                bounds.judged(|low, high| {
                    if low > number {
                        Some(false)
                    } else {
                        (high <= number).then_some(true)
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
}

/// Evaluates a definite description: false where nothing fits; where several fit, the common truth value, else undecided.
fn quantify_definite(
    fits: &[Term],
    undecided: &[(Term, UndecidedReason)],
    with: &mut dyn FnMut(Term) -> WitnessedTruth,
) -> WitnessedTruth {
    // Every way in which what is undecided might turn out: where nothing fits the clause is false, else it is as of what fits.
    let possible = fits.iter().chain(undecided.iter().map(|(term, _)| term));
    let all: Vec<WitnessedTruth> = possible.map(|term| with(*term)).collect();
    let nothing_may_fit = fits.is_empty().then_some(Truth::False);
    let mut values = all.iter().map(|judged| judged.truth).chain(nothing_may_fit);
    let first = values.next().unwrap_or(Truth::False);
    if values.all(|truth| truth == first) {
        return match first {
            Truth::False if all.is_empty() => WitnessedTruth::without_witnesses(first),
            _ => WitnessedTruth::all(all.into_iter()),
        };
    }
    let reason = match undecided.first() {
        Some((_, reason)) => *reason,
        None => UndecidedReason::SeveralFit,
    };
    let witnesses = all.into_iter().flat_map(|judged| judged.witnesses);
    WitnessedTruth {
        truth: Truth::Undecided(reason),
        witnesses: witnesses.take(MOST_WITNESSES).collect(),
    }
}

/// Bounds on the number of things of which a clause is true.
struct CountBounds {
    low: u32,
    high: u32,
    reason: Option<UndecidedReason>,
    examples: Vec<WitnessedTruth>,
}

impl CountBounds {
    fn of(
        things: &mut dyn Iterator<Item = (Term, Option<UndecidedReason>)>,
        with: &mut dyn FnMut(Term) -> WitnessedTruth,
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
    fn judged(self, decide: impl Fn(u32, u32) -> Option<bool>) -> WitnessedTruth {
        let reason = self.reason.unwrap_or(UndecidedReason::SeveralFit);
        let decided = decide(self.low, self.high);
        let truth = decided.map_or(Truth::Undecided(reason), Truth::from);
        let witnesses = self
            .examples
            .into_iter()
            .flat_map(|judged| judged.witnesses);
        WitnessedTruth {
            truth,
            witnesses: witnesses.take(MOST_WITNESSES).collect(),
        }
    }
}
