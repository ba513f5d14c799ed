//! Changes of a house before an episode begins: things lie elsewhere, furniture is open or closed.

use super::energy::OPEN_TOLERANCE;
use crate::error::WorldError;
use crate::tasks::goal_cells::LargestIslandIndex;
use crate::tasks::navigation::cells_in_reach;
use crate::world::World;
use dwell_physics::JointState;
use dwell_scene::navigation::{NavCell, NavGrid};
use dwell_scene::random::RandomStream;
use dwell_scene::{AgentId, Id, JointId, ObjectId, State};
use std::collections::BTreeSet;

/// Cells from which furniture must be reached.
const LEAST_CELLS: usize = 6;
/// Openness up to which furniture counts as closed, and from 1 less this on as open.
const SHUT: f32 = 0.05;
/// The least share to which closed furniture is opened.
const LEAST_OPEN: f32 = 0.6;
/// Control steps for which an opened thing must stand still, and nothing else move.
const TRIAL_STEPS: usize = 10;
/// What counts as standing still: a part's shift, m, and a joint's change of openness.
const STILL_M: f32 = 0.01;
const STILL: f32 = 0.02;

/// Furniture with one door, drawer or lid.
#[derive(Clone, Debug)]
pub(super) struct OpenableThing {
    pub(super) object: ObjectId,
    joint: JointId,
    /// Where a hand reaches it.
    pub(super) cells: Vec<NavCell>,
}

/// The furniture that can be opened or closed by hand and holds nothing loose; `doors`: those between rooms, which are none.
pub(super) fn openable_things(
    world: &World,
    agent: AgentId,
    (grid, doors): (&NavGrid, &[JointId]),
) -> Vec<OpenableThing> {
    let (house, state) = (world.house(), world.state());
    let ground = LargestIslandIndex::of(grid);
    let boxes = house.object_boxes(state);
    let loose = || house.objects.ids().filter(|id| house.objects[*id].pickable);
    let holding: BTreeSet<ObjectId> = loose()
        .flat_map(|object| state.containers_of(house, object, &boxes))
        .collect();
    let doors: BTreeSet<ObjectId> = doors.iter().map(|id| house.joints[*id].object).collect();
    let mut things = Vec::new();
    for object in house.objects.ids() {
        let thing = &house.objects[object];
        if thing.pickable || doors.contains(&object) || holding.contains(&object) {
            continue;
        }
        let joints = house.joints_of(object);
        let opening: Vec<JointId> = joints
            .filter(|id| house.joints[*id].is_openable())
            .collect();
        let [joint] = opening[..] else { continue };
        let openness = house.joints[joint].openness(state.joint_position[joint]);
        if (SHUT..=1.0 - SHUT).contains(&openness) || house.joints[joint].toggles_switch {
            continue;
        }
        dwell_scene::interrupt::unwind_if_cancelled();
        let cells = cells_in_reach(world, agent, &ground, object);
        if cells.len() >= LEAST_CELLS {
            things.push(OpenableThing {
                object,
                joint,
                cells,
            });
        }
    }
    things
}

impl OpenableThing {
    /// Opens what is closed and closes what is open, where it then stands still and nothing else moves. Returns whether it did.
    pub(super) fn toggle_open(
        &self,
        world: &mut World,
        stream: &mut RandomStream,
    ) -> Result<bool, WorldError> {
        let house = world.house().clone();
        let joint = &house.joints[self.joint];
        let before = joint.openness(world.state().joint_position[self.joint]);
        let share = if before <= SHUT {
            stream.range(LEAST_OPEN, 1.0)
        } else {
            0.0
        };
        let limits = world.state().joint_parameters(&house, self.joint);
        let position = limits.clamp(joint.position_at(share));
        if (joint.openness(position) - before).abs() <= OPEN_TOLERANCE + STILL {
            return Ok(false);
        }
        let (mut physics, mut state) = (world.physics.clone(), world.state().clone());
        let swung = JointState {
            joint: self.joint,
            position,
            velocity: 0.0,
        };
        physics.set_joints(&mut state, &[swung])?;
        let start = state.clone();
        let mut events = Vec::new();
        for _ in 0..TRIAL_STEPS {
            physics.step(&mut state, &[], &mut events)?;
            events.clear();
        }
        let kept = joint.openness(state.joint_position[self.joint]);
        let stands = (kept - joint.openness(position)).abs() <= STILL;
        if !stands || has_moved(&start, &state) {
            return Ok(false);
        }
        world.set_joints(&[(self.joint, position, 0.0)])?;
        Ok(true)
    }
}

/// Returns whether any part has moved from one state to another.
fn has_moved(before: &State, after: &State) -> bool {
    let parts = (0..before.part_pose.len()).map(dwell_scene::PartId::from_index);
    parts.into_iter().any(|part| {
        before.part_pose[part]
            .position
            .distance(after.part_pose[part].position)
            > STILL_M
    })
}
