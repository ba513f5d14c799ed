//! The predicate `room_contains`.

use super::{Predicate, ROOM, RelationProperties, THING, shape::room_of};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// See [`Predicate::definition`].
pub(super) struct RoomContains;

impl Predicate for RoomContains {
    fn name(&self) -> &'static str {
        "room_contains"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[ROOM, THING]
    }

    fn definition(&self) -> &'static str {
        "The thing is `in_room`: \"the bedroom with a desk\"."
    }

    fn source(&self) -> &'static str {
        "As `in_room`."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            antisymmetric: true,
            irreflexive: true,
            converse: Some("in_room"),
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        Truth::from(room_of(scene, args[1]).map(Term::Room) == Some(args[0]))
    }
}
