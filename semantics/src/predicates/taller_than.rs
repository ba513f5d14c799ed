//! The predicate `taller_than`.

use super::{OBJECT, Predicate, RelationProperties, larger_than::LEAST_RATIO};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// See [`Predicate::definition`].
pub(super) struct TallerThan;

impl Predicate for TallerThan {
    fn name(&self) -> &'static str {
        "taller_than"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT, OBJECT]
    }

    fn definition(&self) -> &'static str {
        "From its lowest to its highest point, as it stands, a thing is at least 1.1 times as \
         high as another."
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
        let height_m = |term: Term| {
            term.object()
                .map_or(0.0, |id| scene.extent(id).bounds.size().y)
        };
        let (a, b) = (height_m(args[0]), height_m(args[1]));
        Truth::from(a >= LEAST_RATIO * b && a > 0.0)
    }
}
