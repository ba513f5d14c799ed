//! The predicate `far`.

use super::{
    Predicate, RelationProperties, THING,
    shape::{bounds_of, gap_lower_bound_m, gap_m},
};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// The gap from which things are far from each other, m.
const FAR_M: f32 = 3.7;

/// See [`Predicate::definition`].
pub(super) struct Far;

impl Predicate for Far {
    fn name(&self) -> &'static str {
        "far"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[THING, THING]
    }

    fn definition(&self) -> &'static str {
        "Two things are more than 3.7 m apart, each taken for its outline from above between its \
         lowest and its highest point."
    }

    fn source(&self) -> &'static str {
        "3.7 m is the end of social distance in E. T. Hall, The Hidden Dimension, Doubleday 1966, \
         ch. 10; taken over from people to things."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            symmetric: true,
            irreflexive: true,
            excludes: &["near"],
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        let (a, b) = (args[0], args[1]);
        let boxes = (bounds_of(scene, a), bounds_of(scene, b));
        let (Some(p), Some(q)) = boxes else {
            return Truth::False;
        };
        let far = gap_lower_bound_m(&p, &q) > FAR_M;
        Truth::from(far || gap_m(scene, a, b).is_some_and(|gap| gap > FAR_M))
    }
}
