//! Pronouns and their antecedents.

use super::mention::{
    exactly_one_as_definite, is_any_room, is_singular, may_be_one, object_with_predicate,
    subject_with_predicate, subject_without_predicate, topic_of,
};
use super::visit::{PhraseRole, visit_clause, visit_form, visit_step};
use super::{
    Clause, Description, Form, Modifier, Noun, Phrase, Quality, Quantifier, Question, RequestStep,
};
use std::collections::VecDeque;

impl Form {
    /// The phrase that "it" in the next sentence stands for: the subject of a claim, where that is one thing. `None` where a
    /// pronoun would have no antecedent, or more than one.
    pub fn pronoun_antecedent(&self) -> Option<&Phrase> {
        let Self::Claim(clause) = self else {
            return None;
        };
        let clause = match clause {
            Clause::Now(inner) => inner,
            clause => clause,
        };
        let subject = match clause {
            Clause::Holds { arguments, .. } => arguments.first()?,
            Clause::Is { subject, .. } | Clause::Distance { subject, .. } => subject,
            Clause::Area { room, .. } | Clause::HasSurfaces { room, .. } => room,
            // "There is a chair in the hall. It is red." A list has no one thing but its place: "On the table there is a cup and a
            // plate. It is wooden."
            Clause::Exists(what) => match what {
                Phrase::Described(own) if own.quantifier == Quantifier::Some => return Some(what),
                what => Self::shared_landmark(what)?,
            },
            Clause::More { .. }
            | Clause::Now(_)
            | Clause::Not(_)
            | Clause::All(_)
            | Clause::Any(_) => return None,
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

    /// Returns the forms that this one may mean after the sentence `before`, the preferred one first: with what was named before in
    /// place of pronouns, of "one" and of "them". Those for which nothing was named stay.
    ///
    /// "It" stands for the subject of `before`, or for a thing that an earlier clause or step of the same sentence is about: the
    /// last one that the verb suits, by the table of categories. "One" has the noun of the last thing in the same role: a landmark after a
    /// landmark, else a subject or object.
    pub fn resolve_anaphora(&self, before: Option<&Self>) -> Vec<Self> {
        let mut forms = Vec::new();
        let mut open = VecDeque::from([Vec::new()]);
        for _ in 0..MAX_TRIES {
            let Some(choices) = open.pop_front() else {
                break;
            };
            let mut form = self.clone();
            let mut resolver = Resolver::after(before, choices);
            resolver.form(&mut form);
            if !forms.contains(&form) {
                forms.push(form);
            }
            // Every other candidate for each pronoun that has not been varied yet.
            let first = resolver.choices.len();
            for (at, count) in resolver.counts.iter().enumerate().skip(first) {
                for other in 1..*count {
                    let mut varied = resolver.choices.clone();
                    varied.resize(at, 0);
                    varied.push(other);
                    open.push_back(varied);
                }
            }
            if forms.len() >= MAX_MEANINGS {
                break;
            }
        }
        forms
    }

    /// Returns whether nothing in the form stands for what was named before.
    pub fn is_free_of_anaphora(&self) -> bool {
        let mut complete = true;
        visit_form(&mut self.clone(), &mut |phrase, _| {
            complete &= match phrase {
                Phrase::Pronoun | Phrase::NamedBefore => false,
                Phrase::Described(own) => !matches!(own.noun, Noun::SameNoun | Noun::SameThings),
                _ => true,
            }
        });
        complete
    }

    /// Returns the same form with "it" in place of `antecedent`, where that stands as subject or landmark.
    #[must_use]
    pub fn with_pronoun(&self, antecedent: &Phrase) -> Self {
        self.with_phrase(antecedent, &Phrase::Pronoun)
    }

    /// Returns the same form with the phrase `new` in place of `old`, where that stands as subject or landmark.
    #[must_use]
    pub fn with_phrase(&self, old: &Phrase, new: &Phrase) -> Self {
        let mut form = self.clone();
        visit_form(&mut form, &mut |phrase, _| {
            if phrase == old {
                phrase.clone_from(new);
            }
        });
        form
    }
}

/// Returns whether a modifier tells on which side a thing is: of two things the other one is elsewhere.
fn is_side(added: &Modifier) -> bool {
    const SIDES: [&str; 6] = [
        "left_of",
        "right_of",
        "on_left",
        "on_right",
        "in_front_of",
        "behind",
    ];
    SIDES.contains(&added.predicate.as_str())
}

/// Largest number of meanings of a sentence that are kept.
const MAX_MEANINGS: usize = 8;
/// Largest number of choices of antecedents that are tried.
const MAX_TRIES: usize = 64;

/// A thing that was named.
pub(super) struct Mention {
    pub(super) phrase: Phrase,
    pub(super) role: PhraseRole,
    /// The clause or step that named it.
    pub(super) unit: usize,
    /// With what its clause says of it, where its number is indefinite: "three cups are on the table".
    pub(super) with_said: Option<Description>,
    /// False for what only describes another thing: the pot of "the plant in the pot is on the table".
    pub(super) is_argument: bool,
}

/// Puts the landmark of the first of `items` in place of "it" where the first can't be meant: in "one curtain to the left of the window and
/// one to the right of it", and after several, "two lamps on the ceiling and one hanging from it".
fn share_landmark(items: &mut [Phrase]) {
    let Some((Phrase::Described(first), rest)) = items.split_first_mut() else {
        return;
    };
    let landmark = first
        .modifiers
        .last()
        .and_then(|last| last.arguments.first());
    let Some(landmark @ Phrase::Described(_)) = landmark else {
        return;
    };
    let first_is_one = may_be_one(&Phrase::Described(first.clone()));
    for item in rest {
        let Phrase::Described(own) = item else {
            continue;
        };
        if first_is_one && own.noun != Noun::SameNoun {
            continue;
        }
        for argument in own.modifiers.iter_mut().flat_map(|own| &mut own.arguments) {
            if *argument == Phrase::Pronoun {
                argument.clone_from(landmark);
            }
        }
    }
}

/// Puts antecedents in place of what stands for them, clause by clause and step by step.
pub(super) struct Resolver {
    pub(super) mentions: Vec<Mention>,
    /// The only thing that "it" stands for in the first clause.
    pub(super) subject: Option<Phrase>,
    pub(super) unit: usize,
    /// The number of the candidate to take for each pronoun; the first one beyond its end.
    choices: Vec<usize>,
    /// The number of candidates of each pronoun.
    counts: Vec<usize>,
}

impl Resolver {
    fn after(before: Option<&Form>, choices: Vec<usize>) -> Self {
        let mut resolver = Self {
            mentions: Vec::new(),
            subject: before.and_then(Form::pronoun_antecedent).cloned(),
            unit: 0,
            choices,
            counts: Vec::new(),
        };
        if let Some(before) = before {
            visit_form(&mut before.clone(), &mut |phrase, role| {
                resolver.mention(phrase, role);
            });
            // After a claim "it" is its subject or nothing.
            resolver.unit = usize::from(!matches!(before, Form::Claim(_)));
        }
        resolver
    }

    fn mention(&mut self, phrase: &Phrase, role: PhraseRole) {
        if matches!(phrase, Phrase::Described(_) | Phrase::Id(_)) {
            self.mentions.push(Mention {
                phrase: phrase.clone(),
                role,
                unit: self.unit,
                with_said: None,
                is_argument: true,
            });
        }
    }

    fn form(&mut self, form: &mut Form) {
        match form {
            Form::Claim(clause) | Form::Question(Question::Whether(clause)) => self.clause(clause),
            Form::Request(steps) => {
                for step in steps {
                    self.step(step);
                }
            }
            Form::Question(Question::Alternatives(clauses)) => {
                for clause in clauses {
                    self.clause(clause);
                }
            }
            Form::Several(forms) => {
                for form in forms {
                    self.form(form);
                }
            }
            Form::Question(_) | Form::NounPhrase(_) => {
                let first = self.mentions.len();
                self.resolve_unit(None, |visit| visit_form(form, visit));
                // "How many vases are there in the bookcase, and how many are on top of it?" "It" is none of the vases.
                if let Form::Question(Question::HowMany(_)) = form
                    && let Some(counted) = self.mentions.get_mut(first)
                    && let Phrase::Described(own) = &mut counted.phrase
                {
                    own.quantifier = Quantifier::AtLeast(2);
                }
            }
        }
    }

    fn clause(&mut self, clause: &mut Clause) {
        match clause {
            Clause::All(clauses) | Clause::Any(clauses) => {
                for clause in clauses {
                    self.clause(clause);
                }
            }
            Clause::Now(inner) => self.clause(inner),
            Clause::Not(inner) => {
                let first = self.mentions.len();
                self.clause(inner);
                // "If one of the lamps is not on, switch it on": a lamp that is not on.
                if let Some(subject) = self.mentions.get_mut(first) {
                    subject.with_said = subject_without_predicate(inner);
                }
            }
            one => {
                let verb = match &*one {
                    Clause::Is {
                        quality: Quality::State(state),
                        ..
                    } => Some(state.clone()),
                    _ => None,
                };
                let first = self.mentions.len();
                let is_part_of_several = matches!(
                    &*one,
                    Clause::Exists(Phrase::Described(own))
                        if own.noun == Noun::SameNoun && own.modifiers.is_empty()
                );
                if let Clause::Exists(Phrase::List(items)) = one {
                    share_landmark(items);
                }
                self.resolve_unit(verb.as_deref(), |visit| visit_clause(one, visit));
                if let Clause::Exists(Phrase::Described(own)) = &mut *one
                    && is_part_of_several
                {
                    self.inherit_group_modifiers(own, first);
                }
                if let Clause::Holds {
                    predicate,
                    arguments,
                } = &*one
                {
                    for mention in &mut self.mentions[first..] {
                        mention.is_argument = arguments.contains(&mention.phrase);
                    }
                    // "The blue thing is a cup, and it is empty": the blue thing is.
                    if predicate == Modifier::IDENTICAL {
                        let subject = arguments.first();
                        let mut at = 0;
                        self.mentions.retain(|mention| {
                            at += 1;
                            at <= first || Some(&mention.phrase) == subject
                        });
                    }
                }
                if let Some(subject) = self.mentions.get_mut(first) {
                    subject.with_said = subject_with_predicate(one);
                }
                if let Some((object, with_said)) = object_with_predicate(one) {
                    for mention in &mut self.mentions[first..] {
                        if mention.phrase == object {
                            mention.with_said = Some(with_said.clone());
                        }
                    }
                }
            }
        }
    }

    fn step(&mut self, step: &mut RequestStep) {
        let verb = match &*step {
            RequestStep::Do { verb, .. } | RequestStep::DoNot { verb, .. } => Some(verb.clone()),
            RequestStep::Put { .. } | RequestStep::Bring { .. } => Some("pick_up".to_owned()),
            RequestStep::GoTo(_)
            | RequestStep::Leave(_)
            | RequestStep::Turn(_)
            | RequestStep::If { .. } => None,
        };
        let RequestStep::If {
            condition,
            then,
            otherwise,
        } = step
        else {
            self.resolve_unit(verb.as_deref(), |visit| visit_step(step, visit));
            // "Bring another cup": where none was named, any cup.
            visit_step(step, &mut |phrase, _| {
                if let Phrase::Described(own) = phrase
                    && own.quantifier == Quantifier::Some
                {
                    own.modifiers
                        .retain(|modifier| !modifier.arguments.contains(&Phrase::NamedBefore));
                }
            });
            return;
        };
        // "Close the door if it is open": the door is named by the step.
        let topic = then.first().and_then(topic_of);
        if let Some(topic) = topic.filter(|_| self.mentions.is_empty()) {
            self.mention(topic, PhraseRole::Topic);
            self.unit += 1;
        }
        self.clause(condition);
        for step in then.iter_mut().chain(otherwise) {
            self.step(step);
        }
    }

    /// Resolves what a clause or a step says of things before it.
    fn resolve_unit(
        &mut self,
        verb: Option<&str>,
        mut visit: impl FnMut(&mut dyn FnMut(&mut Phrase, PhraseRole)),
    ) {
        visit(&mut |phrase, role| {
            self.resolve(phrase, role, verb);
            self.mention(phrase, role);
        });
        // "The other bed is wider than this one" names the one after the other, "smaller than the stand that supports it", too.
        visit(&mut |phrase, role| match phrase {
            Phrase::Described(own) => {
                // "The window is narrower than the one on the left" names the window after the other one.
                if own.noun == Noun::SameNoun
                    && role == PhraseRole::Topic
                    && let Some(noun) = self.compared_noun()
                {
                    own.noun = noun;
                }
                self.resolve_other(own);
            }
            Phrase::Pronoun => {
                let topics = self.mentions.iter().rev().filter(|mention| {
                    mention.unit == self.unit
                        && mention.role == PhraseRole::Topic
                        && Form::NounPhrase(mention.phrase.clone()).is_free_of_anaphora()
                });
                if let Some(topic) = topics.map(|mention| &mention.phrase).next() {
                    *phrase = topic.clone();
                }
            }
            _ => {}
        });
        self.unit += 1;
        self.subject = None;
    }

    fn resolve(&mut self, phrase: &mut Phrase, role: PhraseRole, verb: Option<&str>) {
        match phrase {
            Phrase::Pronoun => {
                // "Open the fridge and take a bottle out of it": what is taken is movable, not what it is in.
                let candidates = self.candidates(verb.filter(|_| role != PhraseRole::Landmark));
                let choice = self.choices.get(self.counts.len()).copied().unwrap_or(0);
                self.counts.push(candidates.len());
                if let Some(found) = candidates.into_iter().nth(choice) {
                    *phrase = exactly_one_as_definite(found);
                }
            }
            Phrase::Described(own) if own.noun == Noun::SameNoun => {
                if let Some(noun) = self.contrasted(own).or_else(|| self.noun_in_role(role)) {
                    own.noun = noun;
                }
            }
            Phrase::Described(own) if role == PhraseRole::Landmark && is_any_room(own) => {
                // "Go to the hall and open the door at the end": of the hall.
                if let Some(room) = self.room_before() {
                    *phrase = room;
                }
            }
            Phrase::Described(own) if own.noun == Noun::SameThings => {
                if let Some(named) = self.things_named() {
                    let selection = own.selection.take();
                    // "Carry both plates to the kitchen and put them in the sink": both.
                    let quantifier = match (own.quantifier, named.quantifier) {
                        (Quantifier::Every, all @ (Quantifier::ThePlural | Quantifier::All(_))) => {
                            all
                        }
                        (own, _) => own,
                    };
                    **own = named.clone().with_quantifier(quantifier);
                    if selection.is_some() {
                        own.selection = selection;
                    }
                }
            }
            _ => {}
        }
    }

    /// Puts the last thing of the same noun in place of what a description is other than.
    fn resolve_other(&self, own: &mut Description) {
        let noun = own.noun.clone();
        let is_any_room = noun == Noun::Room(Noun::ANY_ROOM.to_owned());
        let mut shared: Vec<Modifier> = Vec::new();
        let others = own
            .modifiers
            .iter_mut()
            .flat_map(|modifier| &mut modifier.arguments);
        for other in others.filter(|other| **other == Phrase::NamedBefore) {
            let mut named = self.mentions.iter().rev().filter_map(|mention| {
                let Phrase::Described(named) = &mention.phrase else {
                    return None;
                };
                let is_one = matches!(
                    named.quantifier,
                    Quantifier::The | Quantifier::Some | Quantifier::Exactly(1)
                );
                let is_complete = Form::NounPhrase(mention.phrase.clone()).is_free_of_anaphora();
                // "The floor of the kitchen is gray, but in the other room it is wooden": not in the kitchen.
                let is_alike =
                    named.noun == noun || is_any_room && matches!(named.noun, Noun::Room(_));
                (is_alike && is_one && is_complete).then_some((named, mention))
            });
            if let Some((named, mention)) = named.next() {
                if named.quantifier != Quantifier::The {
                    // "One of the mats in the hall is orange, and the other is gray": the other mat in the hall.
                    let shared_place = named.modifiers.iter();
                    let shared_place = shared_place.filter(|added| !is_side(added));
                    shared = shared_place.cloned().collect();
                }
                let named = mention.with_said.as_ref().unwrap_or(named);
                *other = named.clone().with_quantifier(Quantifier::The).into();
            } else if is_any_room {
                // "The other room", where none was named: not the one that the listener is in.
                *other = Description::room_of_listener().into();
            }
        }
        if own.modifiers.len() == 1 {
            own.modifiers.splice(0..0, shared);
        }
    }

    /// "There are two chairs in the kitchen, one red and one blue": both are in the kitchen.
    fn inherit_group_modifiers(&self, own: &mut Description, before: usize) {
        let named = self.mentions[..before].iter().rev().find_map(|mention| {
            let Phrase::Described(named) = &mention.phrase else {
                return None;
            };
            let are_several = match named.quantifier {
                Quantifier::Exactly(count) | Quantifier::AtLeast(count) => count > 1,
                _ => false,
            };
            (mention.role == PhraseRole::Topic && are_several && named.noun == own.noun)
                .then(|| mention.with_said.as_ref().unwrap_or(named))
        });
        if let Some(named) = named {
            own.modifiers.clone_from(&named.modifiers);
        }
    }
}
