//! Door leaves as they stand, since the grid of a walker takes all doors as open.

use crate::error::WorldError;
use crate::world::World;
use dwell_scene::navigation::{NavCell, NavDoor, NavGrid};
use dwell_scene::{Aabb, JointId, Pose};
use glam::Vec3;

/// A door's leaf as it stands now: a box in its own frame.
struct DoorLeafBox {
    leaf_from_world: Pose,
    bounds: Aabb,
}

impl DoorLeafBox {
    fn of(world: &World, door: &NavDoor) -> Self {
        let house = world.house();
        let child = house.joints[door.joint].child;
        let part = &house.parts[child];
        let corners = house.meshes[part.mesh].positions.iter();
        Self {
            leaf_from_world: world.state().part_pose[child].inverse(),
            bounds: Aabb::from_points(corners.map(|p| part.part_from_mesh.transform_point3(*p))),
        }
    }

    /// Distance from feet that stand at `at`, seen from above, m; leaves of other storeys are far.
    fn distance_m(&self, at: Vec3) -> f32 {
        // At half the height of a leaf, where handles stand out.
        let point = self.leaf_from_world.transform_point(at + Vec3::Y);
        (point.clamp(self.bounds.min, self.bounds.max) - point).length()
    }
}

/// Opens all doors of a grid as far as they go.
pub(super) fn open_all(world: &mut World, grid: &NavGrid) -> Result<(), WorldError> {
    let house = world.house().clone();
    let state = world.state();
    let all = grid.doors();
    let doors = all.iter().map(|door| {
        let open = house.joints[door.joint].open;
        let reachable = state.joint_parameters(&house, door.joint).clamp(open);
        (door.joint, reachable, 0.0)
    });
    let open: Vec<(JointId, f32, f32)> = doors.collect();
    world.set_joints(&open)
}

/// The leaves of all doors of a grid.
pub(super) struct DoorLeaves {
    leaves: Vec<DoorLeafBox>,
    apart_m: f32,
}

impl DoorLeaves {
    pub(super) fn of(world: &World, grid: &NavGrid) -> Self {
        let doors = grid.doors();
        Self {
            leaves: doors
                .iter()
                .map(|door| DoorLeafBox::of(world, door))
                .collect(),
            apart_m: grid.config().radius_m + 0.5 * grid.config().cell_m,
        }
    }

    /// Returns whether a body on `cell` would stand in a leaf.
    pub(super) fn is_blocked(&self, grid: &NavGrid, cell: NavCell) -> bool {
        let at = grid.position(cell);
        self.leaves
            .iter()
            .any(|leaf| leaf.distance_m(at) < self.apart_m)
    }
}
