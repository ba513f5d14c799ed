//! Predicates: what can be true of things. Language is generated and checked by the same definitions.
//!
//! To add one: a file here that implements [`Predicate`], and a line in [`all`].

mod above;
mod against;
mod around;
mod at_back_of;
mod at_end_of;
mod at_front_of;
mod attached_to;
mod behind;
mod belongs_to;
mod below;
mod between;
mod checked;
mod closed;
mod closer_to;
mod container;
mod contains;
mod dark;
mod doors;
mod empty;
mod facing;
mod far;
mod front;
mod full;
mod half_open;
mod hanging;
mod hangs_on;
mod has;
mod held;
mod held_by;
mod holds;
mod identical;
mod in_corner_of;
mod in_front_of;
mod in_middle_of;
mod in_room;
mod inside;
mod larger_than;
mod leads_from;
mod leads_outside;
mod leads_to;
mod left_of;
mod long;
mod low;
mod mount;
mod narrow;
mod near;
mod next_to;
mod on;
mod on_left;
mod on_right;
mod on_storey;
mod open;
mod open_to;
mod openness;
mod opposite;
mod patterned;
mod places;
mod proportions;
mod reachable;
mod right_of;
mod room_contains;
mod round;
mod same_color;
mod same_kind;
mod same_material;
mod shape;
mod straight_ahead;
mod striped;
mod support;
mod supports;
mod switched_off;
mod switched_on;
mod tall;
mod taller_than;
mod touching;
mod triangle_distance;
mod under;
mod view;
mod visible;
mod visible_from;
mod visible_from_room;
mod wide;
mod wider_than;

pub use crate::scene::SupportShare;
pub(crate) use left_of::LEAST_TANGENT;
pub(crate) use mount::mount_of;
pub(crate) use shape::{bounds_of, gap_m};
pub(crate) use view::{image_x, is_in_front};

use crate::error::SemanticsError;
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::semantics::Semantics;
use crate::truth::{Truth, UndecidedReason};
use dwell_scene::{ObjectId, State};

/// The algebraic properties of a relation, which the tests check for every relation. Those of a ternary relation are meant of its
/// last two arguments.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "the laws are independent of each other"
)]
pub struct RelationProperties {
    /// r(a, b) implies r(b, a).
    pub symmetric: bool,
    /// r(a, b) excludes r(b, a).
    pub antisymmetric: bool,
    /// r(a, a) is never true.
    pub irreflexive: bool,
    /// r(a, a) is true wherever it is decided.
    pub reflexive: bool,
    /// r(a, b) and r(b, c) imply r(a, c).
    pub transitive: bool,
    /// r(a, b) and r(a, c) imply b = c.
    pub functional: bool,
    /// The name of the converse relation s: r(a, b) exactly when s(b, a).
    pub converse: Option<&'static str>,
    /// The names of predicates that never hold of the same arguments.
    pub excludes: &'static [&'static str],
}

impl RelationProperties {
    /// The names of the properties: "symmetric", "converse of `left_of`".
    pub fn names(&self) -> Vec<String> {
        let flags = [
            (self.symmetric, "symmetric"),
            (self.antisymmetric, "antisymmetric"),
            (self.irreflexive, "irreflexive"),
            (self.reflexive, "reflexive"),
            (self.transitive, "transitive"),
            (self.functional, "functional"),
        ];
        let flags = flags.into_iter().filter(|(held, _)| *held);
        let mut names: Vec<String> = flags.map(|(_, name)| name.to_owned()).collect();
        names.extend(self.converse.map(|name| format!("converse of {name}")));
        names.extend(self.excludes.iter().map(|name| format!("excludes {name}")));
        names
    }
}

/// A truth-valued function of one to three things in a state.
pub trait Predicate: Sync {
    /// The name, in letters and underscores.
    fn name(&self) -> &'static str;

    /// The words between subject and object: "the cup is **on** the table". Empty for predicates that sentences express otherwise.
    fn words(&self) -> &'static str {
        ""
    }

    /// The kinds of things that each argument takes, the subject first.
    fn argument_kinds(&self) -> &'static [&'static [TermKind]];

    /// The number of arguments, 1 to 3.
    fn arity(&self) -> usize {
        self.argument_kinds().len()
    }

    /// The definition: when it holds, in one sentence with thresholds and units.
    fn definition(&self) -> &'static str;

    /// The source of definition and thresholds.
    fn source(&self) -> &'static str;

    /// Returns its algebraic properties.
    fn properties(&self) -> RelationProperties {
        RelationProperties::default()
    }

    /// Returns whether it depends on a viewer.
    fn needs_viewer(&self) -> bool {
        false
    }

    /// Returns whether tables of relations list it by default: it takes two arguments and no viewer, a thing has it to few others,
    /// [`Self::related`] finds these without a test of each pair, and it is decided of all arguments of the kinds in [`Self::argument_kinds`].
    fn is_listed(&self) -> bool {
        false
    }

    /// Evaluates it for arguments that exist and are of the kinds in [`Self::argument_kinds`], with a viewer if it needs one.
    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], viewer: Option<&Viewer>) -> Truth;

    /// Returns whether it holds of `args`, the subject first. Undecided for kinds of things that it is not defined for, and without
    /// a viewer that it needs.
    fn holds(&self, scene: &SemanticScene<'_>, args: &[Term], viewer: Option<&Viewer>) -> Truth {
        if args.len() != self.arity() {
            return Truth::Undecided(UndecidedReason::WrongCount);
        }
        for (term, kinds) in args.iter().zip(self.argument_kinds()) {
            if !kinds.contains(&term.kind()) {
                return Truth::Undecided(UndecidedReason::WrongKind);
            }
            if !term.exists(scene.house(), scene.state) {
                return Truth::Undecided(UndecidedReason::UnknownTerm);
            }
        }
        if self.needs_viewer() && viewer.is_none() {
            return Truth::Undecided(UndecidedReason::NoViewer);
        }
        self.decide(scene, args, viewer)
    }

    /// Returns whether it takes a thing of kind `kind` at a place, from 0.
    fn takes(&self, place: usize, kind: TermKind) -> bool {
        let kinds = self.argument_kinds().get(place);
        kinds.is_some_and(|kinds| kinds.contains(&kind))
    }

    /// Returns the objects, structure pieces, rooms, storeys and agents b for which it holds of (`subject`, b), each once. A
    /// predicate that [`Self::is_listed`] finds them without a test of each pair. Empty for predicates that do not take two
    /// arguments or need a viewer.
    fn related(&self, scene: &SemanticScene<'_>, subject: Term) -> Vec<Term> {
        if self.arity() != 2 || self.needs_viewer() {
            return Vec::new();
        }
        let holds = |term: &Term| self.holds(scene, &[subject, *term], None).is_true();
        scene.terms().filter(holds).collect()
    }
}

const OBJECT: &[TermKind] = &[TermKind::Object];
const ROOM: &[TermKind] = &[TermKind::Room];
const AGENT: &[TermKind] = &[TermKind::Agent];
const OBJECT_OR_AGENT: &[TermKind] = &[TermKind::Object, TermKind::Agent];
const OBJECT_OR_STRUCTURE: &[TermKind] = &[TermKind::Object, TermKind::Structure];
const OBJECT_OR_ROOM: &[TermKind] = &[TermKind::Object, TermKind::Room];
/// The kinds of things that have a middle and an outline.
const THING: &[TermKind] = &[TermKind::Object, TermKind::Structure, TermKind::Agent];

/// All predicates.
pub fn all() -> &'static [&'static dyn Predicate] {
    &[
        &in_room::InRoom,
        &room_contains::RoomContains,
        &on_storey::OnStorey,
        &open_to::OpenTo,
        &leads_to::LeadsTo,
        &leads_from::LeadsFrom,
        &leads_outside::LeadsOutside,
        &inside::Inside,
        &contains::Contains,
        &on::On,
        &supports::Supports,
        &belongs_to::BelongsTo,
        &has::Has,
        &hangs_on::HangsOn,
        &hanging::Hanging,
        &attached_to::AttachedTo,
        &touching::Touching,
        &against::Against,
        &next_to::NextTo,
        &near::Near,
        &closer_to::CloserTo,
        &around::Around,
        &far::Far,
        &above::Above,
        &below::Below,
        &under::Under,
        &between::Between,
        &in_corner_of::InCornerOf,
        &in_middle_of::InMiddleOf,
        &at_end_of::AtEndOf,
        &left_of::LeftOf,
        &right_of::RightOf,
        &in_front_of::InFrontOf,
        &behind::Behind,
        &on_left::OnViewersLeft,
        &straight_ahead::StraightAhead,
        &on_right::OnViewersRight,
        &at_front_of::AtFrontOf,
        &at_back_of::AtBackOf,
        &facing::Facing,
        &opposite::Opposite,
        &visible::Visible,
        &visible_from::VisibleFrom,
        &visible_from_room::VisibleFromRoom,
        &reachable::Reachable,
        &holds::Holds,
        &held_by::HeldBy,
        &held::Held,
        &identical::Identical,
        &same_kind::SameKind,
        &same_color::SameColor,
        &same_material::SameMaterial,
        &larger_than::LargerThan,
        &taller_than::TallerThan,
        &wider_than::WiderThan,
        &open::Open,
        &half_open::HalfOpen,
        &closed::Closed,
        &switched_on::SwitchedOn,
        &switched_off::SwitchedOff,
        &full::Full,
        &empty::Empty,
        &tall::Tall,
        &low::Low,
        &wide::Wide,
        &narrow::Narrow,
        &long::Long,
        &round::Round,
        &striped::Striped,
        &checked::Checkered,
        &patterned::Patterned,
        &dark::Dark,
    ]
}

/// Returns the objects to which `subject` has a relation, ascending.
pub(crate) fn related_objects(
    scene: &SemanticScene<'_>,
    predicate: &dyn Predicate,
    subject: ObjectId,
) -> Vec<ObjectId> {
    let terms = predicate.related(scene, Term::Object(subject)).into_iter();
    let mut objects: Vec<ObjectId> = terms.filter_map(Term::object).collect();
    objects.sort_unstable();
    objects
}

/// Returns whether the predicate called `name` is true of `terms`; false of a name that there is not.
pub(crate) fn is_true(
    scene: &SemanticScene<'_>,
    name: &str,
    terms: &[Term],
    viewer: Option<&Viewer>,
) -> bool {
    find(name).is_ok_and(|predicate| predicate.holds(scene, terms, viewer).is_true())
}

/// The predicate called `name`.
///
/// # Errors
/// [`SemanticsError::UnknownPredicate`] lists those that exist.
pub fn find(name: &str) -> Result<&'static dyn Predicate, SemanticsError> {
    let known = || all().iter().map(|predicate| predicate.name()).collect();
    all()
        .iter()
        .find(|predicate| predicate.name() == name)
        .copied()
        .ok_or_else(|| SemanticsError::UnknownPredicate {
            name: name.to_owned(),
            known: known(),
        })
}

impl Semantics {
    /// Returns whether the predicate called `predicate` holds of `args`.
    ///
    /// # Errors
    /// [`SemanticsError::UnknownPredicate`] for a name that [`all`] lacks.
    pub fn evaluate(
        &self,
        state: &State,
        predicate: &str,
        args: &[Term],
        viewer: Option<&Viewer>,
    ) -> Result<Truth, SemanticsError> {
        Ok(find(predicate)?.holds(&self.scene(state), args, viewer))
    }
}
