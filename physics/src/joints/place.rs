//! Puts the bodies of a tree where its joints are said to stand, with the velocities they are said to have.

use super::frame::Frame;
use super::{Joint, Tree};
use crate::engine::Engine;
use dwell_scene::JointKind;
use glam::{DVec3, Vec3};

/// Where one joint shall stand.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stand {
    /// rad or m.
    pub(crate) position: f32,
    /// rad/s or m/s.
    pub(crate) velocity: f32,
    /// Whether it is put there even if it stands there already.
    pub(crate) anew: bool,
    /// Whether its body stays where it is: a door that is shut.
    pub(crate) shut: bool,
}

/// A difference that rounding makes between a joint's number and what its bodies say, rad or m.
const ROUNDING: f32 = 5e-7;
/// The same for velocities, of which the bodies hold the sum along the chain, rad/s or m/s.
const SPEED_ROUNDING: f32 = 2e-6;

/// Places a tree's bodies, parents first; what stands and moves as told is left alone, so that it may sleep on. `stands`:
/// for each of the world's joints.
pub(crate) fn place(engine: &mut Engine, joints: &[Joint], tree: &Tree, stands: &[Stand]) {
    let mut moved = vec![false; tree.joints.len()];
    for (k, place) in tree.joints.iter().enumerate() {
        let (joint, stand) = (&joints[*place], &stands[*place]);
        if stand.shut {
            continue;
        }
        let (position, velocity) = super::read(engine, joint, stand.position);
        let there = (position - stand.position).abs() <= ROUNDING * stand.position.abs().max(1.0)
            && (velocity - stand.velocity).abs() <= SPEED_ROUNDING * stand.velocity.abs().max(1.0);
        let follows = tree.parents[k].is_some_and(|parent| moved[parent]);
        if there && !follows && !stand.anew {
            continue;
        }
        moved[k] = true;
        let stand = (stand.position.into(), stand.velocity.into());
        put(engine, joint, stand, true);
    }
}

/// Puts the body of a joint at a position (rad or m) with a velocity over where its parent is and how that moves.
pub(super) fn put(
    engine: &mut Engine,
    joint: &Joint,
    (position, velocity): (f64, f64),
    wake: bool,
) {
    let Some(parent) = engine.bodies.get(joint.parent_handle) else {
        return;
    };
    let world_from_joint = Frame::of(parent.position()).then(&Frame::of(&joint.parent_from_joint));
    let axis = joint.axis.as_dvec3().normalize_or(DVec3::X);
    let child_from_joint = Frame::of(&joint.child_from_joint);
    let place = world_from_joint
        .then(&Frame::along(joint.kind, axis, position))
        .then(&child_from_joint.inverse());
    let along = world_from_joint.turn * axis * velocity;
    let parent_turns = parent.angvel().as_dvec3();
    let parent_center = parent.center_of_mass().as_dvec3();
    let parent_moves = parent.linvel().as_dvec3();
    let Some(child) = engine.bodies.get_mut(joint.child_handle) else {
        return;
    };
    child.set_position(place.pose(), wake);
    let center = child.center_of_mass().as_dvec3();
    let at = world_from_joint.at;
    let with_parent = |point: DVec3| parent_moves + parent_turns.cross(point - parent_center);
    let (linear, angular) = match joint.kind {
        JointKind::Hinge => {
            let angular = parent_turns + along;
            (with_parent(at) + angular.cross(center - at), angular)
        }
        JointKind::Slide => (with_parent(center) + along, parent_turns),
    };
    let (linear, angular): (Vec3, Vec3) = (linear.as_vec3(), angular.as_vec3());
    child.set_linvel(linear, wake);
    child.set_angvel(angular, wake);
}

/// Whether bodies say the same of a joint as the numbers it was told, up to their rounding.
pub(crate) fn says_the_same(stand: &Stand, (position, velocity): (f32, f32)) -> bool {
    (position - stand.position).abs() <= 4.0 * ROUNDING * stand.position.abs().max(1.0)
        && (velocity - stand.velocity).abs() <= 8.0 * SPEED_ROUNDING * stand.velocity.abs().max(1.0)
}
