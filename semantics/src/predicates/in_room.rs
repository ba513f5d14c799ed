//! In a room.

use super::{Predicate, RelationProperties};
use crate::scene::{SemanticScene, Term, Viewer};
use dwell_scene::ObjectId;

/// `a` is in room `b`: the middle of its box lies over the room's floor and between floor and ceiling (0.3 m of tolerance), in the
/// smallest such room where floors overlap; a held thing is where its holder is; a thing in a wall (a window, a door) that
/// was never moved is in the room that the house's file names. An agent is where its feet are. Nothing is in two rooms.
pub(super) struct InRoom;

impl Predicate for InRoom {
    fn name(&self) -> &'static str {
        "in_room"
    }

    fn words(&self) -> &'static str {
        "in"
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            irreflexive: true,
            antisymmetric: true,
            functional: true,
            ..RelationProperties::default()
        }
    }

    fn holds(
        &self,
        scene: &SemanticScene<'_>,
        subject: Term,
        object: Term,
        _: Option<&Viewer>,
    ) -> bool {
        let Term::Room(room) = object else {
            return false;
        };
        let found = match subject {
            Term::Object(id) => scene.room_of(id),
            Term::Agent(id) => scene.room_of_agent(id),
            Term::Structure(id) => scene.house().structure[id].room,
            Term::Room(_) => None,
        };
        found == Some(room)
    }

    fn related(&self, scene: &SemanticScene<'_>, subject: ObjectId) -> Vec<Term> {
        scene.room_of(subject).map(Term::Room).into_iter().collect()
    }
}
