//! Doorways: the rooms that doors connect.

use dwell_scene::bvh::{Ray, RayMask};
use dwell_scene::math;
use dwell_scene::rays::RayScene;
use dwell_scene::{Aabb, ObjectId, RoomId, State, SurfaceOwner};
use glam::Vec3;

/// Distance beyond a door's box at which its other side is looked up, m.
const DOORSTEP_M: f32 = 0.35;
/// Further distance from which the open air is looked for, clear of thick walls, m.
const CLEAR_M: f32 = 0.25;
/// The height above the door's foot at which they look, m.
const EYES_M: f32 = 1.3;
/// Directions in which they look, away from the door: 30 degrees apart.
const VIEW_OFFSETS: [f32; 5] = [-2.0, -1.0, 0.0, 1.0, 2.0];
const TURN_RAD: f32 = std::f32::consts::FRAC_PI_6;

/// The sides of a door or archway.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RoomDoorway {
    /// The rooms on its sides, ascending: two as a rule; one where it leads outside, or stands within a room.
    pub rooms: Vec<RoomId>,
    /// True if one of its sides is in the open air, outside of every room.
    pub outside: bool,
}

impl RoomDoorway {
    /// Looks across the frame: a door's first part when it has several, else the whole, `bounds`; when that is not clearly
    /// thinner one way (a single mesh with an open leaf), on all four sides.
    pub(crate) fn gather(rays: &RayScene, state: &State, door: ObjectId, bounds: Aabb) -> Self {
        let house = rays.house();
        let object = &house.objects[door];
        let bounds = if object.part_count > 1 {
            house.part_bounds(state, object.first_part)
        } else {
            bounds
        };
        let (center, half) = (bounds.center(), bounds.size() * 0.5);
        let across_x = (half.x < 1.5 * half.z).then_some((Vec3::X, half.x));
        let across_z = (half.z < 1.5 * half.x).then_some((Vec3::Z, half.z));
        let (mut rooms, mut open) = (Vec::new(), false);
        for (axis, half_m) in across_x.into_iter().chain(across_z) {
            let sides = [axis, -axis].map(|out| {
                let room = house.room_at(center + out * (half_m + DOORSTEP_M));
                (out, room)
            });
            rooms.extend(sides.iter().filter_map(|(_, room)| *room));
            if let [(out, None), (_, Some(_))] | [(_, Some(_)), (out, None)] = sides {
                let aside = center + out * (half_m + DOORSTEP_M + CLEAR_M);
                let eye = Vec3::new(aside.x, bounds.min.y + EYES_M, aside.z);
                open |= is_open_air(rays, eye, out);
            }
        }
        rooms.sort();
        rooms.dedup();
        Self {
            outside: open && rooms.len() == 1,
            rooms,
        }
    }

    /// The rooms that it leads to from `room`.
    pub fn rooms_beyond(&self, room: RoomId) -> impl Iterator<Item = RoomId> {
        let rooms = self.rooms.iter().copied();
        rooms.filter(move |other| *other != room)
    }
}

/// Returns whether the sky is visible from `eye`, or the open beyond the building towards `out`: houses have shafts and corridors that
/// are no rooms of theirs.
fn is_open_air(rays: &RayScene, eye: Vec3, out: Vec3) -> bool {
    let free = |direction: Vec3| {
        let hit = rays.closest(&Ray::new(eye, direction), RayMask::EYE);
        hit.is_none_or(|hit| !matches!(rays.owner_and_material(&hit).0, SurfaceOwner::Structure(_)))
    };
    let aside = Vec3::Y.cross(out);
    free(Vec3::Y)
        || VIEW_OFFSETS.iter().any(|turns| {
            let (sine, cosine) = math::sin_cos(turns * TURN_RAD);
            free(out * cosine + aside * sine)
        })
}
