//! The order `highest`.

use super::{LENGTH_MARGIN_M, OWN, Selection};
use crate::scene::{SemanticScene, Term, Viewer};

/// See [`Selection::definition`].
pub(super) struct Highest;

impl Selection for Highest {
    fn name(&self) -> &'static str {
        "highest"
    }

    fn definition(&self) -> &'static str {
        "By the height of the thing's middle, m, the highest first; neighbours differ by 0.1 m."
    }

    fn source(&self) -> &'static str {
        OWN
    }

    fn key(
        &self,
        scene: &SemanticScene<'_>,
        candidate: Term,
        _: Option<Term>,
        _: Option<&Viewer>,
    ) -> Option<f32> {
        Some(-scene.center(candidate)?.y)
    }

    fn margin(&self) -> f32 {
        LENGTH_MARGIN_M
    }
}
