//! Passages between rooms that no door closes.

use crate::room_outline::boundary_edges;
use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::rays::RayScene;
use dwell_scene::{Aabb, IdVec, RoomId};
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

/// For each room the rooms that open passages lead to, ascending; the relation is symmetric.
///
/// A passage is where at least 0.6 m of a room's border can be crossed at three heights without meeting a wall or a thing,
/// and another room lies half a metre beyond. `doors`: the boxes of things that close openings; there are no passages there.
pub(crate) fn passages(rays: &RayScene, doors: &[Aabb]) -> IdVec<RoomId, Vec<RoomId>> {
    let house = rays.house();
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
fn widths(rays: &RayScene, doors: &[Aabb], room: RoomId) -> BTreeMap<RoomId, f32> {
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
            let at = a + (b - a) * ((k as f32 + 0.5) / steps);
            if let Some(other) = beyond(rays, doors, room, at, out) {
                *open.entry(other).or_insert(0.0) += length_m / steps;
            }
        }
    }
    open
}

/// The room on the other side of the border at `at`, if nothing is in between.
fn beyond(rays: &RayScene, doors: &[Aabb], room: RoomId, at: Vec2, out: Vec2) -> Option<RoomId> {
    let house = rays.house();
    let floor_y = house.rooms[room].floor_y;
    let far = at + out * BEYOND_M;
    let middle = Vec3::new(far.x, floor_y + HEIGHTS_M[1], far.y);
    let other = house.room_at(middle).filter(|other| *other != room)?;
    let of_door = |door: &&Aabb| {
        door.grown(DOORWAY_M)
            .contains(Vec3::new(at.x, door.center().y, at.y))
    };
    let on_storey = |door: &&Aabb| (door.min.y - floor_y).abs() < 1.0;
    if doors.iter().filter(on_storey).any(|door| of_door(&door)) {
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
