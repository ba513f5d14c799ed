//! The predicate `between`.

use super::{
    Predicate, RelationProperties, THING,
    shape::{shape_of, share_room, vertical_overlap_m},
};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// Cosine of the least angle: 135 degrees.
const LARGEST_COSINE: f32 = -std::f32::consts::FRAC_1_SQRT_2;

/// See [`Predicate::definition`].
pub(super) struct Between;

impl Predicate for Between {
    fn name(&self) -> &'static str {
        "between"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[THING, THING, THING]
    }

    fn definition(&self) -> &'static str {
        "Seen from above, the directions from a thing's middle to the nearest points of two \
         others in the same room are at least 135 degrees apart; its middle lies over neither, \
         and it is no higher or lower than both of them."
    }

    fn source(&self) -> &'static str {
        "The angle after the directional template of T. Regier, L. A. Carlson, J. Exp. Psychol. \
         Gen. 130, 273 (2001): 45 degrees to each side."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            symmetric: true,
            irreflexive: true,
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        let (a, b, c) = (args[0], args[1], args[2]);
        if a == b || b == c || a == c || !share_room(scene, a, b) || !share_room(scene, a, c) {
            return Truth::False;
        }
        let (Some(p), Some(q), Some(r)) =
            (shape_of(scene, a), shape_of(scene, b), shape_of(scene, c))
        else {
            return Truth::False;
        };
        let middle = p.middle_xz();
        let towards = |outline: &crate::geometry::Hull| {
            let nearest = outline.nearest_point(middle)?;
            (nearest - middle).try_normalize()
        };
        let (Some(to_b), Some(to_c)) = (towards(&q.outline), towards(&r.outline)) else {
            return Truth::False;
        };
        let level = vertical_overlap_m(&p.bounds, &q.bounds.union(&r.bounds)) > 0.0;
        Truth::from(level && to_b.dot(to_c) <= LARGEST_COSINE)
    }
}
