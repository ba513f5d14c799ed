//! The predicate `long`.

use super::{
    OBJECT, Predicate,
    proportions::{Proportions, weighed},
};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::{Truth, UndecidedReason};

/// See [`Predicate::definition`].
pub(super) struct Long;

impl Predicate for Long {
    fn name(&self) -> &'static str {
        "long"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT]
    }

    fn definition(&self) -> &'static str {
        "Its longer horizontal side is at least 1.2 times as long as is usual for its kind, or at \
         least twice as long as the shorter one and no shorter than it is high; not long where it \
         is at most 1/1.2 times as long as usual or less than 1.3 times as long as the shorter \
         one; undecided where neither or both is so."
    }

    fn source(&self) -> &'static str {
        "M. Bierwisch, E. Lang (eds.), Dimensional Adjectives, Springer 1989: a dimension of a thing \
         against its other ones and against the norm of its kind. The ratios are chosen here."
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        let Some(own) = Proportions::of(scene, args[0]) else {
            return Truth::Undecided(UndecidedReason::WrongKind);
        };
        let [longer, shorter] = own.length_against_usual();
        let is_long = own.length_m >= 2.0 * own.depth_m && own.length_m >= own.height_m;
        weighed(
            longer || is_long,
            shorter || own.length_m < 1.3 * own.depth_m,
        )
    }
}
