//! In.

use super::{Laws, Predicate};
use crate::scene::{Scene, Term, Viewer};

/// `a` is in `b`: as [`dwell_scene::House::encloses`] has it, and `a` is not held. So a bowl, a drawer, a sink and a
/// shelf's compartment (open in front) contain things; a table does not contain what lies under it.
pub(super) struct Inside;

impl Predicate for Inside {
    fn name(&self) -> &'static str {
        "in"
    }

    fn words(&self) -> &'static str {
        "in"
    }

    fn laws(&self) -> Laws {
        Laws {
            irreflexive: true,
            antisymmetric: true,
            ..Laws::default()
        }
    }

    fn holds(&self, scene: &Scene<'_>, subject: Term, object: Term, _: Option<&Viewer>) -> bool {
        let (Term::Object(thing), Term::Object(container)) = (subject, object) else {
            return false;
        };
        if thing == container || scene.holder(thing).is_some() {
            return false;
        }
        let (inner, outer) = (scene.extent(thing).bounds, scene.extent(container).bounds);
        let house = scene.house();
        house.encloses(scene.state, container, &outer, &inner)
    }
}
