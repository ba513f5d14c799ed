//! Joint positions and velocities, with the turns of hinges counted through a step.
//!
//! Body poses give a hinge's angle within a turn. The number of turns follows from the angle a physics step ago and the
//! motion since. rapier turns a body in each of its substeps by `2 atan(w h / 2)` instead of `w h`; the difference is given
//! back where nothing touches the body, so that a fast wheel's angle is the integral of its velocity. A wheel on the ground
//! stays where rapier's contacts saw it: its angle is short by 3e-4 of its way at 30 rad/s and by 4e-3 at 100 rad/s (at 480
//! substeps a second).

use super::PhysicsJoint;
use super::frame::RigidTransform;
use crate::engine::RapierWorld;
use dwell_scene::JointKind;
use glam::DVec3;
use rapier3d::dynamics::RigidBody;
use std::f64::consts::TAU;

/// The coordinates of a joint from which physics goes on: position and velocity. Bodies hold the same as poses and
/// velocities in the world, rounded to f32.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct JointKinematics {
    /// rad or m.
    pub(crate) position: f64,
    /// rad/s or m/s.
    pub(crate) velocity: f64,
}

/// Tolerance between a joint's values and those of its bodies, in spacings of f32: each is a difference of a few rounded
/// numbers.
const ROUNDINGS: f64 = 8.0;

/// A joint at one moment.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct JointReading {
    /// rad or m.
    pub(super) position: f64,
    /// rad/s or m/s.
    pub(super) velocity: f64,
    /// Angular velocities of the child and the parent body, rad/s.
    spins: [DVec3; 2],
}

/// Returns position and velocity of a joint, rad or m (and per second). `last_known` picks the turn of a hinge.
pub(crate) fn read_joint(
    engine: &RapierWorld,
    joint: &PhysicsJoint,
    last_known: f64,
) -> (f64, f64) {
    let reading = JointReading::of(engine, joint, last_known);
    (reading.position, reading.velocity)
}

/// Returns the coordinates from which physics goes on at a joint with the coordinates `last_known`: the same, where bodies
/// differ from them by no more than their rounding.
pub(crate) fn coordinates_at_step_start(
    engine: &RapierWorld,
    joint: &PhysicsJoint,
    last_known: JointKinematics,
) -> JointKinematics {
    JointReading::at_step_start(engine, joint, last_known).coordinate()
}

/// Returns the rounding error of a joint's position and velocity because bodies are f32: rad or m, and per second. A
/// position is rounded by its distance from the world's origin, a velocity by the bodies' own.
fn f32_rounding_error(engine: &RapierWorld, joint: &PhysicsJoint) -> [f64; 2] {
    let grain = ROUNDINGS * f64::from(f32::EPSILON);
    let mut sizes = [1.0_f64, 0.0];
    let child = engine.bodies.get(joint.child_handle);
    let at = child.map(RigidBody::center_of_mass);
    for handle in [joint.child_handle, joint.parent_handle] {
        let (Some(body), Some(at)) = (engine.bodies.get(handle), at) else {
            continue;
        };
        let spin = f64::from(body.angvel().length());
        sizes[1] += match joint.kind {
            JointKind::Hinge => spin,
            JointKind::Slide => {
                let place = body.translation().abs().max_element();
                sizes[0] = sizes[0].max(place.into());
                let arm = (at - body.center_of_mass()).length() + joint.reach_m();
                f64::from(body.linvel().length()) + spin * f64::from(arm)
            }
        };
    }
    sizes.map(|size| grain * size)
}

/// Returns the number of substeps in a physics step, and their length, s.
fn substeps(engine: &RapierWorld) -> (f64, f64) {
    (engine.substeps().into(), engine.substep_s().into())
}

/// Returns the velocity of a body's point, m/s.
fn velocity_at(body: &RigidBody, at: DVec3) -> DVec3 {
    let arm = at - body.center_of_mass().as_dvec3();
    body.linvel().as_dvec3() + body.angvel().as_dvec3().cross(arm)
}

impl JointReading {
    pub(super) fn coordinate(&self) -> JointKinematics {
        JointKinematics {
            position: self.position,
            velocity: self.velocity,
        }
    }

    pub(super) fn of(engine: &RapierWorld, joint: &PhysicsJoint, last_known: f64) -> Self {
        Self::measure_with(engine, joint, |_, _| (last_known, 0.0))
    }

    /// Returns the joint before a step. Where bodies differ from `last_known` by no more than their rounding, it has those
    /// coordinates: a joint put at a stop is at the stop, and a slide far from the origin moves as finely as one near it.
    pub(super) fn at_step_start(
        engine: &RapierWorld,
        joint: &PhysicsJoint,
        last_known: JointKinematics,
    ) -> Self {
        let reading = Self::of(engine, joint, last_known.position);
        let [place, speed] = f32_rounding_error(engine, joint);
        let held = |told: f64, found: f64, within: f64| {
            let same = (found - told).abs() <= within;
            if same { told } else { found }
        };
        Self {
            position: held(last_known.position, reading.position, place),
            velocity: held(last_known.velocity, reading.velocity, speed),
            ..reading
        }
    }

    /// Returns the joint at the end of a physics step that began with `self`.
    ///
    /// The turn is the right one while the joint's acceleration is constant, however fast it turns, and for an impact that
    /// changes its velocity by less than a turn a physics step, 754 rad/s at 120 Hz: the time of the impact in the step is
    /// not known.
    pub(super) fn at_step_end(&self, engine: &RapierWorld, joint: &PhysicsJoint) -> Self {
        let (count, substep_s) = substeps(engine);
        let turns_alone = is_contact_free(engine, joint);
        Self::measure_with(engine, joint, |now, axis| {
            let way = self.step_displacement(engine, now.velocity);
            let [child, parent] = [0, 1].map(|k| {
                let missing = missing_turn(self.spins[k], now.spins[k], count, substep_s);
                missing.dot(axis)
            });
            let missing = child - parent;
            let given_back = if turns_alone { missing } else { 0.0 };
            (self.position + way - missing, given_back)
        })
    }

    /// Returns the displacement of the joint in a physics step that it ends with a velocity, rad or m, at constant
    /// acceleration: rapier uses the velocity at the end of each substep.
    pub(super) fn step_displacement(&self, engine: &RapierWorld, velocity: f64) -> f64 {
        let (count, substep_s) = substeps(engine);
        let gained = (velocity - self.velocity) * 0.5 * (count + 1.0) / count;
        (self.velocity + gained) * count * substep_s
    }

    /// `expect`: from the joint's present motion and its axis in the world, its approximate position by its bodies, and
    /// their lost rotation.
    fn measure_with(
        engine: &RapierWorld,
        joint: &PhysicsJoint,
        expect: impl FnOnce(&Self, DVec3) -> (f64, f64),
    ) -> Self {
        let (Some(parent), Some(child)) = (
            engine.bodies.get(joint.parent_handle),
            engine.bodies.get(joint.child_handle),
        ) else {
            return Self::default();
        };
        let spins = [child, parent].map(|body| body.angvel().as_dvec3());
        let world_from_joint = RigidTransform::of(parent.position())
            .compose(&RigidTransform::of(&joint.parent_from_joint));
        let world_from_moved = RigidTransform::of(child.position())
            .compose(&RigidTransform::of(&joint.child_from_joint));
        let relative = world_from_joint.inverse().compose(&world_from_moved);
        let axis = joint.unit_axis();
        let in_world = world_from_joint.rotation * axis;
        match joint.kind {
            JointKind::Hinge => {
                let now = Self {
                    position: 0.0,
                    velocity: (spins[0] - spins[1]).dot(in_world),
                    spins,
                };
                let (last_known, missing) = expect(&now, in_world);
                let q = relative.rotation;
                let angle = 2.0 * libm::atan2(DVec3::new(q.x, q.y, q.z).dot(axis), q.w);
                let turns = libm::round((last_known - angle) / TAU);
                Self {
                    position: angle + turns * TAU + missing,
                    ..now
                }
            }
            JointKind::Slide => {
                let at = world_from_joint.translation;
                let velocity = velocity_at(child, at) - velocity_at(parent, at);
                Self {
                    position: relative.translation.dot(axis),
                    velocity: velocity.dot(in_world),
                    spins,
                }
            }
        }
    }
}

/// Returns whether a joint's body moves freely and nothing pressed on it in the last step.
pub(super) fn is_contact_free(engine: &RapierWorld, joint: &PhysicsJoint) -> bool {
    let Some(body) = engine.bodies.get(joint.child_handle) else {
        return false;
    };
    let pressed = |handle| {
        let mut pairs = engine.narrow_phase.contact_pairs_with(handle);
        pairs.any(|pair| pair.total_impulse_magnitude() > 0.0)
    };
    body.is_dynamic() && !body.is_sleeping() && !body.colliders().iter().any(|c| pressed(*c))
}

/// Returns the rotation that `count` substeps lose of a body that turned with `before` and now turns with `after`, rad/s; rad.
fn missing_turn(before: DVec3, after: DVec3, count: f64, substep_s: f64) -> DVec3 {
    let mut missing = DVec3::ZERO;
    let mut k = 1.0;
    while k <= count {
        let turn = before.lerp(after, k / count) * substep_s;
        let half = 0.5 * turn.length();
        let share = if half < 1e-2 {
            half * half / 3.0
        } else {
            1.0 - libm::atan(half) / half
        };
        missing += turn * share;
        k += 1.0;
    }
    missing
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rapier's rotation update repeated in complex numbers: the correction makes up for the loss at any speed.
    #[test]
    fn what_is_missing_makes_up_for_substeps() {
        for (before, after) in [(1.0, 3.0), (90.0, 100.0), (-400.0, 300.0), (1000.0, 1000.0)] {
            let (count, h) = (4.0, 1.0 / 480.0);
            let (mut angle, mut way) = (0.0, 0.0);
            for k in 1..=4 {
                let speed: f64 = before + (after - before) * f64::from(k) / count;
                angle += 2.0 * libm::atan2(0.5 * speed * h, 1.0);
                way += speed * h;
            }
            let missing = missing_turn(DVec3::X * before, DVec3::X * after, count, h);
            assert!((angle + missing.x - way).abs() < 1e-8, "{before} {after}");
        }
    }
}
