//! Placement of objects: the upright box around one, its target pose, what stands on it, and the room that it is in then.

use std::collections::BTreeSet;

use dwell_scene::interrupt;
use dwell_scene::{
    Aabb, House, HouseData, Id, LevelId, ObjectId, PartId, Pose, Room, RoomId, space,
};
use glam::{Quat, Vec2, Vec3};

use super::apply::EditSession;
use super::edit_errors::{check_range, checked_point, invalid_field};
use super::edits::{Anchor, Placement};
use super::free_place::{PlacementSearch, SupportSurface};
use crate::error::HousesError;

/// Largest gap between a thing and its support, m.
const GAP_M: f32 = 0.03;
/// Largest distance of a thing from its room's range of heights, m.
const ROOM_M: f32 = 0.3;
/// Largest number of pairs that are compared to find what moves with an object.
const MOST_PAIRS: usize = 10_000;

/// The corners of a part's boxes for physics and rendering, in the world.
pub(super) fn world_vertices(data: &HouseData, part: PartId) -> impl Iterator<Item = Vec3> {
    let part = &data.parts[part];
    let map = part.world_from_part.to_affine() * part.part_from_mesh;
    let positions = data.meshes[part.mesh].positions.iter();
    positions.map(move |p| map.transform_point3(*p))
}

/// The surfaces of an object in the world, m.
pub(super) fn triangles(data: &HouseData, object: ObjectId) -> Vec<[Vec3; 3]> {
    let mut all = Vec::new();
    for part in data.objects[object].parts() {
        let world: Vec<Vec3> = world_vertices(data, part).collect();
        let mesh = &data.meshes[data.parts[part].mesh];
        all.extend(mesh.triangles.iter().map(|t| t.map(|k| world[k as usize])));
    }
    all
}

/// The box around an object, m, world space.
pub(super) fn world_bounds(data: &HouseData, object: ObjectId) -> Aabb {
    let parts = data.objects[object].parts();
    Aabb::from_points(parts.flat_map(|part| world_vertices(data, part)))
}

/// A rotation about the vertical.
fn upright(yaw_rad: f32) -> Quat {
    space::rotation_from_yaw_pitch(yaw_rad, 0.0)
}

/// Returns the heading of a pose, rad.
fn yaw_of(pose: &Pose) -> f32 {
    space::yaw_from_forward(pose.rotation * Vec3::NEG_Z)
}

/// An anchor of an object, in the frame of its root as if that faced -Z.
fn anchor(data: &HouseData, object: ObjectId, which: Anchor) -> Vec3 {
    let root = data.parts[data.objects[object].first_part].world_from_part;
    let back = upright(-yaw_of(&root));
    let parts = data.objects[object].parts();
    let seen = parts
        .flat_map(|part| world_vertices(data, part))
        .map(|p| back * (p - root.position));
    let bounds = Aabb::from_points(seen);
    if bounds.is_empty() {
        return Vec3::ZERO;
    }
    let middle = bounds.center();
    match which {
        Anchor::Foot => middle.with_y(bounds.min.y),
        Anchor::Middle => middle,
        Anchor::Top => middle.with_y(bounds.max.y),
        Anchor::Origin => Vec3::ZERO,
    }
}

/// Returns the position of an object's anchor, m.
pub(super) fn anchor_in_world(data: &HouseData, object: ObjectId, which: Anchor) -> Vec3 {
    let root = data.parts[data.objects[object].first_part].world_from_part;
    root.position + upright(yaw_of(&root)) * anchor(data, object, which)
}

/// Moves objects, each part and each joint that hangs on the house.
pub(super) fn transform_objects(
    session: &mut EditSession<'_>,
    objects: &BTreeSet<ObjectId>,
    change: &Pose,
) {
    session.object_index.mark_moved(objects.iter().copied());
    for object in objects {
        let joints = session.object_index.joints_of(&session.data, *object);
        let data = &mut session.data;
        for part in data.objects[*object].parts() {
            let pose = &mut data.parts[part].world_from_part;
            *pose = *change * *pose;
        }
        for joint in joints {
            let joint = &mut data.joints[joint];
            if joint.parent.is_none() {
                joint.parent_from_joint = *change * joint.parent_from_joint;
            }
        }
    }
}

/// The movement that puts an object's anchor at a place with a heading; values that `placing` leaves open stay.
pub(super) fn placement_transform(
    session: &mut EditSession<'_>,
    object: ObjectId,
    placing: &Placement,
) -> Result<Pose, HousesError> {
    let data = &session.data;
    let root = data.parts[data.objects[object].first_part].world_from_part;
    let own = anchor(data, object, placing.anchor);
    let old_yaw = yaw_of(&root);
    let yaw = match placing.yaw_deg {
        Some(degrees) => {
            check_range("place.yaw_deg", degrees, [-36_000.0, 36_000.0], "degrees")?.to_radians()
        }
        None => old_yaw,
    };
    let old = root.position + upright(old_yaw) * own;
    // An exact identity rotation, so that unrotated objects keep their bits.
    let turn = if placing.yaw_deg.is_some() {
        upright(yaw - old_yaw)
    } else {
        Quat::IDENTITY
    };
    let parts = data.objects[object].parts();
    let around = parts
        .flat_map(|part| world_vertices(data, part))
        .map(|p| turn * (p - old));
    let around = Aabb::from_points(around);
    let target = target(session, object, placing, &around)?.unwrap_or(old);
    Ok(Pose::new(target - turn * old, turn))
}

/// Returns the target of the anchor; `None`: it stays. `around`: the box of the thing around its anchor after the rotation, m.
fn target(
    session: &mut EditSession<'_>,
    object: ObjectId,
    placing: &Placement,
    around: &Aabb,
) -> Result<Option<Vec3>, HousesError> {
    let at = placing
        .at
        .map(|at| checked_point("place.at", at))
        .transpose()?;
    let Some(on) = &placing.on else {
        return Ok(at);
    };
    if session.data.objects[object].name == *on {
        return Err(invalid_field(
            "place.on",
            format_args!("{on:?}, itself"),
            "another object",
        ));
    }
    let carrier = session.object("place.on", on)?;
    let data = &session.data;
    let Some(Vec3 { x, z, .. }) = at else {
        let boxes = session.object_index.bounding_boxes(data);
        let free = PlacementSearch::new(data, boxes, carrier, object, around).find_free_position();
        let [wide, deep] = [around.size().x, around.size().z];
        return free.map(Some).ok_or_else(|| {
            invalid_field(
                "place.on",
                format_args!("{on:?}, where nothing of {wide:.2} x {deep:.2} m is free"),
                "`at`, or something with more room on it",
            )
        });
    };
    let top = SupportSurface::of(data, carrier).height_m(Vec2::new(x, z));
    let top = top.ok_or_else(|| {
        let bounds = world_bounds(data, carrier);
        let [low, high] = [bounds.min, bounds.max];
        let possible = format!(
            "a place over {on:?}: x {:.3} to {:.3} m, z {:.3} to {:.3} m",
            low.x, high.x, low.z, high.z
        );
        invalid_field(
            "place.at",
            format!("x {x}, z {z}, where nothing of {on:?} is"),
            possible,
        )
    })?;
    Ok(Some(Vec3::new(x, top, z)))
}

/// The height of a triangle on a vertical line that meets it.
pub(super) fn triangle_height_at([a, b, c]: [Vec3; 3], xz: Vec2) -> Option<f32> {
    let flat = |p: Vec3| Vec2::new(p.x, p.z);
    let (u, v, w) = (flat(b) - flat(a), flat(c) - flat(a), xz - flat(a));
    let area = u.perp_dot(v);
    if area.abs() < 1e-9 {
        return None;
    }
    let (s, t) = (w.perp_dot(v) / area, u.perp_dot(w) / area);
    let meets = s >= -1e-4 && t >= -1e-4 && s + t <= 1.0 + 1e-4;
    meets.then_some(a.y + s * (b.y - a.y) + t * (c.y - a.y))
}

/// An object and all that stands on it or lies in it, directly or on one another. `boxes`: those around all objects, m.
///
/// # Errors
/// [`HousesError::Spec`] where more than 10,000 pairs of things lie in each other's boxes.
pub(super) fn with_supported_objects(
    data: &HouseData,
    boxes: &[Aabb],
    object: ObjectId,
) -> Result<BTreeSet<ObjectId>, HousesError> {
    let loose = |id: ObjectId| data.objects[id].mobility == dwell_scene::Mobility::Movable;
    let mut all = BTreeSet::from([object]);
    let mut open = vec![object];
    let mut pairs = 0;
    while let Some(carrier) = open.pop() {
        interrupt::unwind_if_cancelled();
        let below = &boxes[carrier.index()];
        let reach = below.grown(2.0 * GAP_M);
        for (thing, own) in data.objects.ids().zip(boxes) {
            if !own.intersects(&reach) || !loose(thing) || all.contains(&thing) {
                continue;
            }
            let (over, fits) = (is_over(own, below), House::fits_in(below, own));
            if pairs == MOST_PAIRS || !(over || fits) {
                continue;
            }
            interrupt::unwind_if_cancelled();
            pairs += 1;
            let rests = (over && touches(data, carrier, own))
                || (fits && data.encloses_at_start(carrier, below, own));
            if rests {
                all.insert(thing);
                open.push(thing);
            }
        }
    }
    if pairs < MOST_PAIRS {
        return Ok(all);
    }
    let found = format!("true, where more than {MOST_PAIRS} pairs of things lie in each other");
    let possible = "false, or fewer things in one place";
    Err(invalid_field("with_things", found, possible))
}

/// Returns whether the foot of a box is above the foot of another, and no higher than its top.
fn is_over(own: &Aabb, below: &Aabb) -> bool {
    let foot = own.center();
    !below.is_empty()
        && (below.min.x..=below.max.x).contains(&foot.x)
        && (below.min.z..=below.max.z).contains(&foot.z)
        && own.min.y > below.min.y + 0.01
        && own.min.y < below.max.y + GAP_M
}

/// Returns whether a carrier has a surface under some of what stands in a box over it.
fn touches(data: &HouseData, carrier: ObjectId, own: &Aabb) -> bool {
    let (foot, size) = (own.center(), own.size());
    let mut down = [0.0_f32, 0.25, -0.25]
        .into_iter()
        .flat_map(|x| [0.0_f32, 0.25, -0.25].map(|z| (x, z)));
    down.any(|(x, z)| {
        let at = Vec2::new(foot.x + x * size.x, foot.z + z * size.z);
        surface_near(data, carrier, at, own.min.y)
    })
}

/// Returns whether an object has a surface at about this height on a vertical line.
fn surface_near(data: &HouseData, object: ObjectId, xz: Vec2, height_m: f32) -> bool {
    let mut heights = triangles(data, object)
        .into_iter()
        .filter_map(|corners| triangle_height_at(corners, xz));
    heights.any(|y| (y - height_m).abs() < GAP_M)
}

/// The room and the storey of a box: the smallest room that holds its middle.
pub(super) fn containing_room_and_level(
    data: &HouseData,
    bounds: &Aabb,
) -> (Option<RoomId>, LevelId) {
    let middle = bounds.center();
    let holds = |room: &Room| {
        room.contains_xz(Vec2::new(middle.x, middle.z))
            && middle.y > room.floor_y - ROOM_M
            && middle.y < room.ceiling_y + ROOM_M
    };
    let strays = |room: &Room| middle.y < room.floor_y || middle.y > room.ceiling_y;
    let rooms = data.rooms.iter_ids().filter(|(_, room)| holds(room));
    let best = rooms.min_by(|(_, a), (_, b)| {
        strays(a)
            .cmp(&strays(b))
            .then(a.area_m2().total_cmp(&b.area_m2()))
    });
    if let Some((id, room)) = best {
        return (Some(id), room.level);
    }
    let below = data
        .levels
        .iter()
        .rposition(|level| level.bounds.min.y <= middle.y);
    (None, LevelId(below.unwrap_or(0) as u32))
}

/// Writes room and storey of an object and widens the storey's box around it.
pub(super) fn update_room_and_level(data: &mut HouseData, object: ObjectId) {
    let bounds = world_bounds(data, object);
    if bounds.is_empty() {
        return;
    }
    let (room, level) = containing_room_and_level(data, &bounds);
    (data.objects[object].room, data.objects[object].level) = (room, level);
    let all = &mut data.levels[level].bounds;
    *all = all.union(&bounds);
}
