//! Evaluation of forms in a scene: true, false or undecided, with the facts that decided.
//!
//! Truth values are those of strong three-valued logic ([`Truth`]). A definite description that several things fit is decided
//! where all of them would decide alike, and undecided else (supervaluation); where nothing fits, a claim about it is false.
//!
//! # Source
//! B. Russell, "On denoting", Mind 14, 479 (1905), for descriptions that nothing fits; B. van Fraassen, "Singular terms,
//! truth-value gaps, and free logic", Journal of Philosophy 63(17), 481 (1966), for those that several things fit; J. Barwise and
//! R. Cooper, "Generalized quantifiers and natural language", Linguistics and Philosophy 4, 159 (1981), for quantifiers.

mod ambiguity;
mod answer;
mod claims;
mod description;
mod distance;
mod quantify;
mod room;
mod text;
mod witness;

pub use ambiguity::AmbiguousPhrase;
pub use answer::QuestionAnswer;
pub use claims::{ClaimScope, ClaimVerdict, JudgedClaim};
pub(crate) use distance::rounded_distance_m;
pub(crate) use room::rounded_area_m2;
pub use text::{CheckedText, GroundedPhrase};
pub use witness::Witness;

use crate::form::{Clause, Description, Form, Modifier, Phrase, Quality, Quantifier};
use crate::predicates;
use crate::scene::{SemanticScene, Term, Viewer};
use crate::structure_facts;
use crate::truth::{Truth, UndecidedReason};
use description::Extension;
use dwell_scene::AgentId;
use dwell_scene::interrupt;
use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::rc::Rc;
use witness::WitnessedTruth;

/// The listener of a form: the agent that "you" denotes, and the viewer of left and right.
#[derive(Clone, Copy, Debug, Default)]
pub struct Addressee {
    /// The viewer from whom left, right, in front and behind are meant.
    pub viewer: Option<Viewer>,
    /// The agent that "you" denotes.
    pub agent: Option<AgentId>,
}

impl Addressee {
    /// Returns an agent as listener, with its own eyes as viewer.
    pub fn agent(scene: &SemanticScene<'_>, agent: AgentId) -> Self {
        Self {
            viewer: Viewer::of_agent(scene.state, agent),
            agent: Some(agent),
        }
    }
}

/// The verdict on a clause: its truth value, and the facts that decided it.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckResult {
    /// The truth value.
    pub truth: Truth,
    /// Facts that suffice for it: those of one example or counterexample where one decides, else of all; at most 16.
    pub witnesses: Vec<Witness>,
}

/// A checker of forms in one scene for one listener. The extension of each description is computed once.
pub struct Checker<'a> {
    scene: &'a SemanticScene<'a>,
    listener: Addressee,
    extensions: RefCell<BTreeMap<Description, Rc<Extension>>>,
    /// The thing in place of [`Phrase::Hole`], which stands as an argument of a clause, never in a description.
    hole: Cell<Option<Term>>,
}

impl<'a> Checker<'a> {
    /// Returns a checker of a scene.
    pub fn new(scene: &'a SemanticScene<'a>, listener: Addressee) -> Self {
        Self {
            scene,
            listener,
            extensions: RefCell::default(),
            hole: Cell::new(None),
        }
    }

    /// The scene.
    pub fn scene(&self) -> &'a SemanticScene<'a> {
        self.scene
    }

    /// Returns the verdict on a clause.
    pub fn check(&self, clause: &Clause) -> CheckResult {
        let WitnessedTruth { truth, witnesses } = self.judge(clause);
        CheckResult { truth, witnesses }
    }

    /// Returns the verdict on a form that says something: a claim, or a noun phrase, which is true where what it describes exists.
    /// `None` for requests and questions.
    pub fn check_form(&self, form: &Form) -> Option<CheckResult> {
        match form {
            Form::Claim(clause) => Some(self.check(clause)),
            Form::NounPhrase(phrase) => Some(self.check(&Clause::Exists(phrase.clone()))),
            Form::Request(_) | Form::Question(_) | Form::Several(_) => None,
        }
    }

    /// Returns the things that a description fits, regardless of its quantifier, ascending; without those of which it is undecided.
    pub fn matching_terms(&self, description: &Description) -> Vec<Term> {
        self.extension(description).fits.clone()
    }

    /// Returns the one thing that a description certainly denotes, said of what the listener sees where it sees some that fit; `None`
    /// where nothing or several things fit, or may fit.
    pub fn certain_referent(&self, description: &Description) -> Option<Term> {
        let extension = self.extension(description);
        match (&extension.fits[..], extension.fault) {
            ([only], None) if extension.undecided.is_empty() => Some(*only),
            _ => None,
        }
    }

    /// The number of things that a description fits or may fit.
    pub(crate) fn possible_count(&self, description: &Description) -> usize {
        let extension = self.extension(description);
        extension.fits.len() + extension.undecided.len()
    }

    /// The listener.
    pub fn listener(&self) -> &Addressee {
        &self.listener
    }

    fn judge(&self, clause: &Clause) -> WitnessedTruth {
        interrupt::unwind_if_cancelled();
        match clause {
            Clause::Holds {
                predicate,
                arguments,
            } => match predicates::find(predicate) {
                Ok(_) if matches!(&arguments[..], [_, Phrase::EachOther]) => {
                    self.each_other(predicate, &arguments[0])
                }
                Ok(found) => {
                    let body = |terms: &[Term]| {
                        let viewer = self.listener.viewer.as_ref();
                        let truth = found.holds(self.scene, terms, viewer);
                        WitnessedTruth::fact(predicate, terms, truth)
                    };
                    self.quantify(arguments, &mut Vec::new(), &body)
                }
                Err(_) => WitnessedTruth::undecided(UndecidedReason::UnknownPredicate),
            },
            Clause::Is { subject, quality } => {
                let body = |terms: &[Term]| self.has_quality(terms[0], quality);
                self.quantify(std::slice::from_ref(subject), &mut Vec::new(), &body)
            }
            Clause::Exists(Phrase::Described(what)) if wide_scope_modifier(what).is_some() => {
                self.exists_for_each(what)
            }
            Clause::Exists(what) => {
                let body = |terms: &[Term]| WitnessedTruth::fact("exists", terms, Truth::True);
                self.quantify(std::slice::from_ref(what), &mut Vec::new(), &body)
            }
            Clause::More { more, than } => self.has_more(more, than),
            Clause::Area {
                room,
                square_metres,
            } => {
                let body = |terms: &[Term]| self.has_area(terms[0], *square_metres);
                self.quantify(std::slice::from_ref(room), &mut Vec::new(), &body)
            }
            Clause::Distance {
                subject,
                from,
                metres,
            } => self.is_at_distance(subject, from, *metres),
            Clause::HasSurfaces { room, surfaces } => {
                let body = |terms: &[Term]| self.has_surfaces(terms[0], surfaces);
                self.quantify(std::slice::from_ref(room), &mut Vec::new(), &body)
            }
            Clause::Now(inner) => self.judge(inner),
            Clause::Not(inner) => self.judge(inner).negated(),
            Clause::All(clauses) => {
                WitnessedTruth::all(clauses.iter().map(|clause| self.judge(clause)))
            }
            Clause::Any(clauses) => {
                WitnessedTruth::any(clauses.iter().map(|clause| self.judge(clause)))
            }
        }
    }

    /// "The chairs are next to each other": each is next to another one of them.
    fn each_other(&self, predicate: &str, subject: &Phrase) -> WitnessedTruth {
        if let Phrase::List(items) = subject {
            let others = |at: usize| items.iter().enumerate().filter(move |(k, _)| *k != at);
            return WitnessedTruth::all(items.iter().enumerate().map(|(at, item)| {
                WitnessedTruth::any(others(at).map(|(_, other)| {
                    self.judge(&Clause::Holds {
                        predicate: predicate.to_owned(),
                        arguments: vec![item.clone(), other.clone()],
                    })
                }))
            }));
        }
        let (Phrase::Described(own), Ok(found)) = (subject, predicates::find(predicate)) else {
            return WitnessedTruth::undecided(UndecidedReason::UnknownTerm);
        };
        let extension = self.extension(own);
        let body = |terms: &[Term]| {
            let others = extension.fits.iter().filter(|other| **other != terms[0]);
            WitnessedTruth::any(others.map(|other| {
                let pair = [terms[0], *other];
                let truth = found.holds(self.scene, &pair, self.listener.viewer.as_ref());
                WitnessedTruth::fact(predicate, &pair, truth)
            }))
        };
        self.quantify(std::slice::from_ref(subject), &mut Vec::new(), &body)
    }

    /// "There is a lamp on every desk": each desk has its own.
    fn exists_for_each(&self, what: &Description) -> WitnessedTruth {
        let mut thing = what.clone();
        let Some(at) = wide_scope_modifier(what) else {
            return WitnessedTruth::undecided(UndecidedReason::UnknownPredicate);
        };
        let Modifier {
            predicate,
            arguments,
            ..
        } = thing.modifiers.remove(at);
        let Ok(found) = predicates::find(&predicate) else {
            return WitnessedTruth::undecided(UndecidedReason::UnknownPredicate);
        };
        let body = |terms: &[Term]| {
            let swapped = [terms[1], terms[0]];
            let truth = found.holds(self.scene, &swapped, self.listener.viewer.as_ref());
            WitnessedTruth::fact(&predicate, &swapped, truth)
        };
        let mut ordered = arguments;
        ordered.push(thing.into());
        self.quantify(&ordered, &mut Vec::new(), &body)
    }

    fn has_quality(&self, term: Term, quality: &Quality) -> WitnessedTruth {
        let object = match (term, quality) {
            (Term::Object(object), _) => object,
            // A blue bedroom has blue walls.
            (Term::Room(_), Quality::Color(word)) => return self.has_walls(term, word),
            (Term::Structure(piece), Quality::Color(word)) => {
                let truth = structure_facts::has_color(self.scene.semantics, piece, word);
                return WitnessedTruth::fact(word, &[term], truth);
            }
            (Term::Structure(piece), Quality::Material(word)) => {
                let truth = structure_facts::has_material(self.scene.semantics, piece, word);
                return WitnessedTruth::fact(word, &[term], truth.into());
            }
            _ => return WitnessedTruth::undecided(UndecidedReason::WrongKind),
        };
        let facts = self.scene.facts(object);
        let (name, truth) = match quality {
            Quality::Color(word) => (word.as_str(), facts.shows_color(word)),
            Quality::Material(word) => (
                word.as_str(),
                facts.material_words().any(|own| own == word).into(),
            ),
            Quality::Size(size) => (
                size.word().unwrap_or("normal"),
                (facts.size == *size).into(),
            ),
            Quality::State(name) => (name.as_str(), self.state_holds(name, term)),
        };
        WitnessedTruth::fact(name, &[term], truth)
    }

    fn state_holds(&self, name: &str, term: Term) -> Truth {
        predicates::find(name).map_or(
            Truth::Undecided(UndecidedReason::UnknownPredicate),
            |found| found.holds(self.scene, &[term], self.listener.viewer.as_ref()),
        )
    }

    /// The thing that a phrase denotes by id, as the listener or as a storey; `None` for descriptions and holes.
    fn direct_referent(&self, phrase: &Phrase) -> Option<Result<Term, UndecidedReason>> {
        let house = self.scene.house();
        Some(match phrase {
            Phrase::Id(id) => {
                let id = i32::try_from(*id).map(dwell_scene::EntityId).ok();
                id.and_then(|id| Term::from_entity(house, self.scene.state, id))
                    .ok_or(UndecidedReason::UnknownTerm)
            }
            Phrase::Listener => {
                let agent = self.listener.agent.map(Term::Agent);
                agent.ok_or(UndecidedReason::NoListener)
            }
            Phrase::Storey(number) => house
                .levels
                .ids()
                .nth(number.saturating_sub(1) as usize)
                .map(Term::Storey)
                .ok_or(UndecidedReason::UnknownTerm),
            Phrase::Hole => self.hole.get().ok_or(UndecidedReason::UnknownTerm),
            Phrase::Speaker | Phrase::EachOther => Err(UndecidedReason::UnknownTerm),
            Phrase::Pronoun | Phrase::NamedBefore => Err(UndecidedReason::NoAntecedent),
            Phrase::Described(_) | Phrase::List(_) => return None,
        })
    }
}

/// The modifier with a landmark that has a wider scope than the thing that exists: "every desk", "no desk", "two desks".
fn wide_scope_modifier(what: &Description) -> Option<usize> {
    let is_wide = |modifier: &Modifier| match &modifier.arguments[..] {
        [Phrase::Described(own)] => !matches!(own.quantifier, Quantifier::The | Quantifier::Some),
        _ => false,
    };
    let modifiers = what.modifiers.iter();
    let is_plain = what.selection.is_none();
    let mut wide = modifiers.map(|one| is_plain && !one.negated && is_wide(one));
    wide.position(|wide| wide)
}
