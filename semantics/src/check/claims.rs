//! Foreign texts: what they claim, sentence by sentence and clause by clause, and whether it is so.

use super::{CheckResult, Checker};
use crate::form::{Clause, Description, Form, Modifier, Noun, Phrase, Quantifier};
use crate::language::{MAX_TEXT_BYTES, ParseError, SentenceError, sentence_places};
use dwell_scene::interrupt;

/// The largest number of parts into which a sentence that is not understood as a whole is cut: each stretch of parts is read.
const MAX_PARTS: usize = 8;
/// Where a sentence that is not understood as a whole is cut.
const CUTS: [&str; 8] = [
    "; ", ", and ", ", while ", ", with ", ", ", " and ", " while ", " with ",
];

/// Of what a text tells.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ClaimScope {
    /// Of the house.
    #[default]
    House,
    /// Of what the listener sees: "there is a lamp" is a claim about a lamp in sight.
    View,
}

/// What became of a claim.
#[derive(Clone, Debug, PartialEq)]
pub enum ClaimVerdict {
    /// It is true, false or undecided.
    Judged {
        /// The verdict within the scope.
        verdict: CheckResult,
        /// Whether it is true of the house, where it is not of what is seen.
        holds_elsewhere: bool,
    },
    /// It was not understood.
    NotUnderstood(ParseError),
    /// It is a request or a question, and claims nothing.
    NoClaim,
}

/// One claim of a foreign text.
#[derive(Clone, Debug, PartialEq)]
pub struct JudgedClaim {
    /// The first byte of the words that say it, or of the sentence where these cannot be told.
    pub start: usize,
    /// The byte after the last.
    pub end: usize,
    /// Its form with antecedents in place of pronouns; `None` where it was not understood.
    pub form: Option<Form>,
    /// What became of it.
    pub verdict: ClaimVerdict,
}

/// A stretch of a text that was read, or not.
type ReadStretch = (usize, usize, Result<Form, ParseError>);

impl Checker<'_> {
    /// Returns each claim of a text of another author with its verdict, in the order of the text. A sentence that is not understood
    /// as a whole is cut at commas and conjunctions, and what is understood of it is judged. "It" stands for the subject of the last
    /// claim that was understood.
    ///
    /// # Errors
    /// [`SentenceError`] of a text that is too long, with the reason.
    pub fn judge_claims(
        &self,
        text: &str,
        scope: ClaimScope,
    ) -> Result<Vec<JudgedClaim>, SentenceError> {
        if text.len() > MAX_FOREIGN_BYTES {
            return Err(SentenceError {
                start: 0,
                sentence: text.chars().take(40).collect(),
                error: ParseError::TooLong {
                    unit: "bytes",
                    found: text.len(),
                    allowed: MAX_FOREIGN_BYTES,
                },
            });
        }
        let mut judged = Vec::new();
        let mut before: Option<Form> = None;
        for (start, end) in sentence_places(text) {
            interrupt::unwind_if_cancelled();
            for (start, end, form) in self.read_parts(text, (start, end), before.as_ref()) {
                match form {
                    Ok(form) => {
                        for (start, end, form) in simple_forms(text, (start, end), &form) {
                            let verdict = self.verdict_on(&form, scope);
                            judged.push(JudgedClaim {
                                start,
                                end,
                                form: Some(form),
                                verdict,
                            });
                        }
                        before = Some(form);
                    }
                    Err(error) => judged.push(JudgedClaim {
                        start,
                        end,
                        form: None,
                        verdict: ClaimVerdict::NotUnderstood(error),
                    }),
                }
            }
        }
        Ok(judged)
    }

    /// The preferred reading of a stretch of a text.
    fn read_stretch(&self, text: &str, before: Option<&Form>) -> Result<Form, ParseError> {
        let language = self.scene.semantics.language();
        let found = language.read(text)?;
        let forms = found.forms.iter();
        let mut forms = forms
            .flat_map(|form| form.resolve_anaphora(before))
            .filter(Form::is_free_of_anaphora);
        forms.next().ok_or(ParseError::NoAntecedent)
    }

    /// The readings of a sentence, of as few parts as are understood.
    fn read_parts(
        &self,
        text: &str,
        (start, end): (usize, usize),
        before: Option<&Form>,
    ) -> Vec<ReadStretch> {
        let whole = self.read_stretch(&text[start..end], before);
        let parts = parts(text, (start, end));
        if whole.is_ok() || parts.len() < 2 {
            return vec![(start, end, whole)];
        }
        let mut found: Vec<ReadStretch> = Vec::new();
        let mut before = before.cloned();
        let mut at = 0;
        while at < parts.len() {
            interrupt::unwind_if_cancelled();
            let first = parts[at].0;
            let stretch = (at..parts.len()).rev().find_map(|last| {
                let end = parts[last].1;
                let form = self.read_stretch(&text[first..end], before.as_ref());
                form.ok().map(|form| (last, end, form))
            });
            if let Some((last, end, form)) = stretch {
                before = Some(form.clone());
                found.push((first, end, Ok(form)));
                at = last + 1;
            } else {
                let (first, end) = parts[at];
                let error = self.read_stretch(&text[first..end], before.as_ref());
                found.push((first, end, error));
                at += 1;
            }
        }
        // Where nothing is understood the sentence is told as a whole.
        if found.iter().all(|(.., read)| read.is_err()) {
            return vec![(start, end, whole)];
        }
        found
    }

    fn verdict_on(&self, form: &Form, scope: ClaimScope) -> ClaimVerdict {
        let clause = match form {
            Form::Claim(clause) => clause.clone(),
            Form::NounPhrase(phrase) => Clause::Exists(phrase.clone()),
            Form::Request(_) | Form::Question(_) | Form::Several(_) => {
                return ClaimVerdict::NoClaim;
            }
        };
        let (scoped, is_changed) = match scope {
            ClaimScope::View if self.listener.viewer.is_some() => {
                let scoped = clause_of_what_is_seen(clause.clone());
                let is_changed = scoped != clause;
                (scoped, is_changed)
            }
            _ => (clause.clone(), false),
        };
        let verdict = self.check(&scoped);
        let holds_elsewhere =
            is_changed && !verdict.truth.is_true() && self.check(&clause).truth.is_true();
        ClaimVerdict::Judged {
            verdict,
            holds_elsewhere,
        }
    }
}

/// Largest length of a foreign text, bytes.
const MAX_FOREIGN_BYTES: usize = 16 * MAX_TEXT_BYTES;

/// The parts of a sentence between commas and conjunctions, at most [`MAX_PARTS`].
fn parts(text: &str, (start, end): (usize, usize)) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    let mut from = start;
    while found.len() + 1 < MAX_PARTS {
        let rest = &text[from..end];
        let cuts = CUTS
            .iter()
            .filter_map(|cut| rest.find(cut).map(|at| (at, cut.len())));
        // Of two that begin at one place the longer one.
        let Some((at, length)) = cuts.min_by_key(|(at, length)| (*at, usize::MAX - length)) else {
            break;
        };
        found.push((from, from + at));
        from += at + length;
    }
    found.push((from, end));
    found.retain(|(first, last)| !text[*first..*last].trim().is_empty());
    found
}

/// The claims of a form, each with its place: conjuncts and the items of lists one by one where the words between commas and
/// conjunctions are as many as these, else all at the place of the sentence.
fn simple_forms(
    text: &str,
    (start, end): (usize, usize),
    form: &Form,
) -> Vec<(usize, usize, Form)> {
    let simple: Vec<Form> = match form {
        Form::Claim(clause) => conjuncts(clause).into_iter().map(Form::Claim).collect(),
        Form::NounPhrase(Phrase::List(items)) => {
            items.iter().cloned().map(Form::NounPhrase).collect()
        }
        Form::Several(forms) => forms.clone(),
        other => vec![other.clone()],
    };
    let places = parts(text, (start, end));
    let each = places.len() == simple.len();
    let placed = simple.into_iter().enumerate().map(|(k, form)| {
        let (start, end) = if each { places[k] } else { (start, end) };
        (start, end, form)
    });
    placed.collect()
}

/// The clauses all of which a clause says.
fn conjuncts(clause: &Clause) -> Vec<Clause> {
    match clause {
        Clause::All(clauses) => clauses.iter().flat_map(conjuncts).collect(),
        Clause::Exists(Phrase::List(items)) => items.iter().cloned().map(Clause::Exists).collect(),
        Clause::Now(inner) => conjuncts(inner)
            .into_iter()
            .map(|own| Clause::Now(Box::new(own)))
            .collect(),
        other => vec![other.clone()],
    }
}

/// A clause about the things that the listener sees alone.
fn clause_of_what_is_seen(clause: Clause) -> Clause {
    let boxed = |inner: Box<Clause>| Box::new(clause_of_what_is_seen(*inner));
    let all = |clauses: Vec<Clause>| clauses.into_iter().map(clause_of_what_is_seen).collect();
    match clause {
        Clause::Holds {
            predicate,
            arguments,
        } => Clause::Holds {
            predicate,
            arguments: arguments.into_iter().map(seen_phrase).collect(),
        },
        Clause::Is { subject, quality } => Clause::Is {
            subject: seen_phrase(subject),
            quality,
        },
        Clause::Exists(what) => Clause::Exists(seen_phrase(what)),
        Clause::More { more, than } => Clause::More {
            more: Box::new(seen_description(*more)),
            than: Box::new(seen_description(*than)),
        },
        Clause::Distance {
            subject,
            from,
            metres,
        } => Clause::Distance {
            subject: seen_phrase(subject),
            from: seen_phrase(from),
            metres,
        },
        Clause::Area { .. } | Clause::HasSurfaces { .. } => clause,
        Clause::Now(inner) => Clause::Now(boxed(inner)),
        Clause::Not(inner) => Clause::Not(boxed(inner)),
        Clause::All(clauses) => Clause::All(all(clauses)),
        Clause::Any(clauses) => Clause::Any(all(clauses)),
    }
}

fn seen_phrase(phrase: Phrase) -> Phrase {
    match phrase {
        Phrase::Described(own) => seen_description(*own).into(),
        Phrase::List(items) => Phrase::List(items.into_iter().map(seen_phrase).collect()),
        other => other,
    }
}

/// A description of what is in sight: of things those that the listener sees, of pieces of the building those of the room that it is
/// in, and of rooms that it sees the one that it is in.
fn seen_description(mut description: Description) -> Description {
    let seen = Modifier::new("visible", []);
    let own_room = || {
        let room = Noun::Room(Noun::ANY_ROOM.to_owned());
        Phrase::from(Description::new(Quantifier::The, room))
    };
    let is_seen = description.modifiers.contains(&seen);
    let has_room = |own: &Description| own.modifiers.iter().any(|one| one.predicate == "in_room");
    match description.noun {
        Noun::Object(_) if !is_seen => description.with_modifier(seen),
        Noun::Structure(_) => {
            description.modifiers.retain(|own| *own != seen);
            if has_room(&description) {
                return description;
            }
            description.with_modifier(Modifier::new("in_room", [own_room()]))
        }
        Noun::Room(_) if is_seen => {
            description.modifiers.retain(|own| *own != seen);
            description.with_modifier(Modifier::new(Modifier::IDENTICAL, [own_room()]))
        }
        _ => description,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sentences_are_cut_at_commas_and_conjunctions() {
        let text = "A cat sleeps, and there is a bed with a lamp.";
        let found = parts(text, (0, text.len()));
        let words: Vec<&str> = found.iter().map(|(p, q)| &text[*p..*q]).collect();
        assert_eq!(words, ["A cat sleeps", "there is a bed", "a lamp."]);
        let long = "a, ".repeat(50);
        assert_eq!(parts(&long, (0, long.len())).len(), MAX_PARTS);
    }
}
