//! Pronouns and their antecedents.

use super::{Clause, Form, Modifier, Phrase, Question, Request, RequestStep};

impl Form {
    /// The phrase that "it" in the next sentence stands for: the subject of a claim, where that is one thing. `None` where a
    /// pronoun would have no antecedent, or more than one.
    pub fn subject(&self) -> Option<&Phrase> {
        let Self::Claim(clause) = self else {
            return None;
        };
        let subject = match clause {
            Clause::Holds { arguments, .. } => arguments.first()?,
            Clause::Is { subject, .. } => subject,
            Clause::Area { room, .. } | Clause::HasSurfaces { room, .. } => room,
            Clause::Exists(what) => Self::shared_landmark(what)?,
            Clause::Not(_) | Clause::All(_) | Clause::Any(_) => return None,
        };
        is_singular(subject).then_some(subject)
    }

    /// The landmark that all of a list stand in the same relation to: the table of "on the table there are a cup and a plate".
    fn shared_landmark<'a>(what: &'a Phrase) -> Option<&'a Phrase> {
        let landmark = |phrase: &'a Phrase| match phrase {
            Phrase::Described(description) => description.modifiers.last()?.arguments.first(),
            _ => None,
        };
        let items = match what {
            Phrase::List(items) => items.as_slice(),
            one => std::slice::from_ref(one),
        };
        let first = landmark(items.first()?)?;
        let shared = items.iter().all(|item| landmark(item) == Some(first));
        shared.then_some(first)
    }

    /// Returns the same form with `antecedent` in place of every pronoun; `None` where there is a pronoun and no antecedent.
    pub fn with_antecedent(&self, antecedent: Option<&Phrase>) -> Option<Self> {
        let mut form = self.clone();
        let mut replace = |phrase: &mut Phrase| match (&*phrase, antecedent) {
            (Phrase::Pronoun, Some(antecedent)) => {
                *phrase = antecedent.clone();
                true
            }
            (Phrase::Pronoun, None) => false,
            _ => true,
        };
        visit_form(&mut form, &mut replace).then_some(form)
    }

    /// Returns the forms that a request may mean whose later steps say "it": that stands for a thing that a step before is about, the
    /// last one first. Other forms mean themselves.
    pub fn with_own_antecedents(&self) -> Vec<Self> {
        match self {
            Self::Request(Request::Sequence(steps)) => {
                let plans = bound_steps(steps).into_iter();
                plans
                    .map(|steps| Self::Request(Request::Sequence(steps)))
                    .collect()
            }
            Self::Request(Request::If(clause, step)) => {
                let subject = Self::Claim(clause.clone());
                let subject = subject.subject().or(existing(clause));
                let steps = with_antecedents(step, subject.into_iter());
                let steps = steps.into_iter();
                steps
                    .map(|step| Self::Request(Request::If(clause.clone(), step)))
                    .collect()
            }
            other => vec![other.clone()],
        }
    }

    /// Returns the same form with "it" in place of `antecedent`, where that stands as subject or landmark.
    #[must_use]
    pub fn with_pronoun(&self, antecedent: &Phrase) -> Self {
        let mut form = self.clone();
        let mut replace = |phrase: &mut Phrase| {
            if phrase == antecedent {
                *phrase = Phrase::Pronoun;
            }
            true
        };
        visit_form(&mut form, &mut replace);
        form
    }
}

/// The thing that a clause says to exist.
fn existing(clause: &Clause) -> Option<&Phrase> {
    match clause {
        Clause::Exists(what @ Phrase::Described(_)) => Some(what),
        _ => None,
    }
}

/// The things that a step is about, the last one first; a thing and no pronoun.
fn things_of(step: &RequestStep) -> Vec<&Phrase> {
    let all = match step {
        RequestStep::GoTo(_) => Vec::new(),
        RequestStep::Do { object, .. } | RequestStep::DoNot { object, .. } => vec![object],
        RequestStep::Put { object, to, .. } | RequestStep::Bring { object, to } => vec![object, to],
    };
    let things = all.into_iter().filter(|phrase| **phrase != Phrase::Pronoun);
    things.collect()
}

/// The step with each of the antecedents in place of its pronouns; itself where it has none or there is no antecedent.
fn with_antecedents<'a>(
    step: &RequestStep,
    antecedents: impl Iterator<Item = &'a Phrase>,
) -> Vec<RequestStep> {
    let mut found = Vec::new();
    for antecedent in antecedents {
        let mut bound = step.clone();
        visit_step(&mut bound, &mut |phrase| {
            if *phrase == Phrase::Pronoun {
                *phrase = antecedent.clone();
            }
            true
        });
        if bound == *step {
            break;
        }
        found.push(bound);
    }
    if found.is_empty() {
        found.push(step.clone());
    }
    found
}

/// Largest number of meanings of a request that are kept.
const MAX_MEANINGS: usize = 8;

fn bound_steps(steps: &[RequestStep]) -> Vec<Vec<RequestStep>> {
    let mut plans: Vec<Vec<RequestStep>> = vec![Vec::new()];
    for step in steps {
        let mut longer = Vec::new();
        for plan in &plans {
            let things = plan
                .iter()
                .rev()
                .map(things_of)
                .find(|things| !things.is_empty());
            for bound in with_antecedents(step, things.into_iter().flatten()) {
                let mut next = plan.clone();
                next.push(bound);
                longer.push(next);
            }
        }
        longer.truncate(MAX_MEANINGS);
        plans = longer;
    }
    plans
}

fn is_singular(phrase: &Phrase) -> bool {
    use super::Quantifier;
    match phrase {
        Phrase::Described(description) => description.quantifier == Quantifier::The,
        Phrase::Id(_) => true,
        _ => false,
    }
}

/// Calls `visit` for every phrase, the outer before the inner; false as soon as a call returns that.
type Visit<'a> = &'a mut dyn FnMut(&mut Phrase) -> bool;

fn visit_form(form: &mut Form, visit: Visit<'_>) -> bool {
    match form {
        Form::Claim(clause) => visit_clause(clause, visit),
        Form::Request(Request::Sequence(steps)) => {
            steps.iter_mut().all(|step| visit_step(step, visit))
        }
        Form::Request(Request::If(clause, step)) => {
            visit_clause(clause, visit) && visit_step(step, visit)
        }
        Form::Question(question) => match question {
            Question::Whether(clause) => visit_clause(clause, visit),
            Question::Which { kind, clause } => {
                let mut kinds = kind.iter_mut();
                kinds.all(|kind| visit_modifiers(&mut kind.modifiers, visit))
                    && visit_clause(clause, visit)
            }
            Question::HowMany(what) => visit_modifiers(&mut what.modifiers, visit),
            Question::Attribute { of, .. } => visit_phrase(of, visit),
        },
        Form::NounPhrase(phrase) => visit_phrase(phrase, visit),
    }
}

fn visit_clause(clause: &mut Clause, visit: Visit<'_>) -> bool {
    match clause {
        Clause::Holds { arguments, .. } => arguments
            .iter_mut()
            .all(|phrase| visit_phrase(phrase, visit)),
        Clause::Is { subject, .. } => visit_phrase(subject, visit),
        Clause::Exists(what) => visit_phrase(what, visit),
        Clause::Area { room, .. } | Clause::HasSurfaces { room, .. } => visit_phrase(room, visit),
        Clause::Not(inner) => visit_clause(inner, visit),
        Clause::All(clauses) | Clause::Any(clauses) => {
            clauses.iter_mut().all(|clause| visit_clause(clause, visit))
        }
    }
}

fn visit_step(step: &mut RequestStep, visit: Visit<'_>) -> bool {
    match step {
        RequestStep::GoTo(phrase)
        | RequestStep::Do { object: phrase, .. }
        | RequestStep::DoNot { object: phrase, .. } => visit_phrase(phrase, visit),
        RequestStep::Put { object, to, .. } | RequestStep::Bring { object, to } => {
            visit_phrase(object, visit) && visit_phrase(to, visit)
        }
    }
}

fn visit_modifiers(modifiers: &mut [Modifier], visit: Visit<'_>) -> bool {
    let mut phrases = modifiers
        .iter_mut()
        .flat_map(|modifier| &mut modifier.arguments);
    phrases.all(|phrase| visit_phrase(phrase, visit))
}

fn visit_phrase(phrase: &mut Phrase, visit: Visit<'_>) -> bool {
    if !visit(phrase) {
        return false;
    }
    match phrase {
        Phrase::Described(description) => {
            let reference = description.selection.as_mut();
            let reference = reference.and_then(|selection| selection.reference.as_deref_mut());
            let mut reference = reference.into_iter();
            reference.all(|phrase| visit_phrase(phrase, visit))
                && visit_modifiers(&mut description.modifiers, visit)
        }
        Phrase::List(items) => items.iter_mut().all(|item| visit_phrase(item, visit)),
        Phrase::Id(_) | Phrase::Listener | Phrase::Storey(_) | Phrase::Hole | Phrase::Pronoun => {
            true
        }
    }
}
