//! Far from.

use super::{Predicate, RelationProperties, THING, shape::gap_m};
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

    fn places(&self) -> &'static [&'static [TermKind]] {
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
        Truth::from(gap_m(scene, args[0], args[1]).is_some_and(|gap| gap > FAR_M))
    }
}
