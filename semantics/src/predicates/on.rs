//! On.

use super::support::REST_SHARE;
use super::{Predicate, RelationProperties};
use crate::scene::{SemanticScene, Term, Viewer};
use dwell_scene::ObjectId;

/// `a` is on `b`: at least a third of `a`'s sole (the faces of its lowest 2 cm) rests directly on `b`, an object or a
/// structure piece: `b` has the highest surface flatter than 60 degrees within 3 cm of those points. Nothing that is
/// held is on anything, or carries anything.
pub(super) struct On;

impl Predicate for On {
    fn name(&self) -> &'static str {
        "on"
    }

    fn words(&self) -> &'static str {
        "on"
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            irreflexive: true,
            ..RelationProperties::default()
        }
    }

    fn holds(
        &self,
        scene: &SemanticScene<'_>,
        subject: Term,
        object: Term,
        _: Option<&Viewer>,
    ) -> bool {
        let Term::Object(thing) = subject else {
            return false;
        };
        scene
            .supports(thing)
            .iter()
            .any(|support| support.by == object && support.share >= REST_SHARE)
    }

    fn related(&self, scene: &SemanticScene<'_>, subject: ObjectId) -> Vec<Term> {
        let supports = scene.supports(subject).iter();
        let carries = supports.filter(|support| support.share >= REST_SHARE);
        carries.map(|support| support.by).collect()
    }
}
