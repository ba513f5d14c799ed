//! The predicate `around`.

use super::shape::{gap_m, vertical_overlap_m};
use super::{OBJECT, Predicate, RelationProperties, mount::mount_of};
use crate::geometry::Extent;
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;
use glam::Vec2;

/// The largest gap to what a thing stands around, m.
const AROUND_GAP_M: f32 = 0.6;

/// See [`Predicate::definition`].
pub(super) struct Around;

impl Predicate for Around {
    fn name(&self) -> &'static str {
        "around"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT, OBJECT]
    }

    fn definition(&self) -> &'static str {
        "Each of the things around a landmark is in one room with it, neither of them held, and its \
         box has a largest face no larger than the landmark's. Either both hang, at most 0.6 m \
         apart; or their outlines from above are at most 0.6 m apart, their heights overlap, and \
         the middle of neither is within the other's outline: a chair pushed under the edge of a \
         table is around it."
    }

    fn source(&self) -> &'static str {
        "Within an arm's length on any side; the larger one is the landmark (L. Talmy, How Language \
         Structures Space, in Spatial Orientation, Plenum 1983)."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            irreflexive: true,
            excludes: &["far"],
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        let (Term::Object(a), Term::Object(b)) = (args[0], args[1]) else {
            return Truth::False;
        };
        if a == b || scene.holder(a).is_some() || scene.holder(b).is_some() {
            return Truth::False;
        }
        let (p, q) = (scene.extent(a), scene.extent(b));
        if !p.bounds.grown(AROUND_GAP_M).intersects(&q.bounds) {
            return Truth::False;
        }
        let area_m2 = |own: &Extent| {
            let size = own.bounds.size();
            (size.x * size.y).max(size.y * size.z).max(size.z * size.x)
        };
        let covers = |outer: &Extent, inner: &Extent| {
            let middle = inner.bounds.center();
            outer.footprint.contains(Vec2::new(middle.x, middle.z))
        };
        let [on_wall, on_wall_too] = [a, b].map(|id| mount_of(scene, id).is_some());
        let gap_m = if on_wall && on_wall_too {
            gap_m(scene, args[0], args[1]).unwrap_or(f32::INFINITY)
        } else if vertical_overlap_m(&p.bounds, &q.bounds) > 0.0 {
            p.footprint.distance(&q.footprint)
        } else {
            return Truth::False;
        };
        let is_beside = (on_wall && on_wall_too) || !covers(p, q) && !covers(q, p);
        Truth::from(
            gap_m <= AROUND_GAP_M
                && is_beside
                && scene.room_of(a) == scene.room_of(b)
                && area_m2(p) <= area_m2(q),
        )
    }
}
