//! Checking and grounding of sentences in a scene.

use super::{Checker, QuestionAnswer};
use crate::form::{Form, Modifier, Phrase};
use crate::language::{ParseError, PhraseSpan, Sentence};
use crate::predicates;
use crate::scene::Term;
use crate::truth::{Truth, UndecidedReason};
use dwell_scene::interrupt::CancelPoller;
use std::collections::BTreeSet;

/// Things between checks for cancellation.
const THINGS_PER_CHECK: usize = 16;

/// A sentence with its readings, checked.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckedText {
    /// The preferred reading.
    pub form: Form,
    /// The other readings.
    pub others: Vec<Form>,
    /// The verdict on a claim or the answer to a question; `None` for a request.
    pub answer: Option<QuestionAnswer>,
}

/// A noun phrase of a text, grounded: the things that it denotes.
#[derive(Clone, Debug, PartialEq)]
pub struct GroundedPhrase {
    /// The first byte.
    pub start: usize,
    /// The byte after the last.
    pub end: usize,
    /// The thing that it names; for a description all things that it fits, regardless of its quantifier, ascending.
    pub terms: Vec<Term>,
}

impl Checker<'_> {
    /// Reads one sentence with the nouns of the house, and checks or answers its preferred reading.
    ///
    /// # Errors
    /// [`ParseError`] says what was not understood.
    pub fn check_text(&self, text: &str) -> Result<CheckedText, ParseError> {
        let mut readings = self
            .scene
            .semantics
            .language()
            .read(text)?
            .forms
            .into_iter();
        let form = readings.next().ok_or(ParseError::Empty)?;
        let answer = self.answer_form(&form);
        Ok(CheckedText {
            form,
            others: readings.collect(),
            answer,
        })
    }

    /// The verdict on a claim, the answer to a question, or the things of a noun phrase. Of several forms the answer to the last one
    /// that has one; `None` for requests.
    pub(crate) fn answer_form(&self, form: &Form) -> Option<QuestionAnswer> {
        match form {
            Form::Claim(clause) if form.asks_for_parts() => {
                let mut verdict = self.check(clause);
                verdict.truth = Truth::Undecided(UndecidedReason::PartOfThing);
                verdict.witnesses.clear();
                Some(QuestionAnswer::Truth(verdict))
            }
            Form::Question(_) if form.asks_for_parts() => {
                Some(QuestionAnswer::None(UndecidedReason::PartOfThing))
            }
            Form::Claim(clause) => Some(QuestionAnswer::Truth(self.check(clause))),
            Form::Question(question) => Some(self.answer(question)),
            Form::NounPhrase(phrase) => Some(QuestionAnswer::Things(self.denotation(phrase))),
            Form::Request(_) => None,
            Form::Several(forms) => forms.iter().rev().find_map(|form| self.answer_form(form)),
        }
    }

    /// Grounds the noun phrases of a text: finds the things that each denotes in the scene. Of a landmark ("a lamp on a table")
    /// those things count that what it is a landmark of has the relation to.
    pub fn ground(&self, said: &Sentence) -> Vec<GroundedPhrase> {
        self.ground_caption(said, None)
    }

    /// As [`Self::ground`], of a text whose first phrase is about `subject` alone: a caption.
    pub(crate) fn ground_caption(
        &self,
        said: &Sentence,
        subject: Option<Term>,
    ) -> Vec<GroundedPhrase> {
        let mut found: Vec<GroundedPhrase> = Vec::with_capacity(said.phrases.len());
        for (k, span) in said.phrases.iter().enumerate() {
            let mut terms = match subject {
                Some(subject) if k == 0 => vec![subject],
                _ => self.denotation(&span.phrase),
            };
            let mut outer = said.phrases[..k].iter().zip(&found).rev();
            let outer = outer.find(|(other, _)| other.start <= span.start && span.end <= other.end);
            if let Some((PhraseSpan { phrase, .. }, grounded)) = outer {
                self.keep_related(phrase, &grounded.terms, &span.phrase, &mut terms);
            }
            found.push(GroundedPhrase {
                start: span.start,
                end: span.end,
                terms,
            });
        }
        found
    }

    /// The things that a phrase denotes, regardless of its quantifier, ascending.
    pub fn denotation(&self, phrase: &Phrase) -> Vec<Term> {
        match phrase {
            Phrase::Described(description) => self.matching_terms(description),
            Phrase::List(items) => {
                let mut all: Vec<Term> = items
                    .iter()
                    .flat_map(|item| self.denotation(item))
                    .collect();
                all.sort_unstable();
                all.dedup();
                all
            }
            phrase => {
                let named = self.direct_referent(phrase).and_then(Result::ok);
                named.into_iter().collect()
            }
        }
    }

    /// Keeps of `terms`, which `landmark` denotes, those that one of `subjects` has the relation to.
    fn keep_related(
        &self,
        outer: &Phrase,
        subjects: &[Term],
        landmark: &Phrase,
        terms: &mut Vec<Term>,
    ) {
        let Phrase::Described(outer) = outer else {
            return;
        };
        let with = |modifier: &&Modifier| {
            !modifier.negated && modifier.arguments[..] == [landmark.clone()]
        };
        let Some(modifier) = outer.modifiers.iter().find(with) else {
            return;
        };
        let Ok(predicate) = predicates::find(&modifier.predicate) else {
            return;
        };
        // Where the phrase is of no things at all its landmark stands for all that it fits.
        if subjects.is_empty() {
            return;
        }
        let mut poll = CancelPoller::new(THINGS_PER_CHECK);
        if predicate.is_listed() {
            let mut related: BTreeSet<Term> = BTreeSet::new();
            for subject in subjects.iter().filter(|s| predicate.takes(0, s.kind())) {
                poll.count_one();
                related.extend(predicate.related(self.scene, *subject));
            }
            terms.retain(|term| predicate.takes(1, term.kind()) && related.contains(term));
            return;
        }
        let viewer = self.listener.viewer.as_ref();
        terms.retain(|term| {
            let mut holds = subjects.iter().map(|subject| {
                poll.count_one();
                predicate.holds(self.scene, &[*subject, *term], viewer)
            });
            holds.any(Truth::is_true)
        });
    }
}
