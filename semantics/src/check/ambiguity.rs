//! Definite noun phrases that several things fit, and questions that tell these apart.

use super::Checker;
use crate::form::{Description, Form, Noun, Phrase, Quantifier};
use crate::refer::{refer, refer_to_room};
use crate::scene::Term;

/// Largest number of things that a question names one by one.
const MAX_NAMED: usize = 4;

/// A definite noun phrase that several things fit: "the chair" where there are two.
#[derive(Clone, Debug, PartialEq)]
pub struct AmbiguousPhrase {
    /// The phrase.
    pub phrase: Phrase,
    /// The things that it fits, ascending; at least two.
    pub terms: Vec<Term>,
    /// The question which of them is meant: "Which chair do you mean, the red chair or the chair next to the bed?" Their number
    /// instead where there are more than four, or no words tell them apart. `None` where the language has no words for it.
    pub question: Option<String>,
}

impl Checker<'_> {
    /// Returns the definite noun phrases of a form that several things fit, in the order of the text, each once.
    pub fn ambiguities(&self, form: &Form) -> Vec<AmbiguousPhrase> {
        let mut found: Vec<AmbiguousPhrase> = Vec::new();
        for phrase in form.phrases() {
            let Phrase::Described(own) = &phrase else {
                continue;
            };
            if own.quantifier != Quantifier::The
                || own.selection.is_some()
                || found.iter().any(|known| known.phrase == phrase)
            {
                continue;
            }
            let terms = self.matching_terms(own);
            if terms.len() > 1 {
                let question = self.which_is_meant(own, &terms);
                found.push(AmbiguousPhrase {
                    phrase,
                    terms,
                    question,
                });
            }
        }
        found
    }

    fn which_is_meant(&self, what: &Description, terms: &[Term]) -> Option<String> {
        let language = self.scene.semantics.language();
        let kind = Description::new(Quantifier::The, what.noun.clone());
        let described = |term: &Term| match term {
            Term::Object(object) => refer(self.scene, *object),
            Term::Room(room) => refer_to_room(self.scene, *room),
            _ => None,
        };
        let named = terms.iter().map(|term| described(term).map(Phrase::from));
        let named: Option<Vec<Phrase>> = named.collect();
        let is_object = matches!(what.noun, Noun::Object(_));
        match named {
            Some(named) if is_object && named.len() <= MAX_NAMED => {
                language.ask_which(&kind, &named)
            }
            _ => language.ask_which_of(&kind, terms.len()),
        }
    }
}
