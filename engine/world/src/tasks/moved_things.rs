//! Whether things that lie about were moved, and lie still again.

use crate::world::World;
use dwell_scene::ObjectId;
use glam::Vec3;

/// How far a thing has come, m, from where it was known to be, for it to be looked for anew.
const MOVED_M: f32 = 0.1;
/// Below this speed a thing lies still, m/s.
const AT_REST_M_S: f32 = 0.05;

/// The middle of the box around a thing, m.
pub(super) fn box_centre(world: &World, object: ObjectId) -> Vec3 {
    world.house().object_bounds(world.state(), object).center()
}

/// Returns whether the middle of a thing's box has left `known`.
pub(super) fn was_moved(world: &World, object: ObjectId, known: Vec3) -> bool {
    box_centre(world, object).distance(known) > MOVED_M
}

/// How a thing lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum RestState {
    Held,
    Moving,
    AtRest,
}

/// How a thing lies now.
pub(super) fn rest_state(world: &World, object: ObjectId) -> RestState {
    let state = world.state();
    let part = world.house().objects[object].first_part;
    if state.agents.iter().any(|own| own.holding == Some(object)) {
        RestState::Held
    } else if state.part_velocity[part].linear.length() > AT_REST_M_S {
        RestState::Moving
    } else {
        RestState::AtRest
    }
}
