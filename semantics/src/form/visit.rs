//! Visits of the phrases of a form, in the order of the text.

use super::{Clause, Description, Form, Modifier, Noun, Phrase, Question, RequestStep};

/// The role of a phrase.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum PhraseRole {
    /// What a clause or a step is about: a subject, an object, a thing that is compared.
    Topic,
    /// What others stand in relation to: the table of "on the table".
    Landmark,
}

/// A call for each phrase with its role, the outer before the inner.
pub(super) type PhraseVisitor<'a> = &'a mut dyn FnMut(&mut Phrase, PhraseRole);

/// Predicates that compare two things of which none is the landmark of the other.
const COMPARISONS: [&str; 8] = [
    "closer_to",
    "larger_than",
    "taller_than",
    "wider_than",
    "same_color",
    "same_material",
    "same_kind",
    "identical",
];

impl Form {
    /// Returns its noun phrases in the order of the text, the outer before the inner.
    pub fn phrases(&self) -> Vec<Phrase> {
        let mut found = Vec::new();
        visit_form(&mut self.clone(), &mut |phrase, _| {
            found.push(phrase.clone());
        });
        found
    }

    /// Returns the numbers of modifiers of what its clauses relate their subjects to, and of all its phrases.
    pub(crate) fn modifier_counts(&self) -> (usize, usize) {
        let of_landmarks = match self {
            Self::Claim(clause)
            | Self::Question(Question::Whether(clause) | Question::Which { clause, .. }) => {
                landmark_modifiers(clause)
            }
            Self::Question(Question::Alternatives(clauses)) => {
                clauses.iter().map(landmark_modifiers).sum()
            }
            _ => 0,
        };
        let mut all = 0;
        visit_form(&mut self.clone(), &mut |phrase, _| {
            if let Phrase::Described(own) = phrase {
                all += own.modifiers.len();
            }
        });
        (of_landmarks, all)
    }

    /// Returns the number of places (on the left, at the end of the room) that it says of a thing after a landmark of the same thing,
    /// though they could be the landmark's.
    pub(crate) fn stray_place_count(&self) -> usize {
        const PLACES: [&str; 3] = ["on_left", "on_right", "at_end_of"];
        let is_landmark = |phrase: &Phrase| matches!(phrase, Phrase::Described(own) if matches!(own.noun, Noun::Object(_)));
        let is_stray = |pair: &[Modifier]| {
            PLACES.contains(&pair[1].predicate.as_str())
                && pair[0].arguments.last().is_some_and(is_landmark)
        };
        let mut number = 0;
        visit_form(&mut self.clone(), &mut |phrase, _| {
            if let Phrase::Described(own) = phrase {
                number += own
                    .modifiers
                    .windows(2)
                    .filter(|pair| is_stray(pair))
                    .count();
            }
        });
        number
    }

    /// Returns the number of its descriptions with a comparison: "the cabinet larger than the table".
    pub(crate) fn comparison_count(&self) -> usize {
        let mut number = 0;
        visit_form(&mut self.clone(), &mut |phrase, _| {
            if let Phrase::Described(own) = phrase {
                let compares = |added: &&Modifier| COMPARISONS.contains(&added.predicate.as_str());
                number += own.modifiers.iter().filter(compares).count();
            }
        });
        number
    }
}

/// A predicate with its arguments, from a clause or a modifier.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Relation {
    pub(crate) predicate: String,
    /// All arguments, the subject first.
    pub(crate) arguments: Vec<Phrase>,
}

impl Form {
    /// Returns the relations that it is about: of its clauses, and of the modifiers of its phrases to what they describe.
    pub(crate) fn relations(&self) -> Vec<Relation> {
        let mut found = Vec::new();
        add_clause_relations(self, &mut found);
        for phrase in self.phrases() {
            let Phrase::Described(own) = &phrase else {
                continue;
            };
            for modifier in &own.modifiers {
                let mut arguments = vec![phrase.clone()];
                arguments.extend(modifier.arguments.iter().cloned());
                found.push(Relation {
                    predicate: modifier.predicate.clone(),
                    arguments,
                });
            }
        }
        found
    }
}

fn add_clause_relations(form: &Form, found: &mut Vec<Relation>) {
    let mut open: Vec<&Clause> = Vec::new();
    match form {
        Form::Claim(clause)
        | Form::Question(Question::Whether(clause) | Question::Which { clause, .. }) => {
            open.push(clause);
        }
        Form::Question(Question::Alternatives(clauses)) => open.extend(clauses),
        Form::Several(forms) => {
            for form in forms {
                add_clause_relations(form, found);
            }
        }
        Form::Request(_) | Form::Question(_) | Form::NounPhrase(_) => {}
    }
    while let Some(clause) = open.pop() {
        match clause {
            Clause::Holds {
                predicate,
                arguments,
            } => found.push(Relation {
                predicate: predicate.clone(),
                arguments: arguments.clone(),
            }),
            Clause::Now(inner) | Clause::Not(inner) => open.push(inner),
            Clause::All(clauses) | Clause::Any(clauses) => open.extend(clauses),
            _ => {}
        }
    }
}

fn landmark_modifiers(clause: &Clause) -> usize {
    match clause {
        Clause::Holds { arguments, .. } => {
            let landmarks = arguments.iter().skip(1);
            let modifiers = landmarks.map(|landmark| match landmark {
                Phrase::Described(own) => own.modifiers.len(),
                _ => 0,
            });
            modifiers.sum()
        }
        Clause::Now(inner) | Clause::Not(inner) => landmark_modifiers(inner),
        Clause::All(clauses) | Clause::Any(clauses) => clauses.iter().map(landmark_modifiers).sum(),
        _ => 0,
    }
}

pub(super) fn visit_form(form: &mut Form, visit: PhraseVisitor<'_>) {
    match form {
        Form::Claim(clause) => visit_clause(clause, visit),
        Form::Request(steps) => {
            for step in steps {
                visit_step(step, visit);
            }
        }
        Form::Question(question) => visit_question(question, visit),
        Form::NounPhrase(phrase) => visit_phrase(phrase, PhraseRole::Topic, visit),
        Form::Several(forms) => {
            for form in forms {
                visit_form(form, visit);
            }
        }
    }
}

fn visit_question(question: &mut Question, visit: PhraseVisitor<'_>) {
    match question {
        Question::Whether(clause) => visit_clause(clause, visit),
        Question::Alternatives(clauses) => {
            for clause in clauses {
                visit_clause(clause, visit);
            }
        }
        Question::Which { kind, clause } => {
            if let Some(kind) = kind {
                visit_description(kind, visit);
            }
            visit_clause(clause, visit);
        }
        Question::HowMany(what) => visit_description(what, visit),
        Question::HowFar { subject, from } => {
            visit_phrase(subject, PhraseRole::Topic, visit);
            visit_phrase(from, PhraseRole::Landmark, visit);
        }
        Question::Attribute { of, .. } => visit_phrase(of, PhraseRole::Topic, visit),
    }
}

pub(super) fn visit_clause(clause: &mut Clause, visit: PhraseVisitor<'_>) {
    match clause {
        Clause::Holds {
            predicate,
            arguments,
        } => {
            let is_comparison = COMPARISONS.contains(&predicate.as_str());
            for (k, phrase) in arguments.iter_mut().enumerate() {
                let role = if k == 0 || is_comparison {
                    PhraseRole::Topic
                } else {
                    PhraseRole::Landmark
                };
                visit_phrase(phrase, role, visit);
            }
        }
        Clause::Is {
            subject: phrase, ..
        }
        | Clause::Exists(phrase)
        | Clause::Area { room: phrase, .. }
        | Clause::HasSurfaces { room: phrase, .. } => {
            visit_phrase(phrase, PhraseRole::Topic, visit);
        }
        Clause::Distance { subject, from, .. } => {
            visit_phrase(subject, PhraseRole::Topic, visit);
            visit_phrase(from, PhraseRole::Landmark, visit);
        }
        Clause::More { more, than } => {
            visit_description(more, visit);
            visit_description(than, visit);
        }
        Clause::Now(inner) | Clause::Not(inner) => visit_clause(inner, visit),
        Clause::All(clauses) | Clause::Any(clauses) => {
            for clause in clauses {
                visit_clause(clause, visit);
            }
        }
    }
}

pub(super) fn visit_step(step: &mut RequestStep, visit: PhraseVisitor<'_>) {
    match step {
        RequestStep::Turn(_) => {}
        RequestStep::GoTo(phrase)
        | RequestStep::Leave(phrase)
        | RequestStep::Do { object: phrase, .. }
        | RequestStep::DoNot { object: phrase, .. } => {
            visit_phrase(phrase, PhraseRole::Topic, visit);
        }
        RequestStep::Put { object, to, .. } | RequestStep::Bring { object, to } => {
            visit_phrase(object, PhraseRole::Topic, visit);
            visit_phrase(to, PhraseRole::Landmark, visit);
        }
        RequestStep::If {
            condition,
            then,
            otherwise,
        } => {
            visit_clause(condition, visit);
            for step in then.iter_mut().chain(otherwise) {
                visit_step(step, visit);
            }
        }
    }
}

/// Visits a description that is no phrase of its own.
fn visit_description(description: &mut Box<Description>, visit: PhraseVisitor<'_>) {
    let mut phrase = Phrase::Described(description.clone());
    visit_phrase(&mut phrase, PhraseRole::Topic, visit);
    if let Phrase::Described(visited) = phrase {
        *description = visited;
    }
}

fn visit_modifiers(modifiers: &mut [Modifier], visit: PhraseVisitor<'_>) {
    for modifier in modifiers {
        for phrase in &mut modifier.arguments {
            visit_phrase(phrase, PhraseRole::Landmark, visit);
        }
    }
}

pub(super) fn visit_phrase(phrase: &mut Phrase, role: PhraseRole, visit: PhraseVisitor<'_>) {
    visit(phrase, role);
    match phrase {
        Phrase::Described(description) => {
            let reference = description.selection.as_mut();
            if let Some(reference) = reference.and_then(|place| place.reference.as_deref_mut()) {
                visit_phrase(reference, PhraseRole::Landmark, visit);
            }
            visit_modifiers(&mut description.modifiers, visit);
        }
        Phrase::List(items) => {
            for item in items {
                visit_phrase(item, role, visit);
            }
        }
        Phrase::Id(_)
        | Phrase::Listener
        | Phrase::Speaker
        | Phrase::EachOther
        | Phrase::Storey(_)
        | Phrase::Hole
        | Phrase::NamedBefore
        | Phrase::Pronoun => {}
    }
}
