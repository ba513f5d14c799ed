//! Overlaps of added and moved objects with others.

use std::collections::BTreeSet;

use dwell_scene::bvh::BoxTree;
use dwell_scene::interrupt;
use dwell_scene::{Aabb, House, Id, ObjectId, RoomId};
use glam::{Vec2, Vec3};

use super::place::{triangles, world_bounds, world_vertices};

/// Smallest penetration depth that is reported, m: less counts as touch.
const DEEP_M: f32 = 0.01;
/// Largest number of points of a thing that are tested.
const LOOKED_AT: usize = 64;
/// Largest number of things with which one is compared.
const MOST_COMPARED: usize = 32;
/// Directions of test rays: a point inside is left through a surface an odd number of times on each of them. Askew, so that they meet no
/// edge.
const WAYS: [Vec3; 6] = [
    Vec3::new(0.98, 0.13, 0.15),
    Vec3::new(-0.97, 0.17, -0.16),
    Vec3::new(0.12, 0.98, 0.14),
    Vec3::new(0.14, -0.98, 0.11),
    Vec3::new(0.16, 0.11, 0.98),
    Vec3::new(-0.13, 0.15, -0.98),
];

/// The overlaps of any of `put` with other things: pairs, the added or moved one first. A thing whose box reaches into more than 32 others
/// is compared with those about its middle.
pub(super) fn overlapping_pairs(house: &House, put: &[ObjectId]) -> Vec<(ObjectId, ObjectId)> {
    let data = house.data();
    let boxes = data.objects.ids().map(|id| {
        interrupt::unwind_if_cancelled();
        world_bounds(data, id)
    });
    let tree = BoxTree::new(boxes.collect());
    let bounds = |id: ObjectId| tree.get(id.index()).copied().unwrap_or_default();
    let mut found = Vec::new();
    let mut compared: BTreeSet<[ObjectId; 2]> = BTreeSet::new();
    // Later things were put into earlier ones.
    for one in put.iter().rev() {
        let own = bounds(*one);
        let others = tree.k_nearest_intersecting(&own, MOST_COMPARED, |other| {
            let other = ObjectId::from_index(other);
            let theirs = bounds(other);
            let deep = Vec3::splat(DEEP_M);
            let near =
                own.min.cmplt(theirs.max - deep).all() && own.max.cmpgt(theirs.min + deep).all();
            // A building contains all that stands in it.
            let structure = || theirs.encloses(&own) && is_around_rooms(house, &theirs);
            other != *one && near && !structure()
        });
        for other in others {
            let other = ObjectId::from_index(other);
            if !compared.insert([other.min(*one), other.max(*one)]) {
                continue;
            }
            interrupt::unwind_if_cancelled();
            if any_inside(house, *one, other) || any_inside(house, other, *one) {
                found.push((*one, other));
            }
        }
    }
    found
}

fn is_around_rooms(house: &House, bounds: &Aabb) -> bool {
    let mut rooms = house.rooms.iter().map(|room| room.bounds.center());
    rooms.any(|middle| bounds.contains(middle))
}

/// Returns whether a point of `one`, a little inside of it, is inside of `other`.
fn any_inside(house: &House, one: ObjectId, other: ObjectId) -> bool {
    let data = house.data();
    let middle = world_bounds(data, one).center();
    let all: Vec<Vec3> = data.objects[one]
        .parts()
        .flat_map(|part| world_vertices(data, part))
        .collect();
    let triangles = triangles(data, other);
    let bounds = world_bounds(data, other);
    let stride = all.len().div_ceil(LOOKED_AT).max(1);
    let looked = all.into_iter().step_by(stride);
    let mut inner = looked.map(|p| p + (middle - p).clamp_length_max(DEEP_M));
    inner.any(|p| {
        let within = p.cmpge(bounds.min).all() && p.cmple(bounds.max).all();
        within
            && WAYS
                .iter()
                .all(|way| crossings(&triangles, p, *way) % 2 == 1)
    })
}

/// Returns the number of triangles that a ray meets.
///
/// # Source
/// T. Moeller, B. Trumbore, *Fast, minimum storage ray/triangle intersection*, J. Graphics Tools 2(1), 21 (1997).
fn crossings(triangles: &[[Vec3; 3]], from: Vec3, way: Vec3) -> usize {
    let meets = |[a, b, c]: &&[Vec3; 3]| {
        let (u, v) = (*b - *a, *c - *a);
        let p = way.cross(v);
        let det = u.dot(p);
        if det.abs() < 1e-12 {
            return false;
        }
        let t = from - *a;
        let s = t.dot(p) / det;
        let q = t.cross(u);
        let r = way.dot(q) / det;
        s >= 0.0 && r >= 0.0 && s + r <= 1.0 && v.dot(q) / det > 0.0
    };
    triangles.iter().filter(meets).count()
}

/// Returns whether a corner of a thing's footprint lies in no room, though its middle does: in a wall, or through it.
pub(super) fn intersects_wall(house: &House, object: ObjectId) -> bool {
    let bounds = world_bounds(house.data(), object);
    let middle = bounds.center();
    let rooms = || house.rooms.ids();
    let at_height = |room: &RoomId| {
        let room = &house.rooms[*room];
        middle.y > room.floor_y && middle.y < room.ceiling_y
    };
    let holds = |at: Vec2| {
        let mut rooms = rooms().filter(at_height);
        rooms.any(|room| house.rooms[room].contains_xz(at))
    };
    let deep = Vec2::splat(2.0 * DEEP_M);
    let low = Vec2::new(bounds.min.x, bounds.min.z) + deep;
    let high = Vec2::new(bounds.max.x, bounds.max.z) - deep;
    if bounds.is_empty() || low.cmpge(high).any() || !holds(Vec2::new(middle.x, middle.z)) {
        return false;
    }
    let corners = [
        low,
        Vec2::new(low.x, high.y),
        Vec2::new(high.x, low.y),
        high,
    ];
    corners.into_iter().any(|corner| !holds(corner))
}
