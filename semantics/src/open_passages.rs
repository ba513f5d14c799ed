//! Passages between rooms that no door closes.

use crate::room_outline::boundary_edges;
use dwell_scene::bvh::{BoxTree, Ray, RayMask};
use dwell_scene::rays::RayScene;
use dwell_scene::{Aabb, IdVec, RoomId, interrupt};
use glam::{Vec2, Vec3};
use std::collections::BTreeMap;

/// Distance between the places along a room's border that are tried, m.
const STEP_M: f32 = 0.1;
/// Distance within the room at which a try begins, and beyond its border at which it ends, m: walls are thinner.
const BEFORE_M: f32 = 0.1;
const BEYOND_M: f32 = 0.5;
/// Heights above the floor at which nothing may block the passage, m; the middle one determines the room beyond.
const HEIGHTS_M: [f32; 3] = [0.5, 1.1, 1.75];
/// Smallest width of a passage through which one can walk, m.
const LEAST_M: f32 = 0.6;
/// Distance from a door's box within which a place belongs to the door, m.
const DOORWAY_M: f32 = 0.15;
/// Difference of height between a door's foot and a floor up to which the door stands on that floor, m.
const STOREY_M: f32 = 1.0;

/// For each room the rooms that open passages lead to, ascending; the relation is symmetric.
///
/// A passage is where at least 0.6 m of a room's border can be crossed at three heights without meeting a wall or a thing,
/// and another room lies half a metre beyond. `doors`: the boxes of things that close openings; there are no passages there.
pub(crate) fn passages(rays: &RayScene, doors: &[Aabb]) -> IdVec<RoomId, Vec<RoomId>> {
    let house = rays.house();
    let reaches = doors.iter().map(|door| door.grown(DOORWAY_M));
    let doors = &BoxTree::new(reaches.collect());
    let mut found: IdVec<RoomId, Vec<RoomId>> = IdVec::filled(Vec::new(), house.rooms.len());
    for room in house.rooms.ids() {
        for (other, width_m) in widths(rays, doors, room) {
            if width_m >= LEAST_M {
                found[room].push(other);
                found[other].push(room);
            }
        }
    }
    for others in &mut found {
        others.sort();
        others.dedup();
    }
    found
}

/// Returns the length of the border of `room` that is open to each other room, m.
fn widths(rays: &RayScene, doors: &BoxTree, room: RoomId) -> BTreeMap<RoomId, f32> {
    let house = rays.house();
    let mut open = BTreeMap::new();
    for [a, b] in boundary_edges(&house.rooms[room]) {
        let length_m = a.distance(b);
        let steps = (length_m / STEP_M).ceil().max(1.0);
        let Some(along) = (b - a).try_normalize() else {
            continue;
        };
        let side = along.perp();
        let inward = house.rooms[room].contains_xz(a.midpoint(b) + side * 0.01);
        let out = if inward { -side } else { side };
        for k in 0..steps as usize {
            interrupt::unwind_if_cancelled();
            let at = a + (b - a) * ((k as f32 + 0.5) / steps);
            if let Some(other) = beyond(rays, doors, room, at, out) {
                *open.entry(other).or_insert(0.0) += length_m / steps;
            }
        }
    }
    open
}

/// The room on the other side of the border at `at`, if nothing is in between.
fn beyond(rays: &RayScene, doors: &BoxTree, room: RoomId, at: Vec2, out: Vec2) -> Option<RoomId> {
    let house = rays.house();
    let floor_y = house.rooms[room].floor_y;
    let far = at + out * BEYOND_M;
    let middle = Vec3::new(far.x, floor_y + HEIGHTS_M[1], far.y);
    let other = house.room_at(middle).filter(|other| *other != room)?;
    if is_at_door(doors, at, floor_y) {
        return None;
    }
    let near = at - out * BEFORE_M;
    let free = |height_m: &f32| {
        let from = Vec3::new(near.x, floor_y + height_m, near.y);
        let ray = Ray::new(from, Vec3::new(out.x, 0.0, out.y)).with_range(0.0, BEFORE_M + BEYOND_M);
        !rays.occluded(&ray, RayMask::EYE)
    };
    HEIGHTS_M.iter().all(free).then_some(other)
}

/// Returns whether a place on a floor lies within the reach of a door that stands on this floor. `doors`: their boxes, grown by [`DOORWAY_M`].
fn is_at_door(doors: &BoxTree, at: Vec2, floor_y: f32) -> bool {
    let [low, high] = [-1.0, 1.0].map(|side| floor_y + side * (STOREY_M + 2.0 * DOORWAY_M));
    let column = Aabb::new(Vec3::new(at.x, low, at.y), Vec3::new(at.x, high, at.y));
    let mut near = doors.intersecting(&column).into_iter();
    let foot_y = |k| doors.get(k).map(|reach| reach.min.y + DOORWAY_M);
    near.any(|k| foot_y(k).is_some_and(|y| (y - floor_y).abs() < STOREY_M))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_door_takes_the_places_about_it_on_its_own_floor() {
        let door = Aabb::new(Vec3::new(1.0, 3.0, 2.0), Vec3::new(2.0, 5.0, 2.1));
        let doors = BoxTree::new(vec![door.grown(DOORWAY_M)]);
        for (x, z, floor_y, expected) in [
            (1.5, 2.05, 3.0, true),
            (2.1, 2.2, 3.0, true),
            (2.2, 2.05, 3.0, false),
            (1.5, 2.3, 3.0, false),
            (1.5, 2.05, 2.1, true),
            (1.5, 2.05, 3.9, true),
            (1.5, 2.05, 0.0, false),
            (1.5, 2.05, 4.1, false),
        ] {
            let found = is_at_door(&doors, Vec2::new(x, z), floor_y);
            assert_eq!(found, expected, "({x}, {z}) on a floor at {floor_y}");
        }
    }
}
