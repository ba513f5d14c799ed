//! Relations, used both to describe and to verify.
//!
//! To add one: a file here that implements [`Predicate`], and a line in [`all`].

mod hangs_on;
mod in_room;
mod inside;
mod left_of;
mod mount;
mod next_to;
mod on;
mod right_of;
mod support;

pub use crate::scene::SurfaceSupport;
pub(crate) use left_of::is_in_front;
pub(crate) use mount::mount_of;

use crate::error::SemanticsError;
use crate::scene::{SemanticScene, Term, Viewer};
use crate::semantics::Semantics;
use dwell_scene::{ObjectId, State};

/// The properties of a relation that always hold; checked for every relation by the tests.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "the laws are independent of each other"
)]
pub struct RelationProperties {
    /// r(a, b) gives r(b, a).
    pub symmetric: bool,
    /// r(a, b) excludes r(b, a).
    pub antisymmetric: bool,
    /// Nothing has it to itself.
    pub irreflexive: bool,
    /// r(a, b) and r(a, c) give b = c.
    pub functional: bool,
    /// The name of the relation s with r(a, b) exactly when s(b, a).
    pub converse: Option<&'static str>,
}

/// A relation between two things.
pub trait Predicate: Sync {
    /// The name, in letters and underscores.
    fn name(&self) -> &'static str;

    /// The words between subject and object: "the cup is **on** the table".
    fn words(&self) -> &'static str;

    /// Returns the properties that always hold of it.
    fn properties(&self) -> RelationProperties;

    /// Returns whether it depends on a viewer.
    fn needs_viewer(&self) -> bool {
        false
    }

    /// Returns whether it holds. `false` for kinds of things outside its domain, and without the viewer that it needs.
    fn holds(
        &self,
        scene: &SemanticScene<'_>,
        subject: Term,
        object: Term,
        viewer: Option<&Viewer>,
    ) -> bool;

    /// All terms to which `subject` has it without a viewer, each once: those for which [`Self::holds`] is true, without a test
    /// for each.
    fn related(&self, scene: &SemanticScene<'_>, subject: ObjectId) -> Vec<Term>;
}

/// Every relation.
pub fn all() -> &'static [&'static dyn Predicate] {
    &[
        &in_room::InRoom,
        &inside::Inside,
        &on::On,
        &hangs_on::HangsOn,
        &next_to::NextTo,
        &left_of::LeftOf,
        &right_of::RightOf,
    ]
}

/// The objects that `subject` has a relation to, rising.
pub(crate) fn related_objects(
    scene: &SemanticScene<'_>,
    predicate: &dyn Predicate,
    subject: ObjectId,
) -> Vec<ObjectId> {
    let terms = predicate.related(scene, subject).into_iter();
    let mut objects: Vec<ObjectId> = terms.filter_map(Term::object).collect();
    objects.sort_unstable();
    objects
}

/// The relation called `name`.
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
    /// Returns whether the relation `predicate` holds between two things.
    ///
    /// # Errors
    /// [`SemanticsError::UnknownPredicate`] for a name that [`all`] lacks.
    pub fn evaluate(
        &self,
        state: &State,
        predicate: &str,
        subject: Term,
        object: Term,
        viewer: Option<&Viewer>,
    ) -> Result<bool, SemanticsError> {
        Ok(find(predicate)?.holds(&self.scene(state), subject, object, viewer))
    }
}
