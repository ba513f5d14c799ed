//! States of things that are arranged for a question: a lamp that is on, a refrigerator that is open.

use crate::error::WorldError;
use crate::world::World;
use dwell_scene::{Aabb, JointId, ObjectId};
use dwell_semantics::ask::StateArrangement;

/// Room between an opened part and what else there is, m.
pub(super) const APART_M: f32 = 0.05;

/// What takes an arrangement back.
#[derive(Debug, Default)]
pub(super) struct Undo {
    joints: Vec<(JointId, f32, f32)>,
    switch: Option<(ObjectId, bool)>,
}

impl Undo {
    pub(super) fn apply(self, world: &mut World) -> Result<(), WorldError> {
        if let Some((object, was_on)) = self.switch {
            world.state.switched_on[object] = was_on;
        }
        if self.joints.is_empty() {
            return Ok(());
        }
        world.set_joints(&self.joints)
    }
}

/// Sets a state; `None` where there is no room for it, and then nothing has changed.
pub(super) fn arrange(
    world: &mut World,
    sets: Option<StateArrangement>,
) -> Result<Option<Undo>, WorldError> {
    match sets {
        None => Ok(Some(Undo::default())),
        Some(StateArrangement::Switch(object, is_on)) => {
            let switch = Some((object, world.state.switched_on[object]));
            world.state.switched_on[object] = is_on;
            Ok(Some(Undo {
                switch,
                ..Undo::default()
            }))
        }
        Some(StateArrangement::Open(object, is_open)) => {
            // What cannot stand open is not asked about when it is closed either: else closed things would be asked about more often.
            if holds_things(world, object) {
                return Ok(None);
            }
            let [before, opened] = joint_positions(world, object, true);
            world.set_joints(&opened)?;
            let undo = Undo {
                joints: before,
                ..Undo::default()
            };
            if !has_room(world, object) {
                undo.apply(world)?;
                return Ok(None);
            }
            if !is_open {
                let [_, closed] = joint_positions(world, object, false);
                world.set_joints(&closed)?;
            }
            Ok(Some(undo))
        }
    }
}

/// A joint with its position and velocity.
type JointPosition = (JointId, f32, f32);

/// Positions of the joints of a thing that open, as they are and as they are to be: all closed, but the first one where it is to be open.
fn joint_positions(world: &World, object: ObjectId, is_open: bool) -> [Vec<JointPosition>; 2] {
    let (house, state) = (world.house(), world.state());
    let joints = house.joints_of(object);
    let joints: Vec<JointId> = joints
        .filter(|joint| house.joints[*joint].is_openable())
        .collect();
    let before = joints
        .iter()
        .map(|joint| (*joint, state.joint_position[*joint], 0.0));
    let after = joints.iter().enumerate().map(|(k, joint)| {
        let own = &house.joints[*joint];
        let wanted = if is_open && k == 0 {
            own.open
        } else {
            own.closed
        };
        let reachable = state.joint_parameters(house, *joint).clamp(wanted);
        (*joint, reachable, 0.0)
    });
    [before.collect(), after.collect()]
}

/// Returns whether anything lies in or on a thing: it would not come along with what opens.
fn holds_things(world: &World, object: ObjectId) -> bool {
    let (house, state) = (world.house(), world.state());
    let own = house.object_bounds(state, object);
    let mut others = house.objects.ids().filter(|other| *other != object);
    others.any(|other| own.contains(house.object_bounds(state, other).center()))
}

/// The boxes around the parts of a thing that stand open, as they stand now.
pub(super) fn opened_bounds(world: &World, sets: Option<StateArrangement>) -> Vec<Aabb> {
    let Some(StateArrangement::Open(object, true)) = sets else {
        return Vec::new();
    };
    let (house, state) = (world.house(), world.state());
    let open = house.joints_of(object).filter(|joint| {
        let own = &house.joints[*joint];
        own.is_openable() && own.openness(state.joint_position[*joint]) > 0.0
    });
    open.map(|joint| house.part_bounds(state, house.joints[joint].child))
        .collect()
}

/// Returns whether the opened parts of a thing keep clear of all other things, and of the agents.
fn has_room(world: &World, object: ObjectId) -> bool {
    let (house, state) = (world.house(), world.state());
    let parts = opened_bounds(world, Some(StateArrangement::Open(object, true)));
    let others = house.objects.ids().filter(|other| *other != object);
    let mut others = others.map(|other| house.object_bounds(state, other));
    let mut agents = state.agents.iter();
    let clear = |bounds: &Aabb| {
        let grown = bounds.grown(APART_M);
        parts.iter().all(|part| !part.intersects(&grown))
    };
    let stands_clear = |agent: &dwell_scene::AgentState| {
        parts.iter().all(|part| {
            let feet = agent.position;
            let nearest = feet.clamp(part.min, part.max).with_y(feet.y);
            nearest.distance(feet) > agent.body.radius_m + APART_M
        })
    };
    others.all(|bounds| clear(&bounds)) && agents.all(stands_clear)
}
