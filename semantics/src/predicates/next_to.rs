//! Next to.

use super::{Laws, Predicate, on::On};
use crate::scene::{Scene, Term, Viewer};
use dwell_scene::ObjectId;

/// The largest gap between neighbours, m.
const NEIGHBOUR_GAP_M: f32 = 0.5;

/// `a` is next to `b`: two objects in the same room whose outlines from above are at most 0.5 m apart, whose heights overlap by at
/// least half of the lower one, neither of which carries or contains the other, and none of which is held. Outlines that
/// overlap by more than half of the smaller one stand above each other rather than side by side, and do not count.
pub(super) struct NextTo;

fn stacked(scene: &Scene<'_>, a: ObjectId, b: ObjectId) -> bool {
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

    fn laws(&self) -> Laws {
        Laws {
            symmetric: true,
            irreflexive: true,
            ..Laws::default()
        }
    }

    fn holds(&self, scene: &Scene<'_>, subject: Term, object: Term, _: Option<&Viewer>) -> bool {
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
        let shared = p.bounds.max.y.min(q.bounds.max.y) - p.bounds.min.y.max(q.bounds.min.y);
        let lower = p.bounds.size().y.min(q.bounds.size().y);
        let above = p.footprint.overlap_m2(&q.footprint)
            > 0.5 * p.footprint.area_m2().min(q.footprint.area_m2());
        shared >= 0.5 * lower
            && !above
            && p.footprint.distance(&q.footprint) <= NEIGHBOUR_GAP_M
            && scene.room_of(a) == scene.room_of(b)
            && !stacked(scene, a, b)
    }
}
