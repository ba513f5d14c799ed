//! The predicate `leads_to`.

use super::doors::doorway_satisfies;
use super::{OBJECT, Predicate, ROOM};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// See [`Predicate::definition`].
pub(super) struct LeadsTo;

impl Predicate for LeadsTo {
    fn name(&self) -> &'static str {
        "leads_to"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT, ROOM]
    }

    fn definition(&self) -> &'static str {
        "A door or archway has the room on one of its sides."
    }

    fn source(&self) -> &'static str {
        "Chosen here; the sides of a door are looked up 0.35 m beyond its frame."
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        doorway_satisfies(scene, args[0], |doorway| doorway.has_side(args[1]))
    }
}
