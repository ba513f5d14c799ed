//! Right of.

use super::left_of::LeftOf;
use super::{Predicate, RelationProperties};
use crate::scene::{SemanticScene, Term, Viewer};
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

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            antisymmetric: true,
            irreflexive: true,
            converse: Some("left_of"),
            ..RelationProperties::default()
        }
    }

    fn needs_viewer(&self) -> bool {
        true
    }

    fn holds(
        &self,
        scene: &SemanticScene<'_>,
        subject: Term,
        object: Term,
        viewer: Option<&Viewer>,
    ) -> bool {
        LeftOf.holds(scene, object, subject, viewer)
    }

    fn related(&self, _: &SemanticScene<'_>, _: ObjectId) -> Vec<Term> {
        Vec::new()
    }
}
