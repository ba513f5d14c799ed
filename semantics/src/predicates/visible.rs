//! The predicate `visible`.

use super::{OBJECT, Predicate};
use crate::line_of_sight::{FieldOfView, is_in_line_of_sight};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// See [`Predicate::definition`]; [`super::visible_from::VisibleFrom`] does not depend on the direction of view.
pub(super) struct Visible;

impl Predicate for Visible {
    fn name(&self) -> &'static str {
        "visible"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT]
    }

    fn definition(&self) -> &'static str {
        "From the viewer, a ray within a square picture of 90 degrees meets the thing before \
         anything that one does not see through: one of nine to the middle of its box and to points \
         60 % of the way to its corners, or one of 4 by 4 over the part of the picture that its box \
         covers."
    }

    fn source(&self) -> &'static str {
        "Chosen here; 90 degrees is the field of view of the default camera."
    }

    fn needs_viewer(&self) -> bool {
        true
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], viewer: Option<&Viewer>) -> Truth {
        let (Term::Object(object), Some(viewer)) = (args[0], viewer) else {
            return Truth::False;
        };
        let seen = is_in_line_of_sight(scene, scene.rays(), viewer, object, FieldOfView::Picture);
        Truth::from(seen)
    }
}
