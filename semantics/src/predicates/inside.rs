//! In.

use super::{Predicate, RelationProperties};
use crate::scene::{SemanticScene, Term, Viewer};
use dwell_scene::{Aabb, House, ObjectId};

/// Largest number of things that a thing is in.
const MOST_AROUND: usize = 32;
/// Largest distance beside a container's box of the middle of its content, m: more than its brim.
const BESIDE_M: f32 = 0.025;

/// `a` is in `b`: as [`dwell_scene::House::encloses`] has it, and `a` is not held. So a bowl, a drawer, a sink and a
/// shelf's compartment (open in front) contain things; a table does not contain what lies under it. Where the boxes of more
/// than 32 things are around it, those about its middle count.
pub(super) struct Inside;

impl SemanticScene<'_> {
    /// Returns the containers of the object, rising; at most 32.
    pub(crate) fn containers(&self, object: ObjectId) -> &[ObjectId] {
        let around = &self.cache(object).around;
        around.get_or_init(|| containers(self, object))
    }
}

/// Returns the containers of `thing`, rising.
fn containers(scene: &SemanticScene<'_>, thing: ObjectId) -> Vec<ObjectId> {
    let inner = scene.extent(thing).bounds;
    if scene.holder(thing).is_some() || inner.is_empty() {
        return Vec::new();
    }
    // Four fifths of an edge hold its middle.
    let middle = inner.center();
    let reach = Aabb::new(middle, middle).grown(BESIDE_M + 1e-5 * middle.abs().max_element());
    let mut found = scene.within(&reach, MOST_AROUND, |other| {
        other != thing && House::fits_in(&scene.extent(other).bounds, &inner)
    });
    let house = scene.house();
    found.retain(|other| {
        let outer = scene.extent(*other).bounds;
        house.encloses(scene.state, *other, &outer, &inner)
    });
    found
}

impl Predicate for Inside {
    fn name(&self) -> &'static str {
        "in"
    }

    fn words(&self) -> &'static str {
        "in"
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            irreflexive: true,
            antisymmetric: true,
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
        let (Term::Object(thing), Term::Object(container)) = (subject, object) else {
            return false;
        };
        let (inner, outer) = (scene.extent(thing).bounds, scene.extent(container).bounds);
        thing != container
            && House::fits_in(&outer, &inner)
            && scene.containers(thing).binary_search(&container).is_ok()
    }

    fn related(&self, scene: &SemanticScene<'_>, subject: ObjectId) -> Vec<Term> {
        let around = scene.containers(subject).iter();
        around.map(|id| Term::Object(*id)).collect()
    }
}
