//! The order `tallest`.

use super::{RATIO_MARGIN, Selection, WEBER, logarithm};
use crate::scene::{SemanticScene, Term, Viewer};

/// See [`Selection::definition`].
pub(super) struct Tallest;

impl Selection for Tallest {
    fn name(&self) -> &'static str {
        "tallest"
    }

    fn definition(&self) -> &'static str {
        "By the height from the thing's lowest to its highest point as it stands, the tallest \
         first; neighbours differ by a ratio of 1.1."
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
        let bounds = scene.extent(candidate.object()?).bounds;
        Some(-logarithm(bounds.size().y)?)
    }

    fn margin(&self) -> f32 {
        RATIO_MARGIN
    }
}
