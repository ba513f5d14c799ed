//! The order `smallest`.

use super::{RATIO_MARGIN, Selection, WEBER, logarithm};
use crate::scene::{SemanticScene, Term, Viewer};

/// See [`Selection::definition`].
pub(super) struct Smallest;

impl Selection for Smallest {
    fn name(&self) -> &'static str {
        "smallest"
    }

    fn definition(&self) -> &'static str {
        "By the volume of the box around a thing in its own axes, a room by its floor, the \
         smallest first; neighbours differ by a ratio of 1.1 of mean edges."
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
        match candidate {
            Term::Object(id) => {
                let volume = scene.facts(id).extents_m.element_product();
                logarithm(volume).map(|size| size / 3.0)
            }
            Term::Room(id) => logarithm(scene.semantics.room(id).area_m2).map(|size| size / 2.0),
            _ => None,
        }
    }

    fn margin(&self) -> f32 {
        RATIO_MARGIN
    }
}
