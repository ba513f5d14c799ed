//! The order `farthest_from`.

use super::{LENGTH_MARGIN_M, OWN, Selection, gap_m};
use crate::scene::{SemanticScene, Term, Viewer};

/// See [`Selection::definition`].
pub(super) struct FarthestFrom;

impl Selection for FarthestFrom {
    fn name(&self) -> &'static str {
        "farthest_from"
    }

    fn definition(&self) -> &'static str {
        "By the gap to the reference, each taken for its outline from above between its lowest \
         and its highest point, m, the farthest first; neighbours differ by 0.1 m."
    }

    fn source(&self) -> &'static str {
        OWN
    }

    fn needs_reference(&self) -> bool {
        true
    }

    fn key(
        &self,
        scene: &SemanticScene<'_>,
        candidate: Term,
        reference: Option<Term>,
        _: Option<&Viewer>,
    ) -> Option<f32> {
        Some(-gap_m(scene, candidate, reference?)?)
    }

    fn margin(&self) -> f32 {
        LENGTH_MARGIN_M
    }
}
