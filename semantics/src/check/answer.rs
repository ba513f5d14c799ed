//! Answers to questions.

use super::{CheckResult, Checker};
use crate::form::{AttributeKind, Question};
use crate::predicates;
use crate::scene::Term;
use crate::truth::{Truth, UndecidedReason};

/// The answer to a question.
#[derive(Clone, Debug, PartialEq)]
pub enum QuestionAnswer {
    /// The verdict on a question for a truth value.
    Truth(CheckResult),
    /// The things of which the clause is true, ascending; may be empty.
    Things(Vec<Term>),
    /// The number of things that fit.
    Number(usize),
    /// Words: colours, the adjective of a substance.
    Words(Vec<String>),
    /// The numbers of the clauses of [`Question::Alternatives`] that are true, from 0, ascending; may be empty.
    Alternatives(Vec<usize>),
    /// No answer, with the reason.
    None(UndecidedReason),
}

impl Checker<'_> {
    /// The answer to a question.
    pub fn answer(&self, question: &Question) -> QuestionAnswer {
        match question {
            Question::Whether(clause) => QuestionAnswer::Truth(self.check(clause)),
            Question::Alternatives(clauses) => {
                let verdicts: Vec<Truth> =
                    clauses.iter().map(|one| self.judge(one).truth).collect();
                let fits = verdicts
                    .iter()
                    .enumerate()
                    .filter(|(_, truth)| truth.is_true());
                let fits: Vec<usize> = fits.map(|(k, _)| k).collect();
                let undecided = verdicts.iter().find_map(|truth| match truth {
                    Truth::Undecided(reason) => Some(*reason),
                    Truth::True | Truth::False => None,
                });
                match undecided {
                    Some(reason) if fits.is_empty() => QuestionAnswer::None(reason),
                    _ => QuestionAnswer::Alternatives(fits),
                }
            }
            Question::HowMany(what) => {
                let extension = self.extension(what);
                let undecided = extension.undecided.first().map(|(_, reason)| *reason);
                match extension.fault.or(undecided) {
                    Some(reason) => QuestionAnswer::None(reason),
                    None => QuestionAnswer::Number(extension.fits.len()),
                }
            }
            Question::Which { kind, clause } => {
                // "What is on the table?" of several tables has no answer unless something is on all of them.
                let mut open = None;
                let candidates = match kind {
                    Some(kind) => {
                        let extension = self.extension(kind);
                        let undecided = extension.undecided.first().map(|(_, reason)| *reason);
                        open = extension.fault.or(undecided);
                        extension.fits.clone()
                    }
                    None => self.scene.house().objects.ids().map(Term::Object).collect(),
                };
                let fits = |term: &Term| {
                    self.hole.set(Some(*term));
                    let truth = self.judge(clause).truth;
                    if let Truth::Undecided(
                        reason @ (UndecidedReason::SeveralFit
                        | UndecidedReason::NoViewer
                        | UndecidedReason::NoListener),
                    ) = truth
                    {
                        open.get_or_insert(reason);
                    }
                    truth.is_true()
                };
                let things: Vec<Term> = candidates.into_iter().filter(fits).collect();
                self.hole.set(None);
                match open {
                    Some(reason) if things.is_empty() => QuestionAnswer::None(reason),
                    _ => QuestionAnswer::Things(things),
                }
            }
            Question::HowFar { subject, from } => match self.distance_between(subject, from) {
                Ok(metres) => QuestionAnswer::Number(metres as usize),
                Err(reason) => QuestionAnswer::None(reason),
            },
            Question::Attribute { kind, of } => match self.unique_referent(of) {
                Ok(term) => self.attribute(*kind, term),
                Err(reason) => QuestionAnswer::None(reason),
            },
        }
    }

    fn attribute(&self, kind: AttributeKind, term: Term) -> QuestionAnswer {
        let Some(object) = term.object() else {
            return QuestionAnswer::None(UndecidedReason::WrongKind);
        };
        let facts = self.scene.facts(object);
        match kind {
            AttributeKind::Color => {
                let words = facts.spoken_colors().iter();
                let words: Vec<String> = words.map(|(word, _)| (*word).to_owned()).collect();
                if words.is_empty() {
                    return QuestionAnswer::None(UndecidedReason::NoColor);
                }
                QuestionAnswer::Words(words)
            }
            AttributeKind::Material => facts.substances.first().map_or(
                QuestionAnswer::None(UndecidedReason::NoMaterial),
                |(substance, _)| QuestionAnswer::Words(vec![substance.adjective.clone()]),
            ),
            AttributeKind::Room => {
                let room = self.scene.room_of(object).map(Term::Room);
                QuestionAnswer::Things(room.into_iter().collect())
            }
            AttributeKind::Place => {
                let places = ["in", "on", "hangs_on", "next_to"].iter().find_map(|name| {
                    let predicate = predicates::find(name).ok()?;
                    let related = predicate.related(self.scene, term);
                    (!related.is_empty()).then_some(related)
                });
                QuestionAnswer::Things(places.unwrap_or_default())
            }
        }
    }
}

impl QuestionAnswer {
    /// Returns whether there is an answer that is not undecided.
    pub fn is_decided(&self) -> bool {
        match self {
            Self::None(_) => false,
            Self::Truth(verdict) => !matches!(verdict.truth, Truth::Undecided(_)),
            Self::Things(_) | Self::Number(_) | Self::Words(_) | Self::Alternatives(_) => true,
        }
    }
}
