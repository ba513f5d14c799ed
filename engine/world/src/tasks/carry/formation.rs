//! A thing that stands on the floor, and the two who carry it by its ends.

use crate::world::World;
use dwell_physics::BOTH_HANDS;
use dwell_scene::{AgentBody, House, Mobility, ObjectId, PartId, Pose, math};
use glam::{Quat, Vec3};

/// Gap between an end of the thing and the body that holds it, m.
const GAP_M: f32 = 0.1;
/// The longest edge, seen from above, of what is carried, m.
const LONGEST_M: [f32; 2] = [0.8, 2.3];
/// Its height, m.
const HEIGHT_M: [f32; 2] = [0.3, 1.2];
/// Room that is kept around the thing and around its carriers, m.
const MARGIN_M: f32 = 0.06;
const BESIDE_M: f32 = 0.03;

/// A thing with two carriers. Frames: that of its first part.
#[derive(Clone, Debug)]
pub(super) struct CarryFormation {
    pub(super) object: ObjectId,
    pub(super) part: PartId,
    /// Where it stands at the start.
    pub(super) start: Pose,
    /// Where its carriers stand, in its frame, m; the first that of the first carrier.
    pub(super) feet: [Vec3; 2],
    /// The box around it, in its frame: the middle, and the edges, m.
    pub(super) middle: Vec3,
    pub(super) size: Vec3,
    /// What stands or lies on it, and on that.
    along: Vec<ObjectId>,
    body: AgentBody,
}

/// Returns a yaw about the vertical.
pub(super) fn yaw_rotation(yaw_rad: f32) -> Quat {
    let (sine, cosine) = math::sin_cos(0.5 * yaw_rad);
    Quat::from_xyzw(0.0, sine, 0.0, cosine)
}

/// The turn about the vertical from one orientation to another, rad, -pi to pi.
pub(super) fn yaw_between(from: Quat, to: Quat) -> f32 {
    let ahead = (to * from.inverse()) * Vec3::X;
    math::atan2(-ahead.z, ahead.x)
}

/// Returns what stands or lies on an object, and on that; `supports`: of each object. Shape (object,).
fn things_on(house: &House, supports: &[Vec<Option<ObjectId>>], object: ObjectId) -> Vec<ObjectId> {
    let mut found = vec![object];
    let mut next = 0;
    while let Some(below) = found.get(next).copied() {
        next += 1;
        for (id, own) in house.objects.ids().zip(supports) {
            // What stands on the floor as well does not come along.
            if !own.is_empty() && own.iter().all(|on| *on == Some(below)) && !found.contains(&id) {
                found.push(id);
            }
        }
    }
    found.split_off(1)
}

impl CarryFormation {
    /// The formations of a house's things that two bodies can carry.
    pub(super) fn all(world: &World, body: &AgentBody) -> Vec<Self> {
        let house = world.house();
        let supports = world.state().supports_of_all(house);
        let things = house.objects.ids();
        things
            .filter(|object| world.state().held_by[*object].is_none())
            .filter_map(|object| {
                let formation = Self::of(world, house, object, body)?;
                let along = things_on(house, &supports, object);
                Some(Self { along, ..formation })
            })
            .collect()
    }

    fn of(world: &World, house: &House, object: ObjectId, body: &AgentBody) -> Option<Self> {
        let thing = &house.objects[object];
        let parts: Vec<PartId> = thing.parts().collect();
        // With drawers or doors it is a tree of bodies, which nobody takes hold of.
        let jointed = house.joints.iter().any(|joint| joint.object == object);
        if thing.mobility != Mobility::Movable || thing.pickable || jointed {
            return None;
        }
        let part = thing.first_part;
        let mass_kg = world.physics().body_mass_kg(part)?;
        if mass_kg <= body.lift_kg || mass_kg > 2.0 * BOTH_HANDS * body.lift_kg {
            return None;
        }
        let start = world.state().part_pose[part];
        let is_upright = (start.rotation * Vec3::Y).y > 0.999;
        let to_own = start.inverse();
        // The box around all parts along the axes of the first.
        let mut low = Vec3::splat(f32::INFINITY);
        let mut high = Vec3::splat(f32::NEG_INFINITY);
        for id in parts {
            let own = &house.parts[id];
            let place = to_own * world.state().part_pose[id];
            for point in &house.meshes[own.mesh].positions {
                let at = place.transform_point(own.part_from_mesh.transform_point3(*point));
                (low, high) = (low.min(at), high.max(at));
            }
        }
        let (middle, size) = (0.5 * (low + high), high - low);
        let longest_m = size.x.max(size.z);
        let fits = (LONGEST_M[0]..=LONGEST_M[1]).contains(&longest_m)
            && (HEIGHT_M[0]..=HEIGHT_M[1]).contains(&size.y);
        if !is_upright || !fits || !longest_m.is_finite() {
            return None;
        }
        let along = if size.x >= size.z { Vec3::X } else { Vec3::Z };
        let away_m = 0.5 * longest_m + GAP_M + body.radius_m;
        let foot = |side: f32| (middle + along * (side * away_m)).with_y(low.y);
        Some(Self {
            object,
            part,
            start,
            feet: [foot(-1.0), foot(1.0)],
            middle,
            size,
            along: Vec::new(),
            body: *body,
        })
    }

    /// Where a carrier stands with the thing at a pose, m.
    pub(super) fn carrier_position(&self, pose: &Pose, carrier: usize) -> Vec3 {
        pose.transform_point(self.feet[carrier])
    }

    /// The pose after the middle has been moved by `way` from the start and the thing turned by `yaw_rad`.
    pub(super) fn pose(&self, way: Vec3, yaw_rad: f32) -> Pose {
        let rotation = (yaw_rotation(yaw_rad) * self.start.rotation).normalize();
        let middle = self.start.transform_point(self.middle) + way;
        Pose::new(middle - rotation * self.middle, rotation)
    }

    /// Returns whether both carriers have room beside the thing at a pose, on the floor of a room.
    pub(super) fn carriers_have_room(&self, world: &World, pose: &Pose) -> bool {
        (0..2).all(|carrier| {
            let feet = self.carrier_position(pose, carrier);
            let size = (self.body.radius_m + BESIDE_M, self.body.height_m);
            world.house().room_at(feet + Vec3::Y * 0.1).is_some()
                && world
                    .physics()
                    .has_room_to_stand(self.part, feet, size, &self.along)
        })
    }

    /// Returns whether there is room for all at a pose.
    pub(super) fn has_room(&self, world: &World, pose: &Pose) -> bool {
        self.carriers_have_room(world, pose)
            && world
                .physics()
                .has_room_for_body(self.part, pose, MARGIN_M, &self.along)
    }
}
