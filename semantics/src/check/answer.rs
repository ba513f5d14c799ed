//! Answers to questions.

use super::{CheckResult, Checker};
use crate::form::{AttributeKind, Clause, Noun, Phrase, Question};
use crate::scene::Term;
use crate::truth::{Truth, UndecidedReason};

/// The answer to a question.
#[derive(Clone, Debug, PartialEq)]
pub enum Answer {
    /// The verdict on a question for a truth value.
    Truth(CheckResult),
    /// The things of which the clause is true, ascending; may be empty.
    Things(Vec<Term>),
    /// The number of things that fit.
    Number(usize),
    /// Words: colours, the adjective of a substance.
    Words(Vec<String>),
    /// No answer, with the reason.
    None(UndecidedReason),
}

impl Checker<'_> {
    /// The answer to a question.
    pub fn answer(&self, question: &Question) -> Answer {
        match question {
            Question::Whether(clause) => Answer::Truth(self.check(clause)),
            Question::HowMany(what) => {
                let extension = self.extension(what);
                let undecided = extension.undecided.first().map(|(_, reason)| *reason);
                match extension.fault.or(undecided) {
                    Some(reason) => Answer::None(reason),
                    None => Answer::Number(extension.fits.len()),
                }
            }
            Question::Which { kind, clause } => {
                let candidates = match kind {
                    Some(kind) => self.extension(kind).fits.clone(),
                    None => self.scene.house().objects.ids().map(Term::Object).collect(),
                };
                let fits = |term: &Term| {
                    let filled = filled(clause, self.id_of(*term));
                    self.judge(&filled).truth.is_true()
                };
                Answer::Things(candidates.into_iter().filter(fits).collect())
            }
            Question::Attribute { kind, of } => match self.only_object(of) {
                Ok(term) => self.attribute(*kind, term),
                Err(reason) => Answer::None(reason),
            },
        }
    }

    fn only_object(&self, of: &Phrase) -> Result<Term, UndecidedReason> {
        if let Some(named) = self.named(of) {
            return named;
        }
        let Phrase::Described(description) = of else {
            return Err(UndecidedReason::UnknownTerm);
        };
        if matches!(description.noun, Noun::Room(_)) {
            return Err(UndecidedReason::WrongKind);
        }
        let extension = self.extension(description);
        match (extension.fault, &extension.fits[..]) {
            (Some(reason), _) => Err(reason),
            (None, [only]) => Ok(*only),
            (None, []) => Err(UndecidedReason::UnknownTerm),
            (None, _) => Err(UndecidedReason::SeveralFit),
        }
    }

    fn id_of(&self, term: Term) -> Phrase {
        let house = self.scene.house();
        let id = match term {
            Term::Object(object) => house.entity_of_object(object).0,
            _ => 0,
        };
        Phrase::Id(id as u32)
    }

    fn attribute(&self, kind: AttributeKind, term: Term) -> Answer {
        let Some(object) = term.object() else {
            return Answer::None(UndecidedReason::WrongKind);
        };
        let facts = self.scene.facts(object);
        match kind {
            AttributeKind::Color => {
                let words = facts.spoken_colors().iter();
                let words: Vec<String> = words.map(|(word, _)| (*word).to_owned()).collect();
                if words.is_empty() {
                    return Answer::None(UndecidedReason::NoColor);
                }
                Answer::Words(words)
            }
            AttributeKind::Material => facts.substances.first().map_or(
                Answer::None(UndecidedReason::NoMaterial),
                |(substance, _)| Answer::Words(vec![substance.adjective.clone()]),
            ),
            AttributeKind::Room => {
                let room = self.scene.room_of(object).map(Term::Room);
                Answer::Things(room.into_iter().collect())
            }
            AttributeKind::Place => {
                let places = ["in", "on", "hangs_on", "next_to"].iter().find_map(|name| {
                    let predicate = crate::predicates::find(name).ok()?;
                    let related = predicate.related(self.scene, term);
                    (!related.is_empty()).then_some(related)
                });
                Answer::Things(places.unwrap_or_default())
            }
        }
    }
}

/// Returns the clause with a phrase in place of its hole.
fn filled(clause: &Clause, with: Phrase) -> Clause {
    let fill = |phrase: &Phrase| match phrase {
        Phrase::Hole => with.clone(),
        phrase => phrase.clone(),
    };
    match clause {
        Clause::Holds {
            predicate,
            arguments,
        } => Clause::Holds {
            predicate: predicate.clone(),
            arguments: arguments.iter().map(fill).collect(),
        },
        Clause::Is { subject, quality } => Clause::Is {
            subject: fill(subject),
            quality: quality.clone(),
        },
        Clause::Exists(what) => Clause::Exists(fill(what)),
        Clause::Not(inner) => Clause::Not(Box::new(filled(inner, with))),
        Clause::All(all) => Clause::All(all.iter().map(|one| filled(one, with.clone())).collect()),
        Clause::Any(all) => Clause::Any(all.iter().map(|one| filled(one, with.clone())).collect()),
    }
}

impl Answer {
    /// Returns whether there is an answer that is not undecided.
    pub fn is_decided(&self) -> bool {
        match self {
            Self::None(_) => false,
            Self::Truth(verdict) => !matches!(verdict.truth, Truth::Undecided(_)),
            Self::Things(_) | Self::Number(_) | Self::Words(_) => true,
        }
    }
}
