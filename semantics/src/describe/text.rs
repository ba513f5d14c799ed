//! Texts made of forms: what is said, where it is said, and of which things.

use crate::check::{Checker, GroundedPhrase};
use crate::form::{Clause, Description, Form, Modifier, Noun, Phrase, Quantifier};
use crate::scene::Term;
use dwell_scene::interrupt;
use dwell_scene::random::RandomKey;

/// Largest number of items in one sentence.
const MAX_ITEMS: usize = 6;

/// A claim of a text.
#[derive(Clone, Debug, PartialEq)]
pub struct TextClaim {
    /// The first byte.
    pub start: usize,
    /// The byte after the last.
    pub end: usize,
    /// Its form, with antecedents in place of pronouns.
    pub form: Form,
    /// The things that it is about, ascending.
    pub terms: Vec<Term>,
}

/// A text with its meaning and the things that it is about.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GroundedText {
    /// The text.
    pub text: String,
    /// The noun phrases with the things that they denote, from left to right, the outer before the inner.
    pub phrases: Vec<GroundedPhrase>,
    /// What the text says, sentence by sentence.
    pub claims: Vec<TextClaim>,
}

/// The claim that a predicate holds of its arguments.
pub(super) fn claim(predicate: &str, arguments: Vec<Phrase>) -> Form {
    Form::Claim(Clause::Holds {
        predicate: predicate.to_owned(),
        arguments,
    })
}

/// A writer of a text: says forms one after the other.
pub(super) struct TextWriter<'a> {
    checker: &'a Checker<'a>,
    /// Draws the wordings; `None` for the first ones.
    wording: Option<RandomKey>,
    written: GroundedText,
    antecedent: Option<Phrase>,
}

impl<'a> TextWriter<'a> {
    pub(super) fn new(checker: &'a Checker<'a>, wording: Option<RandomKey>) -> Self {
        Self {
            checker,
            wording,
            written: GroundedText::default(),
            antecedent: None,
        }
    }

    /// Says that there are `items` with common modifiers, in sentences of at most [`MAX_ITEMS`]; nothing where there are none.
    pub(super) fn there_are(&mut self, items: &[Description], place: &[Modifier]) {
        for items in items.chunks(MAX_ITEMS) {
            self.say_list(items.to_vec(), place);
        }
    }

    fn say_list(&mut self, items: Vec<Description>, place: &[Modifier]) {
        let placed = items.into_iter().map(|mut item| {
            item.modifiers.extend_from_slice(place);
            Phrase::from(item)
        });
        let mut placed: Vec<Phrase> = placed.collect();
        let what = match placed.len() {
            1 => placed.remove(0),
            _ => Phrase::List(placed),
        };
        self.say(Form::Claim(Clause::Exists(what)));
    }

    /// Says a form. A form that the language has no words for is left out.
    pub(super) fn say(&mut self, form: Form) {
        self.write(form, None);
    }

    /// Says a noun phrase that is about one thing.
    pub(super) fn say_phrase_about(&mut self, phrase: Phrase, subject: Term) {
        self.write(Form::NounPhrase(phrase), Some(subject));
    }

    fn write(&mut self, form: Form, subject: Option<Term>) {
        interrupt::unwind_if_cancelled();
        let language = self.checker.scene().semantics.language();
        let number = self.written.claims.len() as u64;
        let key = self.wording.map(|key| key.child(number));
        let pronoun = self
            .antecedent
            .as_ref()
            .filter(|own| can_be_pronoun(own, &form));
        let short = pronoun.map(|antecedent| form.with_pronoun(antecedent));
        let said = short.and_then(|short| language.say(&short, key));
        let Some(mut said) = said.or_else(|| language.say(&form, key)) else {
            debug_assert!(false, "no words for {form:?}");
            return;
        };
        if let Some(antecedent) = &self.antecedent {
            // Also within others: the pillows of "on it there are two pillows" are those on it.
            for span in &mut said.phrases {
                let whole = Form::NounPhrase(span.phrase.clone());
                let whole = whole.with_phrase(&Phrase::Pronoun, antecedent);
                if let Form::NounPhrase(phrase) = whole {
                    span.phrase = phrase;
                }
            }
        }
        if !self.written.text.is_empty() && !self.written.text.ends_with('\n') {
            self.written.text.push(' ');
        }
        let start = self.written.text.len();
        self.written.text.push_str(&said.text);
        let mut terms = Vec::new();
        for phrase in self.checker.ground_caption(&said, subject) {
            terms.extend_from_slice(&phrase.terms);
            self.written.phrases.push(GroundedPhrase {
                start: start + phrase.start,
                end: start + phrase.end,
                terms: phrase.terms,
            });
        }
        terms.sort_unstable();
        terms.dedup();
        self.antecedent = form
            .pronoun_antecedent()
            .filter(|_| !has_other_antecedent(&form))
            .cloned();
        self.written.claims.push(TextClaim {
            start,
            end: self.written.text.len(),
            form,
            terms,
        });
    }

    /// Ends a paragraph: no pronoun reaches beyond it.
    pub(super) fn end_paragraph(&mut self) {
        self.antecedent = None;
        if !self.written.text.is_empty() {
            self.written.text.push('\n');
        }
    }

    pub(super) fn finish(mut self) -> GroundedText {
        let length = self.written.text.trim_end().len();
        self.written.text.truncate(length);
        self.written
    }
}

/// Returns whether a form names something else that a reader may take for "it": in "there is a towel in the dresser" and "in the dresser
/// there are two books and a towel" the towel.
fn has_other_antecedent(form: &Form) -> bool {
    let Form::Claim(Clause::Exists(what)) = form else {
        return false;
    };
    let is_one = |item: &Phrase| matches!(item, Phrase::Described(own) if own.quantifier == Quantifier::Some);
    match what {
        Phrase::List(items) => items.iter().any(is_one),
        _ => true,
    }
}

/// Returns whether "it" may stand for `antecedent` in `form`: as its subject, or as the landmark of a list.
fn can_be_pronoun(antecedent: &Phrase, form: &Form) -> bool {
    let is_room = matches!(
        antecedent,
        Phrase::Described(own) if matches!(own.noun, Noun::Room(_))
    );
    let exists = matches!(form, Form::Claim(Clause::Exists(_)));
    form.pronoun_antecedent() == Some(antecedent) && !(is_room && exists)
}
