//! The predicate `next_to`.

use super::{OBJECT, Predicate, RelationProperties, on::On, shape::vertical_overlap_m};
use crate::scene::MOST_NEAR;
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;
use dwell_scene::{Aabb, ObjectId, interrupt};

/// The largest gap between neighbours, m.
const NEIGHBOUR_GAP_M: f32 = 0.5;

/// Returns the vertical overlap of two boxes and the least that neighbours have, m.
fn vertical_overlap_and_minimum_m(p: &Aabb, q: &Aabb) -> (f32, f32) {
    (vertical_overlap_m(p, q), 0.5 * p.size().y.min(q.size().y))
}

impl SemanticScene<'_> {
    /// Returns the candidates for neighbours of the object, ascending; at most [`MOST_NEAR`] things.
    pub(crate) fn neighbour_candidates(&self, object: ObjectId) -> &[ObjectId] {
        let near = &self.cache(object).near;
        near.get_or_init(|| neighbour_candidates(self, object))
    }

    /// Returns the neighbours of the object, ascending.
    pub(crate) fn neighbours(&self, object: ObjectId) -> &[ObjectId] {
        let beside = &self.cache(object).beside;
        beside.get_or_init(|| neighbours(self, object))
    }
}

/// Returns the candidates for neighbours of `object`, ascending.
fn neighbour_candidates(scene: &SemanticScene<'_>, object: ObjectId) -> Vec<ObjectId> {
    let own = scene.extent(object).bounds;
    scene.objects_near(&own.grown(NEIGHBOUR_GAP_M), MOST_NEAR, |other| {
        let (shared, least) = vertical_overlap_and_minimum_m(&own, &scene.extent(other).bounds);
        other != object && shared >= least && scene.holder(other).is_none()
    })
}

/// Returns the neighbours of `object`, ascending.
fn neighbours(scene: &SemanticScene<'_>, object: ObjectId) -> Vec<ObjectId> {
    interrupt::unwind_if_cancelled();
    let near = scene.neighbour_candidates(object).iter().copied();
    near.filter(|other| is_next_to(scene, object, *other))
        .collect()
}

/// Returns whether `other` is among the candidates for neighbours of `object`, or these were not limited in number.
fn is_neighbour_candidate(scene: &SemanticScene<'_>, object: ObjectId, other: ObjectId) -> bool {
    let near = scene.neighbour_candidates(object);
    near.len() < MOST_NEAR || near.binary_search(&other).is_ok()
}

/// Returns whether one of two things carries the other or is around it.
fn stacked(scene: &SemanticScene<'_>, a: ObjectId, b: ObjectId) -> bool {
    [(a, b), (b, a)].into_iter().any(|(p, q)| {
        let terms = [Term::Object(p), Term::Object(q)];
        On.decide(scene, &terms, None).is_true() || scene.containers(p).binary_search(&q).is_ok()
    })
}

fn is_next_to(scene: &SemanticScene<'_>, a: ObjectId, b: ObjectId) -> bool {
    if a == b || scene.holder(a).is_some() || scene.holder(b).is_some() {
        return false;
    }
    let (p, q) = (scene.extent(a), scene.extent(b));
    if !p.bounds.grown(NEIGHBOUR_GAP_M).intersects(&q.bounds) {
        return false;
    }
    let (shared, least) = vertical_overlap_and_minimum_m(&p.bounds, &q.bounds);
    if shared < least {
        return false;
    }
    let above = || {
        p.footprint.overlap_m2(&q.footprint)
            > 0.5 * p.footprint.area_m2().min(q.footprint.area_m2())
    };
    p.footprint.distance(&q.footprint) <= NEIGHBOUR_GAP_M
        && !above()
        && scene.room_of(a) == scene.room_of(b)
        && is_neighbour_candidate(scene, a, b)
        && is_neighbour_candidate(scene, b, a)
        && !stacked(scene, a, b)
}

/// See [`Predicate::definition`].
pub(super) struct NextTo;

impl Predicate for NextTo {
    fn name(&self) -> &'static str {
        "next_to"
    }

    fn words(&self) -> &'static str {
        "next to"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT, OBJECT]
    }

    fn definition(&self) -> &'static str {
        "Two objects in one room, neither of them held, have outlines from above that are at most \
         0.5 m apart and heights that overlap by at least half of the lower one; neither carries \
         or contains the other, and their outlines do not overlap by more than half of the \
         smaller one. Where more than 128 things are so near, those about the middle count, and \
         only if it is so both ways."
    }

    fn source(&self) -> &'static str {
        "Chosen here: within arm's length of each other, side by side."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            symmetric: true,
            irreflexive: true,
            excludes: &["on", "in", "far"],
            ..RelationProperties::default()
        }
    }

    fn is_listed(&self) -> bool {
        true
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        let (Term::Object(a), Term::Object(b)) = (args[0], args[1]) else {
            return Truth::False;
        };
        Truth::from(is_next_to(scene, a, b))
    }

    fn related(&self, scene: &SemanticScene<'_>, subject: Term) -> Vec<Term> {
        let Term::Object(object) = subject else {
            return Vec::new();
        };
        let beside = scene.neighbours(object).iter();
        beside.map(|id| Term::Object(*id)).collect()
    }
}
