//! Forward kinematics: places the bodies of a tree at given joint positions and velocities.

use super::frame::RigidTransform;
use super::{KinematicTree, PhysicsJoint};
use crate::engine::RapierWorld;
use dwell_scene::JointKind;
use glam::{DVec3, Vec3};

/// The commanded placement of one joint.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ImposedJointState {
    /// rad or m.
    pub(crate) position: f32,
    /// rad/s or m/s.
    pub(crate) velocity: f32,
    /// Places it again even if it is there already.
    pub(crate) force_update: bool,
    /// Leaves its body in place: a door that is shut.
    pub(crate) is_latched: bool,
}

/// Tolerance for rounding between a joint's value and that of its bodies: rad or m, and rad/s or m/s.
const ROUNDING: f32 = 5e-7;
/// The least component of an axis along which the remainder of a rounded velocity goes.
const MIN_AXIS_COMPONENT: f64 = 0.2;

/// Places a tree's bodies, parents first; bodies that already have the commanded pose and velocity are left alone, so that
/// they may sleep on. `stands`: for each of the world's joints.
pub(crate) fn place_tree(
    engine: &mut RapierWorld,
    joints: &[PhysicsJoint],
    tree: &KinematicTree,
    placements: &[ImposedJointState],
) {
    let mut moved = vec![false; tree.joints.len()];
    for (k, place) in tree.joints.iter().enumerate() {
        let (joint, stand) = (&joints[*place], &placements[*place]);
        if stand.is_latched {
            continue;
        }
        let found = super::read_joint(engine, joint, stand.position.into());
        let there = stand.agrees_with(found, [ROUNDING, ROUNDING]);
        let follows = tree.parents[k].is_some_and(|parent| moved[parent]);
        if there && !follows && !stand.force_update {
            continue;
        }
        moved[k] = true;
        let stand = (stand.position.into(), stand.velocity.into());
        place_child(engine, joint, stand, true);
    }
}

/// Puts the body of a joint at a position (rad or m) with a velocity, relative to its parent's pose and motion.
pub(super) fn place_child(
    engine: &mut RapierWorld,
    joint: &PhysicsJoint,
    (position, velocity): (f64, f64),
    wake: bool,
) {
    let Some(parent) = engine.bodies.get(joint.parent_handle) else {
        return;
    };
    let world_from_joint = RigidTransform::of(parent.position())
        .compose(&RigidTransform::of(&joint.parent_from_joint));
    let axis = joint.unit_axis();
    let child_from_joint = RigidTransform::of(&joint.child_from_joint);
    let place = world_from_joint
        .compose(&RigidTransform::joint_displacement(
            joint.kind, axis, position,
        ))
        .compose(&child_from_joint.inverse());
    let axis = world_from_joint.rotation * axis;
    let along = axis * velocity;
    let parent_turns = parent.angvel().as_dvec3();
    let parent_center = parent.center_of_mass().as_dvec3();
    let parent_moves = parent.linvel().as_dvec3();
    let Some(child) = engine.bodies.get_mut(joint.child_handle) else {
        return;
    };
    child.set_position(place.pose(), wake);
    let center = child.center_of_mass().as_dvec3();
    let at = world_from_joint.translation;
    let with_parent = |point: DVec3| parent_moves + parent_turns.cross(point - parent_center);
    let (linear, angular) = match joint.kind {
        JointKind::Hinge => {
            let angular = parent_turns + along;
            let linear = with_parent(at) + angular.cross(center - at);
            (linear.as_vec3(), rounded_along(angular, axis))
        }
        JointKind::Slide => {
            let linear = rounded_along(with_parent(center) + along, axis);
            (linear, parent_turns.as_vec3())
        }
    };
    child.set_linvel(linear, wake);
    child.set_angvel(angular, wake);
}

/// Returns a velocity in f32 whose component along an axis is as near as f32 can have it: the rounding remainder along the
/// axis goes to the components with the finest spacing. Bodies hold sums along a chain, whose rounding is too coarse for
/// one joint.
fn rounded_along(velocity: DVec3, axis: DVec3) -> Vec3 {
    let mut rounded = velocity.as_vec3();
    let grain = |k: usize| velocity[k].abs() * axis[k].abs();
    let mut order = [0, 1, 2];
    order.sort_by(|a, b| grain(*b).total_cmp(&grain(*a)));
    for k in order {
        if axis[k].abs() >= MIN_AXIS_COMPONENT {
            let left = (velocity - rounded.as_dvec3()).dot(axis);
            rounded[k] = (f64::from(rounded[k]) + left / axis[k]) as f32;
        }
    }
    rounded
}

impl ImposedJointState {
    /// Returns whether a position and velocity agree with these, within these shares, or these values below 1.
    fn agrees_with(&self, (position, velocity): (f64, f64), within: [f32; 2]) -> bool {
        let same = |told: f32, found: f64, within: f32| {
            (found - f64::from(told)).abs() <= f64::from(within * told.abs().max(1.0))
        };
        same(self.position, position, within[0]) && same(self.velocity, velocity, within[1])
    }
}

/// Returns whether bodies agree with a joint's given coordinates, up to their rounding. A slide's coordinates are
/// differences of positions and velocities in the world, and round as those do.
pub(crate) fn matches_bodies(
    engine: &RapierWorld,
    joint: &PhysicsJoint,
    stand: &ImposedJointState,
    found: (f64, f64),
) -> bool {
    let (mut place, mut speed) = (1.0_f32, 1.0_f32);
    if joint.kind == JointKind::Slide {
        for handle in [joint.parent_handle, joint.child_handle] {
            if let Some(body) = engine.bodies.get(handle) {
                let at = body.position().translation.abs().max_element();
                place = place.max(at);
                speed = speed.max(body.linvel().length() + body.angvel().length() * at);
            }
        }
    }
    stand.agrees_with(found, [4.0 * ROUNDING * place, 32.0 * ROUNDING * speed])
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::random::RandomKey;

    /// Random sums of 30 rad/s about random axes: along the axis within 1e-6, where plain rounding is off by twice that,
    /// and no component is moved by more than ten times its rounding.
    #[test]
    fn a_velocity_is_rounded_so_that_its_part_along_the_axis_stays() {
        let (mut plain, mut worst) = (0.0_f64, 0.0_f64);
        for round in 0..20_000 {
            let mut draws = RandomKey::root(11).child(round).stream();
            let mut draw = || 2.0 * f64::from(draws.uniform_f32()) - 1.0;
            let velocity = DVec3::new(draw(), draw(), draw()) * 30.0;
            let axis = DVec3::new(draw(), draw(), draw()).normalize_or(DVec3::X);
            let found = rounded_along(velocity, axis).as_dvec3() - velocity;
            plain = plain.max((velocity.as_vec3().as_dvec3() - velocity).dot(axis).abs());
            worst = worst.max(found.dot(axis).abs());
            assert!(
                found.abs().max_element() < 2e-5,
                "{velocity} {axis}: {found}"
            );
        }
        assert!(worst <= 1e-6 && plain > 1.2e-6, "{worst} {plain}");
    }
}
