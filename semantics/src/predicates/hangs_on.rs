//! Hangs on a wall, from a ceiling, or before a window.

use super::mount::{hangs_on, mounts};
use super::{Predicate, RelationProperties};
use crate::scene::{SemanticScene, Term, Viewer};
use dwell_scene::ObjectId;

/// `a` hangs on `b`: nothing carries `a` from below, and `b` is a wall, at whose height it is, 10 cm above its foot or
/// higher (cloth reaches the floor), with its outline from above at most 6 cm away; or a ceiling over it, 6 cm from
/// its top at most; or, for curtains and blinds, a window in the same room and at the same height, 0.3 m away at most.
pub(super) struct HangsOn;

impl Predicate for HangsOn {
    fn name(&self) -> &'static str {
        "hangs_on"
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
        hangs_on(scene, thing, object)
    }

    fn related(&self, scene: &SemanticScene<'_>, subject: ObjectId) -> Vec<Term> {
        mounts(scene, subject)
    }
}
