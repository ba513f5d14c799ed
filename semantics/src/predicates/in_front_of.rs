//! The predicate `in_front_of`, relative to a viewer.

use super::{Predicate, RelationProperties, THING, view::ViewedPair};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::{Truth, UndecidedReason};

/// The least difference of depth, m.
const LEAST_M: f32 = 0.1;
/// The least overlap in the picture, as share of the narrower one's width.
const SHARE: f32 = 1.0 / 3.0;

/// See [`Predicate::definition`]; [`super::at_front_of::AtFrontOf`] is relative to the reference's own front.
pub(super) struct InFrontOf;

impl Predicate for InFrontOf {
    fn name(&self) -> &'static str {
        "in_front_of"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[THING, THING]
    }

    fn definition(&self) -> &'static str {
        "From the viewer: both middles are in front of it, that of the thing is at least 0.1 m \
         nearer along where it looks (pitch left aside), and in its picture the two share at \
         least a third of the narrower one's width. The reference's own front does not matter: \
         see at_front_of."
    }

    fn source(&self) -> &'static str {
        "The relative frame, reflected, of S. C. Levinson, Space in Language and Cognition, \
         Cambridge 2003; thresholds are chosen here."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            antisymmetric: true,
            irreflexive: true,
            converse: Some("behind"),
            excludes: &["behind"],
            ..RelationProperties::default()
        }
    }

    fn needs_viewer(&self) -> bool {
        true
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], viewer: Option<&Viewer>) -> Truth {
        let sights = viewer.and_then(|viewer| ViewedPair::of(scene, viewer, [args[0], args[1]]));
        sights.map_or(Truth::Undecided(UndecidedReason::NotInFront), |sights| {
            let nearer = sights.depth_difference_m() >= LEAST_M;
            Truth::from(nearer && sights.width_overlap_fraction(scene) >= SHARE)
        })
    }
}
