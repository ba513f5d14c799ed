//! The sides of doors.

use crate::doorways::RoomDoorway;
use crate::scene::{SemanticScene, Term};
use crate::truth::{Truth, UndecidedReason};

/// Returns whether a door's sides are as `test` says; undecided for what is no door.
pub(super) fn doorway_satisfies(
    scene: &SemanticScene<'_>,
    door: Term,
    test: impl Fn(&RoomDoorway) -> bool,
) -> Truth {
    let doorway = door.object().and_then(|id| scene.semantics.doorway(id));
    doorway.map_or(Truth::Undecided(UndecidedReason::WrongKind), |doorway| {
        Truth::from(test(doorway))
    })
}

impl RoomDoorway {
    /// Returns whether one of its sides is in `room`.
    pub(super) fn has_side(&self, room: Term) -> bool {
        matches!(room, Term::Room(room) if self.rooms.contains(&room))
    }
}
