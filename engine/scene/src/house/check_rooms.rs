//! The check of storeys and rooms: heights, floors and boxes, over which grids are made.

use super::check::{LARGEST_COORDINATE_M, check_id, is_within_coordinate_limit};
use super::data::{HouseData, Room};
use crate::bounds::Aabb;
use crate::error::{SceneError, check_range};
use glam::Vec2;

/// Checks the heights and floors of rooms.
pub(super) fn check(data: &HouseData) -> Result<(), SceneError> {
    for (id, room) in data.rooms.iter_ids() {
        let at = format!("rooms[{}] {:?}", id.0, room.name);
        check_id(&at, "levels", &data.levels, room.level)?;
        heights_and_floor(&at, room)?;
    }
    Ok(())
}

/// Checks the boxes of storeys and rooms; after all that stands in them, whose faults have a name of their own.
pub(super) fn level_and_room_bounds(data: &HouseData) -> Result<(), SceneError> {
    for (id, level) in data.levels.iter_ids() {
        let at = format!("levels[{}] {:?}", id.0, level.name);
        bounds(&at, "bounds", &level.bounds)?;
    }
    for (id, room) in data.rooms.iter_ids() {
        let at = format!("rooms[{}] {:?}", id.0, room.name);
        bounds(&at, "bounds", &room.bounds)?;
    }
    Ok(())
}

fn heights_and_floor(at: &str, room: &Room) -> Result<(), SceneError> {
    let footprint = room.footprint.iter().flatten();
    let far = footprint
        .flat_map(Vec2::to_array)
        .chain([room.floor_y, room.ceiling_y])
        .find(|x| !is_within_coordinate_limit(*x));
    check_range(
        at,
        "footprint, floor_y, ceiling_y",
        far.is_none(),
        far.unwrap_or_default(),
        "coordinates within 32768 m of the origin",
    )?;
    check_range(
        at,
        "ceiling_y",
        room.ceiling_y >= room.floor_y,
        format!("{} with floor_y {}", room.ceiling_y, room.floor_y),
        "at least floor_y",
    )?;
    check_range(
        at,
        "footprint",
        !room.footprint.is_empty(),
        "no triangle",
        "one triangle with an area, or more",
    )?;
    let flat = room.footprint.iter().position(|t| !has_area(t));
    check_range(
        at,
        "footprint",
        flat.is_none(),
        format!("a triangle without area at [{}]", flat.unwrap_or_default()),
        "triangles with an area",
    )
}

/// Returns whether a triangle of (x, z) covers any floor.
pub(super) fn has_area([a, b, c]: &[Vec2; 3]) -> bool {
    (*b - *a).perp_dot(*c - *a) != 0.0
}

/// Checks a box: [`Aabb::EMPTY`], or one whose corners are in order and near.
pub(super) fn bounds(at: &str, field: &'static str, of: &Aabb) -> Result<(), SceneError> {
    if *of == Aabb::EMPTY {
        return Ok(());
    }
    check_range(
        at,
        field,
        of.min.cmple(of.max).all(),
        format!("{} to {}", of.min, of.max),
        "a smallest corner with no coordinate above the largest corner's",
    )?;
    let far = of.min.abs().max(of.max.abs()).max_element();
    check_range(
        at,
        field,
        far <= LARGEST_COORDINATE_M,
        far,
        "coordinates within 32768 m of the origin",
    )
}
