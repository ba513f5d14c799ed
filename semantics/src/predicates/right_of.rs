//! Right of.

use super::left_of::LeftOf;
use super::{Laws, Predicate};
use crate::scene::{Scene, Term, Viewer};
use dwell_scene::ObjectId;

/// `a` is right of `b` for a viewer exactly when `b` is left of `a` for it.
pub(super) struct RightOf;

impl Predicate for RightOf {
    fn name(&self) -> &'static str {
        "right_of"
    }

    fn words(&self) -> &'static str {
        "to the right of"
    }

    fn laws(&self) -> Laws {
        Laws {
            antisymmetric: true,
            irreflexive: true,
            converse: Some("left_of"),
            ..Laws::default()
        }
    }

    fn needs_viewer(&self) -> bool {
        true
    }

    fn holds(
        &self,
        scene: &Scene<'_>,
        subject: Term,
        object: Term,
        viewer: Option<&Viewer>,
    ) -> bool {
        LeftOf.holds(scene, object, subject, viewer)
    }

    fn related(&self, _: &Scene<'_>, _: ObjectId) -> Vec<Term> {
        Vec::new()
    }
}
