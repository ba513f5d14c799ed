//! The predicate `in`.

use super::{OBJECT, Predicate, RelationProperties};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;
use dwell_scene::{Aabb, House, ObjectId};

/// Largest number of containers around a thing.
const MOST_AROUND: usize = 32;
/// The largest distance beside a container's box of the middle of its contents, m: more than the width of its brim.
pub(super) const BESIDE_M: f32 = 0.025;

impl SemanticScene<'_> {
    /// Returns the things around the object, ascending; at most 32. It is in those of them that are not lain upon.
    pub(crate) fn containers(&self, object: ObjectId) -> &[ObjectId] {
        let around = &self.cache(object).around;
        around.get_or_init(|| containers(self, object))
    }
}

/// Returns the things around `thing`, ascending.
fn containers(scene: &SemanticScene<'_>, thing: ObjectId) -> Vec<ObjectId> {
    let inner = scene.extent(thing).bounds;
    if scene.holder(thing).is_some() || inner.is_empty() {
        return Vec::new();
    }
    // Four fifths of an edge hold its middle.
    let middle = inner.center();
    let reach = Aabb::new(middle, middle).grown(BESIDE_M + 1e-5 * middle.abs().max_element());
    let mut found = scene.objects_near(&reach, MOST_AROUND, |other| {
        other != thing && House::fits_in(&scene.extent(other).bounds, &inner)
    });
    let house = scene.house();
    found.retain(|other| {
        let outer = scene.extent(*other).bounds;
        house.encloses(scene.state, *other, &outer, &inner)
    });
    found
}

/// Returns whether `thing` is in `container`.
pub(super) fn is_in(scene: &SemanticScene<'_>, thing: ObjectId, container: ObjectId) -> bool {
    let (inner, outer) = (scene.extent(thing).bounds, scene.extent(container).bounds);
    thing != container
        && House::fits_in(&outer, &inner)
        && scene.containers(thing).binary_search(&container).is_ok()
        && !scene.is_seat_or_bed(container)
}

/// See [`Predicate::definition`] and [`dwell_scene::House::encloses`]. Where the boxes of more than 32 things are around it, those
/// about its middle count.
pub(super) struct Inside;

impl Predicate for Inside {
    fn name(&self) -> &'static str {
        "in"
    }

    fn words(&self) -> &'static str {
        "in"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT, OBJECT]
    }

    fn definition(&self) -> &'static str {
        "A thing that is not held has four fifths of its box in the larger box of another (grown \
         by 0.02 m), and its middle lies in a space of the other that is marked as holding things \
         inside, or four of the five rays from its middle to the four sides and down meet the \
         other; seats and beds without such a space hold nothing: what lies there is on them."
    }

    fn source(&self) -> &'static str {
        "Chosen here; containment after A. Herskovits, Language and Spatial Cognition, Cambridge \
         1986."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            antisymmetric: true,
            irreflexive: true,
            converse: Some("contains"),
            excludes: &["on", "above", "under"],
            ..RelationProperties::default()
        }
    }

    fn is_listed(&self) -> bool {
        true
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        let (Term::Object(thing), Term::Object(container)) = (args[0], args[1]) else {
            return Truth::False;
        };
        Truth::from(is_in(scene, thing, container))
    }

    fn related(&self, scene: &SemanticScene<'_>, subject: Term) -> Vec<Term> {
        let Term::Object(thing) = subject else {
            return Vec::new();
        };
        let around = scene.containers(thing).iter();
        let holding = around.filter(|id| !scene.is_seat_or_bed(**id));
        holding.map(|id| Term::Object(*id)).collect()
    }
}
