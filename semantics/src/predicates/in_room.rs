//! The predicate `in_room`.

use super::{Predicate, ROOM, RelationProperties, THING, shape::room_of};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::Truth;

/// See [`Predicate::definition`]; a thing within a wall is in the room that the house's file names, until it moves.
pub(super) struct InRoom;

impl Predicate for InRoom {
    fn name(&self) -> &'static str {
        "in_room"
    }

    fn words(&self) -> &'static str {
        "in"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[THING, ROOM]
    }

    fn definition(&self) -> &'static str {
        "A thing's middle lies over the room's floor and between floor and ceiling (0.3 m of \
         tolerance), in the smallest such room where floors overlap; what is held is where its \
         holder is, an agent where its feet are, and a window or door that was never moved in the \
         room that the file names."
    }

    fn source(&self) -> &'static str {
        "Chosen here; rooms are those of the house's file."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            antisymmetric: true,
            irreflexive: true,
            functional: true,
            converse: Some("room_contains"),
            ..RelationProperties::default()
        }
    }

    fn is_listed(&self) -> bool {
        true
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        Truth::from(room_of(scene, args[0]).map(Term::Room) == Some(args[1]))
    }

    fn related(&self, scene: &SemanticScene<'_>, subject: Term) -> Vec<Term> {
        let takes = THING.contains(&subject.kind());
        let room = room_of(scene, subject).filter(|_| takes);
        room.map(Term::Room).into_iter().collect()
    }
}
