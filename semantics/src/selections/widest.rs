//! The order `widest`.

use super::{RATIO_MARGIN, Selection, WEBER, logarithm};
use crate::scene::{SemanticScene, Term, Viewer};

/// See [`Selection::definition`].
pub(super) struct Widest;

impl Selection for Widest {
    fn name(&self) -> &'static str {
        "widest"
    }

    fn definition(&self) -> &'static str {
        "By the longer level edge of the box around a thing in its own axes, the widest first; \
         neighbours differ by a ratio of 1.1."
    }

    fn source(&self) -> &'static str {
        WEBER
    }

    fn key(
        &self,
        scene: &SemanticScene<'_>,
        candidate: Term,
        _: Option<Term>,
        _: Option<&Viewer>,
    ) -> Option<f32> {
        let size = scene.facts(candidate.object()?).extents_m;
        Some(-logarithm(size.x.max(size.z))?)
    }

    fn margin(&self) -> f32 {
        RATIO_MARGIN
    }
}
