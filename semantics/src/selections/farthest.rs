//! The order `farthest`.

use super::{LENGTH_MARGIN_M, OWN, Selection};
use crate::predicates;
use crate::scene::{SemanticScene, Term, Viewer};

/// See [`Selection::definition`].
pub(super) struct FarthestFromViewer;

impl Selection for FarthestFromViewer {
    fn name(&self) -> &'static str {
        "farthest"
    }

    fn definition(&self) -> &'static str {
        "By the distance from the viewer to the nearest point of the thing's box, m, the \
         farthest first; neighbours differ by 0.1 m."
    }

    fn source(&self) -> &'static str {
        OWN
    }

    fn needs_viewer(&self) -> bool {
        true
    }

    fn key(
        &self,
        scene: &SemanticScene<'_>,
        candidate: Term,
        _: Option<Term>,
        viewer: Option<&Viewer>,
    ) -> Option<f32> {
        let eye = viewer?.world_from_camera.position;
        let bounds = predicates::bounds_of(scene, candidate)?;
        Some(-eye.clamp(bounds.min, bounds.max).distance(eye))
    }

    fn margin(&self) -> f32 {
        LENGTH_MARGIN_M
    }
}
