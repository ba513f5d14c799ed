//! The order `from_right`.

use super::Selection;
use crate::predicates::{LEAST_TANGENT, image_x};
use crate::scene::{SemanticScene, Term, Viewer};

/// See [`Selection::definition`].
pub(super) struct FromRight;

impl Selection for FromRight {
    fn name(&self) -> &'static str {
        "from_right"
    }

    fn definition(&self) -> &'static str {
        "In the viewer's picture, by the tangent of the direction to the middle, the rightmost \
         first; what is not in front of the viewer does not count."
    }

    fn source(&self) -> &'static str {
        "The order and its margin (0.035, 2 degrees in the middle) are those of right_of."
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
        Some(-image_x(scene, viewer?, candidate)?)
    }

    fn margin(&self) -> f32 {
        LEAST_TANGENT
    }
}
