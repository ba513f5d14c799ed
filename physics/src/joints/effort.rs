//! The efforts that act along a joint: servo or hand, damping, friction.
//!
//! rapier's own motors are solved in turn with the rows that hold the joint together, and creep under load. Here each
//! effort is computed once a physics step for the joint's one degree of freedom, implicitly, so that stiff gains stay
//! stable and a joint at rest is held exactly, and is given to rapier as a force.

use super::Joint;
use crate::engine::Engine;
use dwell_scene::JointKind;
use glam::{Mat3, Vec3};
use rapier3d::dynamics::RigidBody;
use serde::{Deserialize, Serialize};

/// A pull towards a target, in the unit of its gain.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Pull {
    pub(crate) target: f32,
    /// N·m or N.
    pub(crate) max_effort: f32,
    pub(crate) gain: Gain,
}

/// How a pull grows with the way to its target.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) enum Gain {
    /// N·m/rad or N/m, and N·m·s/rad or N·s/m.
    Servo { stiffness: f32, damping: f32 },
    /// Critically damped: at least this natural frequency, and stiff enough to pull with all its effort at `lead` (rad or
    /// m) from the target.
    Hand { frequency_rad_s: f32, lead: f32 },
    /// Towards a velocity, N·m·s/rad or N·s/m.
    Velocity(f32),
    /// The target is the effort itself.
    Effort,
}

impl Pull {
    /// Stiffness and damping for an inertia.
    fn gains(&self, inertia: f32) -> (f32, f32) {
        match self.gain {
            Gain::Servo { stiffness, damping } => (stiffness, damping),
            Gain::Hand {
                frequency_rad_s,
                lead,
            } => {
                let slow = frequency_rad_s * frequency_rad_s * inertia;
                let stiffness = slow.max(self.max_effort / lead);
                (stiffness, 2.0 * (stiffness * inertia).sqrt())
            }
            Gain::Velocity(gain) => (0.0, gain),
            Gain::Effort => (0.0, 0.0),
        }
    }
}

/// One degree of freedom before a step.
#[derive(Clone, Copy, Debug)]
struct Freedom {
    position: f32,
    velocity: f32,
    /// kg·m² or kg.
    inertia: f32,
    /// The pull of gravity along it.
    weight: f32,
}

impl Freedom {
    /// The viscous effort that the velocity at the end of the step has.
    fn damping_effort(&self, damping: f32, dt_s: f32) -> f32 {
        let free = self.velocity + dt_s * self.weight / self.inertia;
        -damping * free / (1.0 + damping * dt_s / self.inertia)
    }

    /// The effort of a pull at the end of the step, with `other` efforts besides gravity.
    fn pull_effort(&self, pull: &Pull, other: f32, dt_s: f32) -> f32 {
        let (k, d) = pull.gains(self.inertia);
        let free = self.velocity + dt_s * (self.weight + other) / self.inertia;
        let soft = 1.0 + dt_s * (d + k * dt_s) / self.inertia;
        let effort = match pull.gain {
            Gain::Velocity(_) => d * (pull.target - free) / soft,
            Gain::Effort => pull.target,
            Gain::Servo { .. } | Gain::Hand { .. } => {
                (k * (pull.target - self.position - dt_s * free) - d * free) / soft
            }
        };
        effort.clamp(-pull.max_effort, pull.max_effort)
    }

    /// Coulomb friction: what stops the motion within the step, up to its bound.
    fn friction_effort(&self, friction: f32, other: f32, dt_s: f32) -> f32 {
        let free = self.velocity + dt_s * (self.weight + other) / self.inertia;
        (-free * self.inertia / dt_s).clamp(-friction, friction)
    }
}

/// A body's inertia about its centre of mass in world space, kg·m².
fn world_inertia(body: &RigidBody) -> Mat3 {
    let local = &body.mass_properties().local_mprops;
    let principal = local.principal_inertia();
    let turn = Mat3::from_quat(body.position().rotation * local.principal_inertia_local_frame);
    turn * Mat3::from_diagonal(principal) * turn.transpose()
}

/// The inertia of a body that turns about or slides along an axis through `at`, and the moment of its weight there.
fn load(body: &RigidBody, kind: JointKind, axis: Vec3, at: Vec3, gravity: Vec3) -> (f32, f32) {
    let mass = body.mass();
    let weight = gravity * mass * body.gravity_scale();
    match kind {
        JointKind::Slide => (mass, weight.dot(axis)),
        JointKind::Hinge => {
            let arm = body.center_of_mass() - at;
            let level = arm - axis * arm.dot(axis);
            let inertia = axis.dot(world_inertia(body) * axis) + mass * level.length_squared();
            (inertia, arm.cross(weight).dot(axis))
        }
    }
}

/// Gives rapier the efforts of a joint for the next step. `carried`: the bodies that hang on it, its own first.
pub(crate) fn exert(
    engine: &mut Engine,
    joint: &Joint,
    carried: &[rapier3d::dynamics::RigidBodyHandle],
    pull: Option<&Pull>,
    position: f32,
    dt_s: f32,
) {
    let Some(child) = engine.bodies.get(joint.child_handle) else {
        return;
    };
    if !child.is_dynamic() || child.is_sleeping() {
        return;
    }
    let (axis, at) = super::line(engine, joint);
    let (position, velocity) = super::read(engine, joint, position);
    let (mut inertia, mut weight) = (0.0, 0.0);
    for handle in carried {
        if let Some(body) = engine.bodies.get(*handle) {
            let (own, pulled) = load(body, joint.kind, axis, at, engine.gravity);
            inertia += own;
            weight += pulled;
        }
    }
    // What hangs on something that moves feels the lighter of the two.
    if let Some(parent) = engine
        .bodies
        .get(joint.parent_handle)
        .filter(|body| body.is_dynamic())
    {
        let (own, _) = load(parent, joint.kind, axis, at, engine.gravity);
        inertia = inertia * own / (inertia + own).max(f32::MIN_POSITIVE);
    }
    let freedom = Freedom {
        position,
        velocity,
        inertia: inertia.max(1e-9),
        weight,
    };
    let mut effort = freedom.damping_effort(joint.damping, dt_s);
    if let Some(pull) = pull {
        effort += freedom.pull_effort(pull, effort, dt_s);
    }
    effort += freedom.friction_effort(joint.friction, effort, dt_s);
    apply(engine, joint, axis, effort);
}

fn apply(engine: &mut Engine, joint: &Joint, axis: Vec3, effort: f32) {
    let Some(at) = engine
        .bodies
        .get(joint.child_handle)
        .map(RigidBody::center_of_mass)
    else {
        return;
    };
    for (handle, share) in [(joint.child_handle, effort), (joint.parent_handle, -effort)] {
        let Some(body) = engine.bodies.get(handle).filter(|body| body.is_dynamic()) else {
            continue;
        };
        let none = body.user_force() == Vec3::ZERO && body.user_torque() == Vec3::ZERO;
        if effort == 0.0 && none {
            continue;
        }
        if let Some(body) = engine.bodies.get_mut(handle) {
            match joint.kind {
                JointKind::Hinge => body.add_torque(axis * share, false),
                JointKind::Slide => body.add_force_at_point(axis * share, at, false),
            }
        }
    }
}

/// Takes the efforts of the last step back, before new ones are given.
pub(crate) fn relax(engine: &mut Engine, joint: &Joint) {
    for handle in [joint.child_handle, joint.parent_handle] {
        let awake = engine.bodies.get(handle).is_some_and(|body| {
            body.is_dynamic()
                && !body.is_sleeping()
                && (body.user_force() != Vec3::ZERO || body.user_torque() != Vec3::ZERO)
        });
        if awake && let Some(body) = engine.bodies.get_mut(handle) {
            body.reset_forces(false);
            body.reset_torques(false);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT_S: f32 = 1.0 / 120.0;

    fn freedom(position: f32, velocity: f32, weight: f32) -> Freedom {
        Freedom {
            position,
            velocity,
            inertia: 0.1,
            weight,
        }
    }

    /// At rest where the spring carries the weight, the effort is the weight, for any gains.
    #[test]
    fn a_pull_at_rest_carries_the_weight_exactly() {
        for stiffness in [1.0, 100.0, 1e6] {
            let pull = Pull {
                target: 0.5,
                max_effort: 1e9,
                gain: Gain::Servo {
                    stiffness,
                    damping: 3.0,
                },
            };
            let rest = freedom(0.5 - 2.0 / stiffness, 0.0, -2.0);
            let effort = rest.pull_effort(&pull, 0.0, DT_S);
            // f32 leaves the deflection 6e-8, times the stiffness.
            assert!(
                (effort - 2.0).abs() < 1e-4 + 6e-8 * stiffness,
                "{effort} at {stiffness}"
            );
        }
    }

    /// Whatever the gains, one step never turns an error into a larger one.
    #[test]
    fn stiff_gains_stay_stable() {
        for gain in [1.0, 1e3, 1e6, 1e9] {
            let pull = Pull {
                target: 0.0,
                max_effort: f32::MAX,
                gain: Gain::Servo {
                    stiffness: gain,
                    damping: gain,
                },
            };
            let (mut x, mut v) = (1.0, 0.0);
            for _ in 0..1000 {
                let effort = freedom(x, v, 0.0).pull_effort(&pull, 0.0, DT_S);
                v += effort / 0.1 * DT_S;
                x += v * DT_S;
                assert!(x.abs() <= 1.0 + 1e-4 && x.is_finite());
            }
            // The slowest mode decays with stiffness over damping, 1/s.
            assert!(x.abs() < 0.02, "{x} at {gain}");
        }
    }

    #[test]
    fn friction_holds_up_to_its_bound_and_never_reverses() {
        assert!((freedom(0.0, 0.0, 3.0).friction_effort(5.0, 0.0, DT_S) + 3.0).abs() < 1e-5);
        assert_eq!(freedom(0.0, 0.0, 8.0).friction_effort(5.0, 0.0, DT_S), -5.0);
        let slow = freedom(0.0, 0.1, 0.0);
        let stopped = 0.1 + slow.friction_effort(5.0, 0.0, DT_S) / 0.1 * DT_S;
        assert!(stopped.abs() < 1e-6);
    }
}
