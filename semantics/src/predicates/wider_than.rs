//! The predicate `wider_than`.

use super::{OBJECT, Predicate, RelationProperties, larger_than::LEAST_RATIO};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// See [`Predicate::definition`].
pub(super) struct WiderThan;

impl Predicate for WiderThan {
    fn name(&self) -> &'static str {
        "wider_than"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT, OBJECT]
    }

    fn definition(&self) -> &'static str {
        "The longer level edge of the box around a thing in its own axes is at least 1.1 times as \
         long as that of another."
    }

    fn source(&self) -> &'static str {
        "Three times Weber's fraction of visual length, 0.029: R. Teghtsoonian, Psychol. Rev. 78, \
         71 (1971)."
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
        let width_m = |term: Term| {
            let size = term.object().map(|id| scene.facts(id).extents_m);
            size.map_or(0.0, |size| size.x.max(size.z))
        };
        let (a, b) = (width_m(args[0]), width_m(args[1]));
        Truth::from(a >= LEAST_RATIO * b && a > 0.0)
    }
}
