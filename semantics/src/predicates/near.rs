//! The predicate `near`.

use super::{
    Predicate, RelationProperties, THING,
    shape::{gap_lower_bound_m, gap_m, shape_of, share_room},
};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// The largest gap, m.
const NEAR_M: f32 = 1.2;

/// Returns whether an agent holds the thing.
fn is_held(scene: &SemanticScene<'_>, term: Term) -> bool {
    term.object().is_some_and(|id| scene.holder(id).is_some())
}

/// See [`Predicate::definition`].
pub(super) struct Near;

impl Predicate for Near {
    fn name(&self) -> &'static str {
        "near"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[THING, THING]
    }

    fn definition(&self) -> &'static str {
        "Two things in one room, neither of them held, are at most 1.2 m apart, each taken for \
         its outline from above between its lowest and its highest point."
    }

    fn source(&self) -> &'static str {
        "1.2 m is the end of personal distance in E. T. Hall, The Hidden Dimension, Doubleday \
         1966, ch. 10; taken over from people to things."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            symmetric: true,
            irreflexive: true,
            excludes: &["far"],
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        let (a, b) = (args[0], args[1]);
        if a == b || is_held(scene, a) || is_held(scene, b) || !share_room(scene, a, b) {
            return Truth::False;
        }
        let (Some(p), Some(q)) = (shape_of(scene, a), shape_of(scene, b)) else {
            return Truth::False;
        };
        let may = gap_lower_bound_m(&p.bounds, &q.bounds) <= NEAR_M;
        Truth::from(may && gap_m(scene, a, b).is_some_and(|gap| gap <= NEAR_M))
    }
}
