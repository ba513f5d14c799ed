//! The extensions of descriptions.

use super::Checker;
use super::witness::WitnessedTruth;
use crate::category::categories;
use crate::form::{Description, Modifier, Noun, OrdinalSelection, Phrase, Quality, Quantifier};
use crate::predicates::{self, Predicate};
use crate::scene::Term;
use crate::selections;
use crate::truth::{Truth, UndecidedReason};
use dwell_scene::StructureKind;
use dwell_scene::interrupt::CancelPoller;
use std::rc::Rc;

/// Things between checks for cancellation.
const THINGS_PER_CHECK: usize = 16;

/// The extension of a description: the things that it fits.
#[derive(Clone, Debug, Default)]
pub(super) struct Extension {
    /// The things that it fits, ascending.
    pub(super) fits: Vec<Term>,
    /// The things of which it is undecided, ascending, with the reasons.
    pub(super) undecided: Vec<(Term, UndecidedReason)>,
    /// The reason why it has no extension in this scene.
    pub(super) fault: Option<UndecidedReason>,
}

/// The noun of a piece of the building, where it has one.
fn structure_noun(kind: StructureKind) -> Option<&'static str> {
    match kind {
        StructureKind::Wall => Some("wall"),
        StructureKind::Floor => Some("floor"),
        StructureKind::Ceiling => Some("ceiling"),
        StructureKind::Ground | StructureKind::Other => None,
    }
}

impl Checker<'_> {
    pub(super) fn extension(&self, description: &Description) -> Rc<Extension> {
        // Who looks at things says "the lamp" and "the lamps" of those in sight; all other quantifiers have the same extension.
        let key = match (self.listener.viewer, description.quantifier) {
            (Some(_), Quantifier::The | Quantifier::ThePlural) => description.clone(),
            _ => description.clone().with_quantifier(Quantifier::Some),
        };
        if let Some(known) = self.extensions.borrow().get(&key) {
            return known.clone();
        }
        let found = Rc::new(self.compute_extension(description));
        self.extensions.borrow_mut().insert(key, found.clone());
        found
    }

    fn compute_extension(&self, description: &Description) -> Extension {
        let mut found = Extension::default();
        let mut poll = CancelPoller::new(THINGS_PER_CHECK);
        for term in self.things_named(&description.noun) {
            poll.count_one();
            match self.fits(description, term) {
                Truth::True => found.fits.push(term),
                Truth::False => {}
                Truth::Undecided(reason) => found.undecided.push((term, reason)),
            }
        }
        if matches!(description.noun, Noun::SameNoun | Noun::SameThings) {
            found.fault = Some(UndecidedReason::NoAntecedent);
        }
        if description.noun.is_of_parts_alone() {
            found.fault = Some(UndecidedReason::PartOfThing);
        }
        if matches!(
            description.quantifier,
            Quantifier::The | Quantifier::ThePlural
        ) {
            self.keep_visible(&mut found);
        }
        if let Some(selection) = &description.selection {
            return self.apply_selection(selection, &found.fits);
        }
        found
    }

    /// Where a definite description fits several things and the listener sees some of them, keeps these: they are what is talked of.
    fn keep_visible(&self, found: &mut Extension) {
        let Some(viewer) = &self.listener.viewer else {
            return;
        };
        if found.fits.len() + found.undecided.len() < 2 {
            return;
        }
        let eye = viewer.world_from_camera.position;
        let is_visible = |term: &Term| match term {
            // "The bedroom" is the one that the listener is in.
            Term::Room(room) => self.scene.house().room_at(eye) == Some(*room),
            term => predicates::is_true(self.scene, "visible", &[*term], Some(viewer)),
        };
        let fits: Vec<Term> = found.fits.iter().copied().filter(is_visible).collect();
        if !fits.is_empty() {
            found.fits = fits;
            found.undecided.retain(|(term, _)| is_visible(term));
        }
    }

    /// The comparison of the numbers of two kinds of things; undecided where those that are undecided could turn it.
    pub(super) fn has_more(&self, more: &Description, than: &Description) -> WitnessedTruth {
        let (more, than) = (self.extension(more), self.extension(than));
        if let Some(reason) = more.fault.or(than.fault) {
            return WitnessedTruth::undecided(reason);
        }
        let undecided = more.undecided.iter().chain(&than.undecided);
        let least = more.fits.len() > than.fits.len() + than.undecided.len();
        let most = more.fits.len() + more.undecided.len() > than.fits.len();
        let reason = undecided.map(|(_, reason)| *reason).next();
        match reason {
            Some(reason) if least != most => WitnessedTruth::undecided(reason),
            _ => WitnessedTruth::without_witnesses(Truth::from(least)),
        }
    }

    /// The things that a noun can name.
    fn things_named(&self, noun: &Noun) -> Vec<Term> {
        match noun {
            Noun::Object(noun) => {
                let kinds = self.scene.distractors(noun);
                let things = kinds.things.iter().map(|id| Term::Object(*id));
                things.chain(self.persons_called(noun)).collect()
            }
            Noun::Structure(noun) => {
                let pieces = self.scene.house().structure.iter_ids();
                let own = pieces.filter(|(_, piece)| structure_noun(piece.kind) == Some(noun));
                own.map(|(id, _)| Term::Structure(id)).collect()
            }
            // Antecedents stand in their places where there are any.
            Noun::SameNoun | Noun::SameThings => Vec::new(),
            Noun::Storey => self.scene.house().levels.ids().map(Term::Storey).collect(),
            Noun::Room(noun) => {
                let rooms = self.scene.house().rooms.ids();
                let rooms = rooms.filter(|id| self.scene.semantics.room(*id).is_called(noun));
                rooms.map(Term::Room).collect()
            }
        }
    }

    /// The agents with the body of a person, where a person may be called `noun`.
    fn persons_called(&self, noun: &str) -> impl Iterator<Item = Term> {
        let row = categories().get("person");
        let is_called = row.is_some_and(|row| row.singular == noun || row.synonyms.contains(&noun));
        let agents = self.scene.state.agents.iter_ids();
        let persons = agents.filter(move |(_, agent)| is_called && agent.body.person.is_some());
        persons.map(|(id, _)| Term::Agent(id))
    }

    fn fits(&self, description: &Description, term: Term) -> Truth {
        let quality = |quality: Quality| self.has_quality(term, &quality).truth;
        let mut truth = Truth::True;
        let color = description.colors.iter().cloned().map(Quality::Color);
        let material = description.material.iter().cloned().map(Quality::Material);
        let size = description.size.map(Quality::Size);
        let state = description.state.iter().cloned().map(Quality::State);
        for own in color.chain(material).chain(size).chain(state) {
            // Nobody calls glass by a colour, or a sofa closed: "the brown table" is not the one of glass.
            truth = truth.and(match quality(own) {
                Truth::Undecided(
                    UndecidedReason::NoColor
                    | UndecidedReason::NoSwitch
                    | UndecidedReason::DoesNotOpen
                    | UndecidedReason::NoContainer,
                ) => Truth::False,
                decided => decided,
            });
        }
        for modifier in &description.modifiers {
            if truth.is_false() {
                break;
            }
            truth = truth.and(self.modifier_holds(modifier, term));
        }
        truth
    }

    fn modifier_holds(&self, modifier: &Modifier, term: Term) -> Truth {
        let Ok(predicate) = predicates::find(&modifier.predicate) else {
            return Truth::Undecided(UndecidedReason::UnknownPredicate);
        };
        if let Some(truth) = self.is_room_of_viewer(modifier, term) {
            return if modifier.negated { !truth } else { truth };
        }
        let body = |terms: &[Term]| {
            let truth = predicate.holds(self.scene, terms, self.listener.viewer.as_ref());
            WitnessedTruth::without_witnesses(truth)
        };
        let among_related = match &modifier.arguments[..] {
            [Phrase::Described(landmark)] if landmark.quantifier == Quantifier::Some => {
                self.is_related_to_some(predicate, term, landmark)
            }
            _ => None,
        };
        let truth = among_related.unwrap_or_else(|| {
            self.quantify(&modifier.arguments, &mut vec![term], &body)
                .truth
        });
        if modifier.negated { !truth } else { truth }
    }

    /// Returns whether a room is that of whoever looks, for "the room with you" where no agent is spoken to; `None` for all else.
    fn is_room_of_viewer(&self, modifier: &Modifier, term: Term) -> Option<Truth> {
        let is_meant = modifier.predicate == "room_contains"
            && modifier.arguments == [Phrase::Listener]
            && self.listener.agent.is_none();
        let viewer = self.listener.viewer.as_ref().filter(|_| is_meant)?;
        let eye = viewer.world_from_camera.position;
        let room = self.scene.house().room_at(eye).map(Term::Room);
        Some(Truth::from(room == Some(term)))
    }

    /// Returns whether `term` has a listed relation to something that a landmark fits, without a test of each of these: of few things
    /// there is one, and of the landmark there may be thousands. `None` for other relations, and where it does not take such things.
    fn is_related_to_some(
        &self,
        predicate: &dyn Predicate,
        term: Term,
        landmark: &Description,
    ) -> Option<Truth> {
        if !predicate.is_listed() || !predicate.takes(0, term.kind()) {
            return None;
        }
        let marks = self.extension(landmark);
        let undecided = marks.undecided.iter().map(|(mark, _)| mark);
        let mut all = marks.fits.iter().chain(undecided);
        if marks.fault.is_some() || !all.all(|mark| predicate.takes(1, mark.kind())) {
            return None;
        }
        let mut related = predicate.related(self.scene, term);
        related.sort_unstable();
        if related
            .iter()
            .any(|mark| marks.fits.binary_search(mark).is_ok())
        {
            return Some(Truth::True);
        }
        let place = |mark: &Term| {
            marks
                .undecided
                .binary_search_by_key(mark, |(known, _)| *known)
        };
        let reasons = related
            .iter()
            .filter_map(|mark| Some(marks.undecided[place(mark).ok()?].1));
        Some(reasons.fold(Truth::False, |truth, reason| {
            truth.or(Truth::Undecided(reason))
        }))
    }

    fn apply_selection(&self, selection: &OrdinalSelection, fits: &[Term]) -> Extension {
        let fault = |reason| Extension {
            fault: Some(reason),
            ..Extension::default()
        };
        let one = |term| Extension {
            fits: vec![term],
            ..Extension::default()
        };
        let place = selection.place as usize;
        if selection.order == OrdinalSelection::OF_HOUSE {
            return place
                .checked_sub(1)
                .and_then(|at| fits.get(at))
                .map_or_else(Extension::default, |term| one(*term));
        }
        let Ok(order) = selections::find(&selection.order) else {
            return fault(UndecidedReason::UnknownPredicate);
        };
        let reference = match selection.reference.as_deref() {
            None => None,
            Some(phrase) => match self.unique_referent(phrase) {
                Ok(term) => Some(term),
                Err(reason) => return fault(reason),
            },
        };
        let viewer = self.listener.viewer.as_ref();
        match order.select(self.scene, fits, place, reference, viewer) {
            Ok(term) => one(term),
            Err(UndecidedReason::TooFew) => Extension::default(),
            Err(reason) => fault(reason),
        }
    }

    /// The one thing that a phrase denotes.
    pub(super) fn unique_referent(&self, phrase: &Phrase) -> Result<Term, UndecidedReason> {
        if let Some(named) = self.direct_referent(phrase) {
            return named;
        }
        let Phrase::Described(description) = phrase else {
            return Err(UndecidedReason::UnknownTerm);
        };
        let extension = self.extension(description);
        match (extension.fault, &extension.fits[..]) {
            (Some(reason), _) => Err(reason),
            (None, [only]) => Ok(*only),
            // Who says "the white mug" where one is cream and none white means that one.
            (None, []) => match extension.undecided[..] {
                [(only, UndecidedReason::DividedColor)] => Ok(only),
                _ => Err(UndecidedReason::UnknownTerm),
            },
            (None, _) => Err(UndecidedReason::SeveralFit),
        }
    }
}
