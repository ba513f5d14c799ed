//! The predicate `on_left`.

use super::view::{AHEAD_RAD, azimuth_rad};
use super::{Predicate, RelationProperties, THING};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// See [`Predicate::definition`].
pub(super) struct OnViewersLeft;

impl Predicate for OnViewersLeft {
    fn name(&self) -> &'static str {
        "on_left"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[THING]
    }

    fn definition(&self) -> &'static str {
        "Its middle lies more than 18.4 degrees to the left of \
         where the viewer looks, seen from above."
    }

    fn source(&self) -> &'static str {
        "The middle and the outer thirds of a picture of 90 degrees."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            excludes: &["on_right", "straight_ahead"],
            ..RelationProperties::default()
        }
    }

    fn needs_viewer(&self) -> bool {
        true
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], viewer: Option<&Viewer>) -> Truth {
        let azimuth = viewer.and_then(|viewer| azimuth_rad(scene, viewer, args[0]));
        Truth::from(azimuth.is_some_and(|azimuth| azimuth > AHEAD_RAD))
    }
}
