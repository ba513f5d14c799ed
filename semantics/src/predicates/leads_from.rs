//! The predicate `leads_from`.

use super::{OBJECT, Predicate, ROOM, leads_to::LeadsTo};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// See [`Predicate::definition`].
pub(super) struct LeadsFrom;

impl Predicate for LeadsFrom {
    fn name(&self) -> &'static str {
        "leads_from"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT, ROOM]
    }

    fn definition(&self) -> &'static str {
        "As `leads_to`: a door leads both ways."
    }

    fn source(&self) -> &'static str {
        "Chosen here; the sides of a door are looked up 0.35 m beyond its frame."
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], viewer: Option<&Viewer>) -> Truth {
        LeadsTo.decide(scene, args, viewer)
    }
}
