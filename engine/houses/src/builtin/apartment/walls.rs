//! The walls and what covers their faces.

use super::openings::holes;
use super::rooms::{BATH, BEDROOM, CHILD, HALL, KITCHEN, LIVING, OUTER_M};
use super::style as s;
use crate::building::plan::{CEILING_M, Rect};
use crate::building::wall::{Along, Bands, Wall};
use dwell_scene::RoomId;

const O: f32 = OUTER_M;

/// A wall along X from its rectangle and what its front (south) and back (north) show.
fn x(name: &'static str, room: RoomId, rect: Rect, front: Bands, back: Bands) -> Wall {
    wall(name, room, rect, Along::X, [front, back])
}

/// A wall along Z from its rectangle and what its front (east) and back (west) show.
fn z(name: &'static str, room: RoomId, rect: Rect, front: Bands, back: Bands) -> Wall {
    wall(name, room, rect, Along::Z, [front, back])
}

fn wall(
    name: &'static str,
    room: RoomId,
    rect: Rect,
    along: Along,
    [front, back]: [Bands; 2],
) -> Wall {
    let openings = holes(rect, along);
    Wall {
        name: name.to_owned(),
        room,
        floor_m: 0.0,
        height_m: CEILING_M,
        rect,
        along,
        front,
        back,
        edge: s::reveal(),
        openings,
    }
}

/// Outside walls, clockwise from the north-west corner.
fn outer() -> Vec<Wall> {
    let out = s::facade;
    vec![
        x(
            "bedroom_north",
            BEDROOM,
            [-O, -O, 4.05, 0.0],
            s::bedroom_walls(),
            out(),
        ),
        x(
            "bathroom_north",
            BATH,
            [4.05, -O, 6.45, 0.0],
            s::bath_walls(),
            out(),
        ),
        x(
            "kitchen_north",
            KITCHEN,
            [6.45, -O, 11.0 + O, 0.0],
            s::kitchen_splashback(),
            out(),
        ),
        z(
            "kitchen_east",
            KITCHEN,
            [11.0, 0.0, 11.0 + O, 3.75],
            out(),
            s::kitchen_walls(),
        ),
        z(
            "living_room_east",
            LIVING,
            [11.0, 3.75, 11.0 + O, 9.0],
            out(),
            s::living_walls(),
        ),
        x(
            "living_room_south",
            LIVING,
            [4.25, 9.0, 11.0 + O, 9.0 + O],
            out(),
            s::living_walls(),
        ),
        x(
            "child_room_south",
            CHILD,
            [-O, 9.0, 4.25, 9.0 + O],
            out(),
            s::child_walls(),
        ),
        z(
            "child_room_west",
            CHILD,
            [-O, 5.25, 0.0, 9.0],
            s::child_accent(),
            out(),
        ),
        z(
            "hallway_west",
            HALL,
            [-O, 3.75, 0.0, 5.25],
            s::hall_walls(),
            out(),
        ),
        z(
            "bedroom_west",
            BEDROOM,
            [-O, 0.0, 0.0, 3.75],
            s::bedroom_accent(),
            out(),
        ),
    ]
}

/// Walls between rooms.
fn inner() -> Vec<Wall> {
    let (living, hall) = (s::living_walls, s::hall_walls);
    vec![
        z(
            "bedroom_bathroom",
            BEDROOM,
            [4.0, 0.0, 4.1, 3.7],
            s::bath_walls(),
            s::bedroom_walls(),
        ),
        z(
            "bathroom_kitchen",
            BATH,
            [6.4, 0.0, 6.5, 3.7],
            s::kitchen_walls(),
            s::bath_walls(),
        ),
        x(
            "bedroom_hallway",
            BEDROOM,
            [0.0, 3.7, 4.05, 3.8],
            hall(),
            s::bedroom_walls(),
        ),
        x(
            "bathroom_hallway",
            BATH,
            [4.05, 3.7, 6.45, 3.8],
            hall(),
            s::bath_walls(),
        ),
        x(
            "kitchen_living_room",
            KITCHEN,
            [6.45, 3.7, 11.0, 3.8],
            living(),
            s::kitchen_walls(),
        ),
        z(
            "hallway_living_room_east",
            HALL,
            [6.4, 3.8, 6.5, 5.2],
            living(),
            hall(),
        ),
        x(
            "hallway_child_room",
            CHILD,
            [0.0, 5.2, 4.25, 5.3],
            s::child_walls(),
            hall(),
        ),
        x(
            "hallway_living_room_south",
            LIVING,
            [4.25, 5.2, 6.5, 5.3],
            living(),
            hall(),
        ),
        z(
            "child_room_living_room",
            CHILD,
            [4.2, 5.3, 4.3, 9.0],
            s::living_accent(),
            s::child_walls(),
        ),
    ]
}

/// All walls with their openings.
pub(crate) fn walls() -> Vec<Wall> {
    let mut walls = outer();
    walls.extend(inner());
    walls
}
