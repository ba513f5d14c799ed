//! The predicate `round`.

use super::shape::shape_of;
use super::{OBJECT, Predicate, mount::mount_of};
use crate::geometry::Hull;
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::{Truth, UndecidedReason};

/// The least share of the area of a circle with the same perimeter. A regular octagon has 0.948 of it, a square 0.785.
const LEAST_SHARE: f32 = 0.95;

/// The area of an outline by that of the circle with its perimeter, 0 to 1.
fn roundness(outline: &Hull) -> f32 {
    let corners = outline.points();
    let next = corners.iter().cycle().skip(1);
    let perimeter_m: f32 = corners.iter().zip(next).map(|(a, b)| a.distance(*b)).sum();
    if perimeter_m <= 0.0 {
        return 0.0;
    }
    4.0 * std::f32::consts::PI * outline.area_m2() / (perimeter_m * perimeter_m)
}

/// See [`Predicate::definition`].
pub(super) struct Round;

impl Predicate for Round {
    fn name(&self) -> &'static str {
        "round"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT]
    }

    fn definition(&self) -> &'static str {
        "Its outline from above has at least 0.95 of the area of a circle with the same perimeter; \
         undecided of what hangs, whose shape is seen from the front."
    }

    fn source(&self) -> &'static str {
        "The isoperimetric quotient (G. Pólya, Mathematics and Plausible Reasoning, Princeton \
         1954); the threshold is chosen here, above that of an octagon."
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        let hangs = args[0]
            .object()
            .is_some_and(|id| mount_of(scene, id).is_some());
        match shape_of(scene, args[0]) {
            Some(shape) if !hangs => Truth::from(roundness(&shape.outline) >= LEAST_SHARE),
            _ => Truth::Undecided(UndecidedReason::WrongKind),
        }
    }
}
