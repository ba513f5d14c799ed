//! How far things are from how they are to be: the energies of `RoomR`.
//!
//! # Source
//! L. Weihs, M. Deitke, A. Kembhavi, R. Mottaghi, "Visual Room Rearrangement", CVPR 2021, with the numbers of its code
//! (`ai2thor-rearrangement`): 0.5 as least overlap, 0.2 as tolerance of openness, 2 m as barrier; boxes nearer than 1 cm and 10 degrees
//! overlap wholly.

use super::box_overlap::OrientedBox;
use crate::world::World;
use dwell_scene::{Aabb, JointId, ObjectId, PartId, Pose, math};
use std::collections::BTreeSet;

/// Least overlap (intersection over union) at which a thing is in its place.
const MIN_IOU: f64 = 0.5;
/// Distance of the nearest corners from which on it costs no more, m.
const BARRIER_M: f64 = 2.0;
/// Largest difference of openness at which furniture is as it was.
pub(super) const OPEN_TOLERANCE: f32 = 0.2;
/// Within this distance, m, and angle, rad, boxes count as one.
const SAME_M: f32 = 0.01;
const SAME_RAD: f32 = 10.0 * std::f32::consts::PI / 180.0;

/// The energy of a thing that is to be at `goal`, 0 to 1.
fn pose_energy(goal: &OrientedBox, now: &OrientedBox) -> f64 {
    let (there, here) = (goal.world_from_box, now.world_from_box);
    let turn = (there.rotation.inverse() * here.rotation).w.abs().min(1.0);
    if here.position.distance(there.position) < SAME_M && 2.0 * math::acos(turn) < SAME_RAD {
        return 0.0;
    }
    let iou = goal.iou(now);
    let apart = if iou > 0.0 {
        0.0
    } else {
        (goal.corner_distance_m(now) / BARRIER_M).min(1.0)
    };
    0.5 * (1.0 - iou / MIN_IOU).max(0.0) + 0.5 * apart
}

/// A thing that can be moved or opened, and how it is to be.
#[derive(Clone, Debug)]
pub(super) struct TrackedThing {
    pub(super) object: ObjectId,
    pub(super) goal: ThingGoal,
}

/// How a thing is to be.
#[derive(Clone, Copy, Debug)]
pub(super) enum ThingGoal {
    /// Where its first part is to stand, and its box in that part's frame, m.
    Pose {
        part: PartId,
        world_from_part: Pose,
        bounds: Aabb,
    },
    /// How far open it is to be, 0 to 1.
    Openness(f32),
}

impl TrackedThing {
    pub(super) fn energy(&self, world: &World) -> f64 {
        match self.goal {
            ThingGoal::Pose {
                part,
                world_from_part,
                bounds,
            } => {
                let now = world.state().part_pose[part];
                if now == world_from_part {
                    return 0.0;
                }
                let goal = OrientedBox::of(world_from_part, &bounds);
                pose_energy(&goal, &OrientedBox::of(now, &bounds))
            }
            ThingGoal::Openness(goal) => {
                let now = world.state().openness(world.house(), self.object);
                f64::from(u8::from(
                    (now.unwrap_or(goal) - goal).abs() > OPEN_TOLERANCE,
                ))
            }
        }
    }
}

/// All things that count, as they are now: what a hand can take, and furniture that opens, but no doors between rooms.
pub(super) fn tracked_things(world: &World, doors: &[JointId]) -> Vec<TrackedThing> {
    let (house, state) = (world.house(), world.state());
    let doors: BTreeSet<ObjectId> = doors.iter().map(|id| house.joints[*id].object).collect();
    let mut things = Vec::new();
    for (object, thing) in house.objects.iter_ids() {
        if thing.pickable {
            let bounds = bounds_in_first_part(world, object);
            if !bounds.is_empty() {
                things.push(TrackedThing {
                    object,
                    goal: ThingGoal::Pose {
                        part: thing.first_part,
                        world_from_part: state.part_pose[thing.first_part],
                        bounds,
                    },
                });
            }
        } else if let Some(openness) = state
            .openness(house, object)
            .filter(|_| !doors.contains(&object))
        {
            things.push(TrackedThing {
                object,
                goal: ThingGoal::Openness(openness),
            });
        }
    }
    things
}

/// The box around a thing along the axes of its first part, m.
fn bounds_in_first_part(world: &World, object: ObjectId) -> Aabb {
    let (house, state) = (world.house(), world.state());
    let thing = &house.objects[object];
    let frame_from_world = state.part_pose[thing.first_part].inverse();
    thing.parts().fold(Aabb::EMPTY, |bounds, id| {
        let part = &house.parts[id];
        let frame_from_part = frame_from_world * state.part_pose[id];
        let frame_from_mesh = frame_from_part.to_affine() * part.part_from_mesh;
        let corners = house.meshes[part.mesh].positions.iter();
        let corners = corners.map(|corner| frame_from_mesh.transform_point3(*corner));
        bounds.union(&Aabb::from_points(corners))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Quat, Vec3};

    #[test]
    fn energies_are_those_worked_out_by_hand() {
        let bounds = Aabb::new(Vec3::splat(-0.05), Vec3::splat(0.05));
        let at = |x: f32, turn: Quat| OrientedBox::of(Pose::new(Vec3::X * x, turn), &bounds);
        let goal = at(0.0, Quat::IDENTITY);
        let energy = |x: f32| pose_energy(&goal, &at(x, Quat::IDENTITY));
        for (x, expected) in [
            (0.0, 0.0),
            // Nearer than 1 cm, and 2.5 cm beside: (10 - 2.5) / (10 + 2.5) = 0.6 overlap.
            (0.009, 0.0),
            (0.025, 0.0),
            // 5 cm beside: a third; 0.5 * (1 - 2 / 3).
            (0.05, 1.0 / 6.0),
            // Apart by 10 cm, by 1 m, by more than the barrier.
            (0.2, 0.5 + 0.5 * 0.1 / 2.0),
            (1.1, 0.75),
            (3.0, 1.0),
        ] {
            assert!((energy(x) - expected).abs() < 1e-5, "{x}: {}", energy(x));
        }
        // A sheet on its edge overlaps little with one that lies.
        let sheet = Aabb::new(Vec3::new(-0.1, 0.0, -0.1), Vec3::new(0.1, 0.01, 0.1));
        let lying = OrientedBox::of(Pose::IDENTITY, &sheet);
        let edge = Pose::new(
            Vec3::ZERO,
            Quat::from_rotation_x(std::f32::consts::FRAC_PI_2),
        );
        let found = pose_energy(&lying, &OrientedBox::of(edge, &sheet));
        // Rotated about a middle axis of its lower side: what is common is 0.2 x 0.01 x 0.01 of two times 0.2 x 0.01 x 0.2.
        let iou = 0.01 / (0.4 - 0.01);
        assert!((found - 0.5 * (1.0 - iou / 0.5)).abs() < 1e-4, "{found}");
    }
}
