//! Doors that swing towards the agent that opens them: where to stand so that the leaf passes.

use crate::world::World;
use dwell_scene::navigation::{DistanceField, NavCell, NavGrid};
use dwell_scene::{AgentId, AgentState, JointKind, ObjectId};
use glam::{Vec2, Vec3, Vec3Swizzles};
use std::sync::Arc;

/// Orders to open after which a door that does not move counts as held up.
const PATIENCE: u32 = 5;
/// Change of a door's openness between two orders below which it is held up.
const STILL: f32 = 0.002;
/// Room left between the swinging leaf and the body, m.
const CLEARANCE_M: f32 = 0.1;
/// Margin by which it stands nearer than its arm reaches, m.
const WITHIN_REACH_M: f32 = 0.1;

/// A door that is being opened.
#[derive(Clone, Debug)]
pub(super) struct DoorOpening {
    pub(super) door: ObjectId,
    openness: f32,
    still: u32,
    /// The path to where the leaf does not reach, once it was held up.
    pub(super) distance_to_clear_cells: Option<Arc<DistanceField>>,
    /// Whether its arm reaches the leaf from there: else it waits there, since a door that was told to open goes on by itself.
    pub(super) is_within_reach: bool,
}

impl DoorOpening {
    pub(super) fn new(door: ObjectId) -> Self {
        Self {
            door,
            openness: 0.0,
            still: 0,
            distance_to_clear_cells: None,
            is_within_reach: true,
        }
    }

    /// Notes one more order to open: steps aside where the door stands still for long.
    pub(super) fn count_open_request(&mut self, world: &World, grid: &NavGrid, agent: AgentId) {
        if self.stands_still(world) {
            let within_reach = cells_clear_of_leaf(world, grid, agent, self.door, true);
            self.is_within_reach = !within_reach.is_empty();
            let free = if self.is_within_reach {
                within_reach
            } else {
                cells_clear_of_leaf(world, grid, agent, self.door, false)
            };
            self.distance_to_clear_cells =
                (!free.is_empty()).then(|| Arc::new(grid.distance_field(&free)));
        }
    }

    /// Notes one more step; returns whether the door has not moved for long.
    pub(super) fn stands_still(&mut self, world: &World) -> bool {
        let now = world
            .state()
            .openness(world.house(), self.door)
            .unwrap_or(1.0);
        let moved = (now - self.openness).abs() > STILL;
        self.openness = now;
        self.still = if moved { 0 } else { self.still + 1 };
        if self.still > PATIENCE {
            self.still = 0;
            return true;
        }
        false
    }
}

/// Distance that a body and what it holds reach from its middle, m.
fn clearance_radius_m(world: &World, agent: &AgentState) -> f32 {
    let (house, state) = (world.house(), world.state());
    let held = agent.holding.map_or(0.0, |held| {
        let bounds = house.object_bounds(state, held);
        let at = agent.position;
        let far = (bounds.min - at).abs().max((bounds.max - at).abs());
        far.xz().length()
    });
    held.max(agent.body.radius_m)
}

/// Cells on the agent's side of a hinged door, from which its arm reaches the leaf or not, and where the leaf meets neither it nor what it
/// holds.
fn cells_clear_of_leaf(
    world: &World,
    grid: &NavGrid,
    agent: AgentId,
    door: ObjectId,
    within_reach: bool,
) -> Vec<NavCell> {
    let (house, state) = (world.house(), world.state());
    let hinge = house.joints_of(door).find(|joint| {
        house.joints[*joint].is_openable() && house.joints[*joint].kind == JointKind::Hinge
    });
    let (Some(hinge), Some(agent)) = (hinge, state.agents.get(agent)) else {
        return Vec::new();
    };
    let joint = &house.joints[hinge];
    let hung = joint.parent_from_joint.position;
    let axis = joint
        .parent
        .map_or(hung, |parent| state.part_pose[parent].transform_point(hung));
    let axis = axis.xz();
    let leaf = house.part_bounds(state, joint.child);
    let part = &house.parts[joint.child];
    let world_from_mesh = state.part_pose[joint.child].to_affine() * part.part_from_mesh;
    let swept_m = (house.meshes[part.mesh].positions.iter())
        .map(|corner| (world_from_mesh.transform_point3(*corner).xz() - axis).length())
        .fold(0.0, f32::max);
    let across = (leaf.center().xz() - axis).perp();
    let clear_m = swept_m + clearance_radius_m(world, agent) + CLEARANCE_M;
    let side = |at: Vec2| (at - axis).dot(across);
    let here = side(agent.position.xz());
    let eye = Vec3::Y * agent.body.eye_height_m;
    let free = |cell: &NavCell| {
        let at = grid.position(*cell);
        let from = at + eye;
        let apart_m = (from.clamp(leaf.min, leaf.max) - from).length();
        let reached = apart_m < agent.body.reach_m - WITHIN_REACH_M;
        let same_side = side(at.xz()) * here > 0.0;
        let is_clear = (at.xz() - axis).length() > clear_m;
        (reached || !within_reach) && same_side && is_clear && (at.y - agent.position.y).abs() < 0.5
    };
    grid.walkable().filter(free).collect()
}
