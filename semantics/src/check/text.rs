//! Sentences against a scene.

use super::{Answer, Checker};
use crate::form::{Form, Phrase};
use crate::language::{Said, Unread};
use crate::scene::Term;

/// A sentence, read and checked.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckedText {
    /// The preferred reading.
    pub form: Form,
    /// Other readings.
    pub others: Vec<Form>,
    /// The truth value of a claim, the answer to a question; nothing for a request.
    pub answer: Option<Answer>,
}

/// A noun phrase of a text with the things that it means.
#[derive(Clone, Debug, PartialEq)]
pub struct GroundedPhrase {
    /// The first byte.
    pub start: usize,
    /// The byte behind the last.
    pub end: usize,
    /// The things that fit, its quantifier left aside; rising.
    pub terms: Vec<Term>,
}

impl Checker<'_> {
    /// Reads one sentence with the nouns of the house, and checks or answers its preferred reading.
    ///
    /// # Errors
    /// [`Unread`] says what was not understood.
    pub fn check_text(&self, text: &str) -> Result<CheckedText, Unread> {
        let mut readings = self
            .scene
            .semantics
            .language()
            .read(text)?
            .forms
            .into_iter();
        let form = readings.next().ok_or(Unread::Empty)?;
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

    /// The noun phrases of a text with the things that they mean here.
    pub fn ground(&self, said: &Said) -> Vec<GroundedPhrase> {
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
