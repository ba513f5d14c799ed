//! The predicate `reachable`.

use super::{AGENT, Predicate, RelationProperties};
use crate::scene::{SemanticScene, Term, TermKind, Viewer};
use crate::truth::{Truth, UndecidedReason};

const OBJECT_ROOM_STOREY: &[TermKind] = &[TermKind::Object, TermKind::Room, TermKind::Storey];

/// See [`Predicate::definition`].
pub(super) struct Reachable;

impl Predicate for Reachable {
    fn name(&self) -> &'static str {
        "reachable"
    }

    fn argument_kinds(&self) -> &'static [&'static [TermKind]] {
        &[OBJECT_ROOM_STOREY, AGENT]
    }

    fn definition(&self) -> &'static str {
        "From where the agent stands it can walk, with its width and step height and all doors as \
         they are, to a place in the thing's room (of a door or a window: in any room) from whose \
         eyes the thing's box is at most its reach away (reach_m of its body, 1.5 m by default); \
         into the room; onto the storey. What it holds it reaches. Undecided for an agent more \
         than 0.5 m from where anybody can walk."
    }

    fn source(&self) -> &'static str {
        "The navigation grid's walker; the reach is that of the hand's actions, without their \
         line of sight."
    }

    fn properties(&self) -> RelationProperties {
        RelationProperties {
            antisymmetric: true,
            irreflexive: true,
            ..RelationProperties::default()
        }
    }

    fn decide(&self, scene: &SemanticScene<'_>, args: &[Term], _: Option<&Viewer>) -> Truth {
        let Term::Agent(agent) = args[1] else {
            return Truth::False;
        };
        if args[0]
            .object()
            .is_some_and(|id| scene.holder(id) == Some(agent))
        {
            return Truth::True;
        }
        let Some(area) = scene.reachable_area(agent) else {
            return Truth::Undecided(UndecidedReason::NotOnFloor);
        };
        let house = scene.house();
        let room_holds = |room: dwell_scene::RoomId| {
            area.any_in(&house.rooms[room].bounds, |place| {
                house.room_at(place + glam::Vec3::Y * 0.1) == Some(room)
            })
        };
        Truth::from(match args[0] {
            Term::Object(id) => {
                let room = scene
                    .room_of(id)
                    .filter(|_| !scene.facts(id).belongs_to_opening());
                // Walls between rooms are in the way of hands.
                area.hand_reaches(&scene.extent(id).bounds, |place| {
                    let here = || house.room_at(place + glam::Vec3::Y * 0.1);
                    room.is_none() || here() == room
                })
            }
            Term::Room(room) => room_holds(room),
            Term::Storey(storey) => {
                let mut rooms = house.rooms.iter_ids();
                rooms.any(|(id, room)| room.level == storey && room_holds(id))
            }
            _ => false,
        })
    }
}
