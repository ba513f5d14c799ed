//! Doors and windows.

use super::rooms::{BATH, BEDROOM, CHILD, HALL, INNER_M, KITCHEN, LIVING, OUTER_M};
use crate::building::assembly::Assembly;
use crate::building::plan::Rect;
use crate::building::site::{Site, yaw};
use crate::building::wall::{Along, Opening};
use dwell_furniture::finish::Finish;
use dwell_furniture::models::openings::{Door, Window, clear_pane, frosted_pane};
use dwell_scene::{Pose, RoomId};
use glam::Vec3;

/// Of a doorway, m.
pub(super) const DOOR_WIDTH_M: f32 = 0.98;
const DOOR_HEIGHT_M: f32 = 2.06;

/// A doorway: the middle of its opening and the way its leaf swings.
#[derive(Clone, Copy, Debug)]
struct Doorway {
    /// The room it belongs to.
    room: RoomId,
    /// (x, z), m.
    at: [f32; 2],
    /// Turns the model's +Z, towards which the leaf swings, into the world.
    yaw_deg: f32,
    /// 0 closed to 1 open at the start.
    openness: f32,
    look: Look,
    hinge_right: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Look {
    Entrance,
    Panelled,
    Glazed,
}

const fn door(room: RoomId, at: [f32; 2], yaw_deg: f32, openness: f32, look: Look) -> Doorway {
    // Open leaves lie against the nearest wall and leave the next doorway free.
    let hinge_right = matches!(look, Look::Glazed | Look::Entrance);
    Doorway {
        room,
        at,
        yaw_deg,
        openness,
        look,
        hinge_right,
    }
}

const DOORWAYS: [Doorway; 6] = [
    door(HALL, [-0.5 * OUTER_M, 4.5], 90.0, 0.0, Look::Entrance),
    door(BEDROOM, [3.3, 3.75], 180.0, 0.0, Look::Panelled),
    door(BATH, [5.7, 3.75], 180.0, 0.35, Look::Panelled),
    door(CHILD, [0.75, 5.25], 0.0, 1.0, Look::Panelled),
    door(LIVING, [6.45, 4.5], 90.0, 1.0, Look::Glazed),
    door(KITCHEN, [8.0, 3.75], 180.0, 1.0, Look::Glazed),
];

/// A window: the middle of its opening, its size, and the way the room lies.
#[derive(Clone, Copy, Debug)]
struct Opened {
    room: RoomId,
    at: Vec3,
    /// Width and height, m.
    size: [f32; 2],
    yaw_deg: f32,
    frosted: bool,
    /// How far the sill stands into the room, m.
    sill_m: f32,
}

const fn window(room: RoomId, at: [f32; 3], size: [f32; 2], yaw_deg: f32) -> Opened {
    Opened {
        room,
        at: Vec3::from_array(at),
        size,
        yaw_deg,
        frosted: false,
        sill_m: 0.04,
    }
}

const NORTH: f32 = -0.5 * OUTER_M;
const SOUTH: f32 = 9.0 + 0.5 * OUTER_M;
const EAST: f32 = 11.0 + 0.5 * OUTER_M;

const WINDOWS: [Opened; 7] = [
    window(BEDROOM, [2.0, 1.55, NORTH], [1.6, 1.3], 0.0),
    Opened {
        frosted: true,
        sill_m: 0.02,
        ..window(BATH, [5.05, 1.75, NORTH], [0.7, 0.7], 0.0)
    },
    // Herbs stand on this one.
    Opened {
        sill_m: 0.11,
        ..window(KITCHEN, [9.4, 1.7, NORTH], [1.3, 1.1], 0.0)
    },
    window(CHILD, [2.4, 1.55, SOUTH], [1.5, 1.3], 180.0),
    window(LIVING, [6.0, 1.5, SOUTH], [1.8, 1.4], 180.0),
    window(LIVING, [9.2, 1.5, SOUTH], [1.8, 1.4], 180.0),
    window(LIVING, [EAST, 1.5, 7.4], [1.4, 1.4], -90.0),
];

/// The holes in the wall over `rect`.
pub(super) fn holes(rect: Rect, along: Along) -> Vec<Opening> {
    let [x0, z0, x1, z1] = rect;
    let hole = |x: f32, z: f32, width: f32, up: [f32; 2]| {
        let inside = (x0..=x1).contains(&x) && (z0..=z1).contains(&z);
        let middle = if along == Along::X { x } else { z };
        inside.then_some(Opening {
            along: [middle - 0.5 * width, middle + 0.5 * width],
            up,
        })
    };
    let doors = DOORWAYS
        .iter()
        .filter_map(|door| hole(door.at[0], door.at[1], DOOR_WIDTH_M, [0.0, DOOR_HEIGHT_M]));
    let windows = WINDOWS.iter().filter_map(|window| {
        let half = 0.5 * window.size[1];
        hole(
            window.at.x,
            window.at.z,
            window.size[0],
            [window.at.y - half, window.at.y + half],
        )
    });
    doors.chain(windows).collect()
}

/// Adds the doors and windows.
pub(super) fn build(assembly: &mut Assembly) {
    for doorway in DOORWAYS {
        let mut door = Door {
            width_m: DOOR_WIDTH_M,
            height_m: DOOR_HEIGHT_M,
            wall_m: if doorway.look == Look::Entrance {
                OUTER_M
            } else {
                INNER_M
            },
            hinge_right: doorway.hinge_right,
            glazed: doorway.look == Look::Glazed,
            ..Door::default()
        };
        if doorway.look == Look::Entrance {
            let walnut = [[120, 82, 54], [74, 46, 30], [0; 3]];
            door.leaf = Finish::tiled("walnut_door", "wood_door", "wood", walnut, 0.9);
        }
        let kind = assembly.kind(door.build());
        let [x, z] = doorway.at;
        let pose = Pose::new(Vec3::new(x, 0.0, z), yaw(doorway.yaw_deg));
        assembly.place(&kind, pose, doorway.room, doorway.openness);
    }
    for opened in WINDOWS {
        let model = Window {
            width_m: opened.size[0],
            height_m: opened.size[1],
            wall_m: OUTER_M,
            lights: if opened.size[0] > 1.0 { 2 } else { 1 },
            pane: if opened.frosted {
                frosted_pane()
            } else {
                clear_pane()
            },
            sill_m: opened.sill_m,
        };
        let mut site = Site {
            assembly: &mut *assembly,
            room: opened.room,
        };
        let kind = site.kind(model.build());
        site.place(&kind, Pose::new(opened.at, yaw(opened.yaw_deg)));
    }
}
