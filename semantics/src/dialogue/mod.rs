//! Talk about a thing that an ambiguous instruction means: instructions that fit several things, questions about the one that is meant, and
//! an oracle's replies.
//!
//! A question is read as the sentence after the instruction, so that "it" is what the instruction is about. What is meant stands in its
//! form as [`Phrase::Pronoun`]; the reply is the checker's answer with a thing in its place.

mod instruction;
mod pool;
mod reply;

pub use instruction::{AmbiguousInstruction, ambiguous_instructions};
pub use pool::{ClarificationQuestion, question_pool};
pub use reply::Reply;

use crate::check::Checker;
use crate::form::{Form, Phrase};
use crate::language::ParseError;
use crate::scene::Term;

/// What is talked about: an instruction, and the phrase in it that several things fit.
#[derive(Clone, Debug, PartialEq)]
pub struct DialogueTopic {
    /// The instruction.
    pub instruction: Form,
    /// The phrase.
    pub phrase: Phrase,
}

impl DialogueTopic {
    /// Reads a question as the sentence after the instruction, or a claim that is asked about ("it is red"). What is meant stands in it as
    /// [`Phrase::Pronoun`], whether it was "it" or the instruction's phrase.
    ///
    /// # Errors
    /// [`ParseError`] says what was not understood; of a request, a noun phrase and several sentences in one [`ParseError::Empty`].
    pub fn read_question(&self, checker: &Checker<'_>, text: &str) -> Result<Form, ParseError> {
        let language = checker.scene().semantics.language();
        let read = language.read(text)?.forms.into_iter();
        let after = read.flat_map(|form| form.resolve_anaphora(Some(&self.instruction)));
        let mut complete = after.filter(Form::is_free_of_anaphora);
        let form = complete.next().ok_or(ParseError::NoAntecedent)?;
        match form {
            Form::Claim(_) | Form::Question(_) => Ok(form.with_pronoun(&self.phrase)),
            Form::Request(_) | Form::NounPhrase(_) | Form::Several(_) => Err(ParseError::Empty),
        }
    }
}

/// Returns the reply to a question of [`DialogueTopic::read_question`] where `meant` is meant.
pub fn reply(checker: &Checker<'_>, question: &Form, meant: Term) -> Reply {
    let scene = checker.scene();
    let id = meant
        .object()
        .map(|object| scene.house().entity_of_object(object).0)
        .and_then(|id| u32::try_from(id).ok());
    let Some(id) = id else {
        return Reply::undecided();
    };
    let about = question.with_phrase(&Phrase::Pronoun, &Phrase::Id(id));
    match checker.answer_to(&about) {
        Some(answer) => Reply::of(scene, &answer),
        None => Reply::not_understood(),
    }
}
