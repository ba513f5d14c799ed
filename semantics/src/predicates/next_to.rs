//! Next to.

use super::{Predicate, RelationProperties, on::On};
use crate::scene::{MOST_NEAR, SemanticScene, Term, Viewer};
use dwell_scene::interrupt;
use dwell_scene::{Aabb, ObjectId};

/// The largest gap between neighbours, m.
const NEIGHBOUR_GAP_M: f32 = 0.5;

/// `a` is next to `b`: two objects in the same room whose outlines from above are at most 0.5 m apart, whose heights overlap by at
/// least half of the lower one, neither of which carries or contains the other, and none of which is held. Outlines that
/// overlap by more than half of the smaller one stand above each other rather than side by side, and do not count. Where more
/// than 128 things are so near, those about the middle count, and only if it is so both ways.
pub(super) struct NextTo;

/// Returns the overlap of two boxes' heights, m, and the overlap that is needed.
fn shared_m(p: &Aabb, q: &Aabb) -> (f32, f32) {
    let shared = p.max.y.min(q.max.y) - p.min.y.max(q.min.y);
    (shared, 0.5 * p.size().y.min(q.size().y))
}

impl SemanticScene<'_> {
    /// Returns the candidates next to the object, rising; at most [`MOST_NEAR`] things.
    pub(crate) fn neighbour_candidates(&self, object: ObjectId) -> &[ObjectId] {
        let near = &self.cache(object).near;
        near.get_or_init(|| neighbour_candidates(self, object))
    }

    /// Returns the neighbours of the object, rising.
    pub(crate) fn neighbours(&self, object: ObjectId) -> &[ObjectId] {
        let beside = &self.cache(object).beside;
        beside.get_or_init(|| neighbours(self, object))
    }
}

/// Returns the candidates next to `object`, rising.
fn neighbour_candidates(scene: &SemanticScene<'_>, object: ObjectId) -> Vec<ObjectId> {
    let own = scene.extent(object).bounds;
    scene.within(&own.grown(NEIGHBOUR_GAP_M), MOST_NEAR, |other| {
        let (shared, least) = shared_m(&own, &scene.extent(other).bounds);
        other != object && shared >= least && scene.holder(other).is_none()
    })
}

/// Returns the neighbours of `object`, rising.
fn neighbours(scene: &SemanticScene<'_>, object: ObjectId) -> Vec<ObjectId> {
    interrupt::check();
    let holds = |other: &ObjectId| {
        let (a, b) = (Term::Object(object), Term::Object(*other));
        NextTo.holds(scene, a, b, None)
    };
    let near = scene.neighbour_candidates(object).iter().copied();
    near.filter(holds).collect()
}

/// Returns whether `other` is among the candidates next to `object`, where these are more than count.
fn counts(scene: &SemanticScene<'_>, object: ObjectId, other: ObjectId) -> bool {
    let near = scene.neighbour_candidates(object);
    near.len() < MOST_NEAR || near.binary_search(&other).is_ok()
}

fn stacked(scene: &SemanticScene<'_>, a: ObjectId, b: ObjectId) -> bool {
    let (a, b) = (Term::Object(a), Term::Object(b));
    [(a, b), (b, a)]
        .into_iter()
        .any(|(p, q)| On.holds(scene, p, q, None) || super::inside::Inside.holds(scene, p, q, None))
}

impl Predicate for NextTo {
    fn name(&self) -> &'static str {
        "next_to"
    }

    fn words(&self) -> &'static str {
        "next to"
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            symmetric: true,
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
        let (Term::Object(a), Term::Object(b)) = (subject, object) else {
            return false;
        };
        if a == b || scene.holder(a).is_some() || scene.holder(b).is_some() {
            return false;
        }
        let (p, q) = (scene.extent(a), scene.extent(b));
        if !p.bounds.grown(NEIGHBOUR_GAP_M).intersects(&q.bounds) {
            return false;
        }
        let (shared, least) = shared_m(&p.bounds, &q.bounds);
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
            && counts(scene, a, b)
            && counts(scene, b, a)
            && !stacked(scene, a, b)
    }

    fn related(&self, scene: &SemanticScene<'_>, subject: ObjectId) -> Vec<Term> {
        let beside = scene.neighbours(subject).iter();
        beside.map(|id| Term::Object(*id)).collect()
    }
}
