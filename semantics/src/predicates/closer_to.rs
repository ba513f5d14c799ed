//! The predicate `closer_to`.

use super::{Predicate, RelationProperties, THING, larger_than::LEAST_RATIO, shape::gap_m};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// See [`Predicate::definition`].
pub(super) struct CloserTo;

impl Predicate for CloserTo {
    fn name(&self) -> &'static str {
        "closer_to"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[THING, THING, THING]
    }

    fn definition(&self) -> &'static str {
        "The gap between a first thing and a third is at least 1.1 times that between the first \
         and a second, both others than it, each taken for its outline from above between its lowest and its highest \
         point."
    }

    fn source(&self) -> &'static str {
        "The ratio as of `wider_than`."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            antisymmetric: true,
            irreflexive: true,
            transitive: true,
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        if args[0] == args[1] || args[0] == args[2] {
            return Truth::False;
        }
        let gaps = gap_m(scene, args[0], args[1]).zip(gap_m(scene, args[0], args[2]));
        Truth::from(gaps.is_some_and(|(near, far)| far >= LEAST_RATIO * near && far > near))
    }
}
