//! The predicate `above`.

use super::{
    Predicate, RelationProperties, THING,
    shape::{shape_of, share_room},
};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// The least gap, m: a thing that is nearer rests on the other.
const LEAST_M: f32 = 0.03;
/// The least overlap of the outlines, as share of the smaller one.
const SHARE: f32 = 1.0 / 3.0;

/// See [`Predicate::definition`].
pub(super) struct Above;

impl Predicate for Above {
    fn name(&self) -> &'static str {
        "above"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[THING, THING]
    }

    fn definition(&self) -> &'static str {
        "The lowest point of a thing is more than 0.03 m higher than the highest of another in \
         the same room, and their outlines from above share at least a third of the smaller one."
    }

    fn source(&self) -> &'static str {
        "The region of good examples in G. D. Logan, D. D. Sadler, in Language and Space, MIT \
         Press 1996, pp. 493-529; 0.03 m is the gap up to which a thing rests on another."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            antisymmetric: true,
            irreflexive: true,
            converse: Some("below"),
            excludes: &["below", "on", "in", "under"],
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        let (Some(p), Some(q)) = (shape_of(scene, args[0]), shape_of(scene, args[1])) else {
            return Truth::False;
        };
        if p.bounds.min.y - q.bounds.max.y <= LEAST_M || !share_room(scene, args[0], args[1]) {
            return Truth::False;
        }
        let smaller = p.outline.area_m2().min(q.outline.area_m2());
        let above = if smaller > 1e-6 {
            p.outline.overlap_m2(&q.outline) >= SHARE * smaller
        } else {
            p.outline.distance(&q.outline) <= 0.0
        };
        Truth::from(above)
    }
}
