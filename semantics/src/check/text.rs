//! Checking and grounding of sentences in a scene.

use super::{Answer, Checker};
use crate::form::{Form, Phrase};
use crate::language::{ReadError, Sentence};
use crate::scene::Term;

/// A sentence with its readings, checked.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckedText {
    /// The preferred reading.
    pub form: Form,
    /// The other readings.
    pub others: Vec<Form>,
    /// The verdict on a claim or the answer to a question; `None` for a request.
    pub answer: Option<Answer>,
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
    /// [`ReadError`] says what was not understood.
    pub fn check_text(&self, text: &str) -> Result<CheckedText, ReadError> {
        let mut readings = self
            .scene
            .semantics
            .language()
            .read(text)?
            .forms
            .into_iter();
        let form = readings.next().ok_or(ReadError::Empty)?;
        let answer = match &form {
            Form::Claim(clause) => Some(Answer::Truth(self.check(clause))),
            Form::Question(question) => Some(self.answer(question)),
            Form::Request(_) => None,
        };
        Ok(CheckedText {
            form,
            others: readings.collect(),
            answer,
        })
    }

    /// Grounds the noun phrases of a text: finds the things that each denotes in the scene.
    pub fn ground(&self, said: &Sentence) -> Vec<GroundedPhrase> {
        let phrases = said.phrases.iter();
        phrases
            .map(|span| GroundedPhrase {
                start: span.start,
                end: span.end,
                terms: match &span.phrase {
                    Phrase::Described(description) => self.fitting(description),
                    phrase => self
                        .named(phrase)
                        .and_then(Result::ok)
                        .into_iter()
                        .collect(),
                },
            })
            .collect()
    }
}
