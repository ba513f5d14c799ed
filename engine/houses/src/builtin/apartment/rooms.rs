//! The rooms' floors, in the order of their ids.

use super::openings::DOOR_WIDTH_M;
use super::style;
use crate::building::assembly::Assembly;
use crate::building::plan::{Rect, RoomPlan, SLAB_M};
use dwell_furniture::finish::Finish;
use dwell_scene::RoomId;

/// Thickness of walls to the outside, m.
pub(super) const OUTER_M: f32 = 0.15;
/// Thickness of walls between rooms, m.
pub(super) const INNER_M: f32 = 0.1;

pub(super) const LIVING: RoomId = RoomId(0);
pub(super) const KITCHEN: RoomId = RoomId(1);
pub(super) const BEDROOM: RoomId = RoomId(2);
pub(super) const CHILD: RoomId = RoomId(3);
pub(super) const BATH: RoomId = RoomId(4);
pub(super) const HALL: RoomId = RoomId(5);

/// Outer faces of the building, m.
const WEST: f32 = -OUTER_M;
const NORTH: f32 = -OUTER_M;
const EAST: f32 = 11.0 + OUTER_M;
const SOUTH: f32 = 9.0 + OUTER_M;

/// Half of a doorway in a wall along X: it belongs to the room on its side.
const fn across_x(x: f32, z0: f32, z1: f32) -> Rect {
    [x - 0.5 * DOOR_WIDTH_M, z0, x + 0.5 * DOOR_WIDTH_M, z1]
}

/// Half of a doorway in a wall along Z.
const fn across_z(z: f32, x0: f32, x1: f32) -> Rect {
    [x0, z - 0.5 * DOOR_WIDTH_M, x1, z + 0.5 * DOOR_WIDTH_M]
}

fn box_of([x0, z0, x1, z1]: Rect) -> Vec<[f32; 2]> {
    vec![[x0, z0], [x1, z0], [x1, z1], [x0, z1]]
}

fn plan(
    name: &'static str,
    kinds: &[&'static str],
    floor: &[Rect],
    slab: Vec<[f32; 2]>,
    floor_finish: Finish,
) -> RoomPlan {
    RoomPlan {
        name: name.to_owned(),
        kinds: kinds.to_vec(),
        floor: floor.to_vec(),
        floor_m: 0.0,
        slabs: [slab.clone(), slab],
        slab_m: [SLAB_M; 2],
        floor_finish,
        ceiling_finish: style::ceiling(),
    }
}

fn living_room() -> RoomPlan {
    let floor = [
        [4.3, 5.3, 11.0, 9.0],
        [6.5, 3.8, 11.0, 5.3],
        across_z(4.5, 6.45, 6.5),
        across_x(8.0, 3.75, 3.8),
    ];
    let slab = vec![
        [6.45, 3.75],
        [EAST, 3.75],
        [EAST, SOUTH],
        [4.25, SOUTH],
        [4.25, 5.25],
        [6.45, 5.25],
    ];
    let kinds = ["living room", "dining room"];
    plan("living_room", &kinds, &floor, slab, style::living_floor())
}

fn kitchen() -> RoomPlan {
    let floor = [[6.5, 0.0, 11.0, 3.7], across_x(8.0, 3.7, 3.75)];
    let slab = box_of([6.45, NORTH, EAST, 3.75]);
    plan(
        "kitchen",
        &["kitchen"],
        &floor,
        slab,
        style::kitchen_floor(),
    )
}

fn bedroom() -> RoomPlan {
    let floor = [[0.0, 0.0, 4.0, 3.7], across_x(3.3, 3.7, 3.75)];
    let slab = box_of([WEST, NORTH, 4.05, 3.75]);
    plan(
        "bedroom",
        &["bedroom"],
        &floor,
        slab,
        style::bedroom_floor(),
    )
}

fn child_room() -> RoomPlan {
    let floor = [[0.0, 5.3, 4.2, 9.0], across_x(0.75, 5.25, 5.3)];
    let slab = box_of([WEST, 5.25, 4.25, SOUTH]);
    let kinds = ["child room", "bedroom"];
    plan("child_room", &kinds, &floor, slab, style::child_floor())
}

fn bathroom() -> RoomPlan {
    let floor = [[4.1, 0.0, 6.4, 3.7], across_x(5.7, 3.7, 3.75)];
    let slab = box_of([4.05, NORTH, 6.45, 3.75]);
    plan("bathroom", &["bathroom"], &floor, slab, style::bath_floor())
}

fn hallway() -> RoomPlan {
    let floor = [
        [0.0, 3.8, 6.4, 5.2],
        across_x(3.3, 3.75, 3.8),
        across_x(5.7, 3.75, 3.8),
        across_x(0.75, 5.2, 5.25),
        across_z(4.5, 6.4, 6.45),
        across_z(4.5, WEST, 0.0),
    ];
    let slab = box_of([WEST, 3.75, 6.45, 5.25]);
    plan("hallway", &["hallway"], &floor, slab, style::hall_floor())
}

/// Adds the rooms with their floors and ceilings.
pub(super) fn build(assembly: &mut Assembly) {
    for plan in [
        living_room(),
        kitchen(),
        bedroom(),
        child_room(),
        bathroom(),
        hallway(),
    ] {
        plan.build(assembly);
    }
}
