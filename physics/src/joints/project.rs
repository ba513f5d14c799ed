//! Projection of a tree that was touched in a step onto its joint constraints.
//!
//! rapier solves the rows of joints and of contacts in turn, and leaves errors in both: a light finger between a hand and
//! its held object wobbles in its joint until the grip is lost. Of the motion that rapier leaves, joints keep the part that
//! they allow, with the same momentum along each, and bodies are put at their joints' positions.
//!
//! # Source
//! C. F. Gauss's principle of least constraint: of the motions that joints allow, the one nearest to the unconstrained one,
//! weighed by mass. R. Featherstone, Rigid Body Dynamics Algorithms (2008), 6.2, for the joint-space inertia.

use super::PhysicsJoint;
use super::convex_solver::{EffortProblem, EffortTerm, SymmetricMatrix};
use super::floating_base::FloatingBase;
use super::forward_kinematics;
use super::joint_state::JointKinematics;
use super::tree::KinematicTree;
use super::tree_dynamics::{TreeDynamics, Wrench};
use super::tree_step::TreeStep;
use crate::engine::RapierWorld;
use glam::DVec3;

/// Steepness of a rigid stop, relative to inertia.
const RIGID: f64 = 1e6;

impl TreeStep {
    /// Puts the bodies of a tree at their joints' positions after a step, with velocities that its joints allow. `ends`:
    /// the end position of a joint whose motion was undisturbed, if it moved; the common centre of mass stays.
    /// `joint_coordinates`: the coordinates of each of the world's joints.
    pub(super) fn project(
        mut self,
        engine: &mut RapierWorld,
        tree: &KinematicTree,
        joints: &[PhysicsJoint],
        ends: &[Option<f64>],
        joint_coordinates: &mut [JointKinematics],
    ) {
        self.chain.read_root_motion(engine, tree);
        let (positions, velocities) = (self.positions(), self.velocities());
        let joints = self.joints(tree, joints);
        let motion = self.chain.dynamics_at(&positions, &velocities, None);
        let momenta: Vec<Wrench> = joints
            .iter()
            .zip(&motion.masses)
            .map(|(joint, lump)| {
                let Some(body) = engine.bodies.get(joint.child_handle) else {
                    return Wrench::default();
                };
                let (linear, angular) = (body.linvel().as_dvec3(), body.angvel().as_dvec3());
                let (linear, angular) =
                    motion.velocity_relative_to_root(lump.center, linear, angular);
                let force = linear * lump.mass;
                Wrench {
                    force,
                    torque: lump.inertia * angular + lump.center.cross(force),
                }
            })
            .collect();
        let floating = motion.floating_base();
        let inertia = motion.joint_space_inertia();
        let held = stop_impulse_terms(&joints, &positions, &inertia);
        let (velocity, root) =
            motion.velocities_from_momenta(floating.as_ref(), momenta, (inertia, held));
        if let (Some((linear, angular)), Some(body)) = (root, engine.bodies.get_mut(tree.root)) {
            body.set_linvel(linear.as_vec3(), false);
            body.set_angvel(angular.as_vec3(), false);
        }
        let arrived: Vec<f64> = joints
            .iter()
            .zip(positions.iter().zip(ends))
            .map(|(joint, (position, end))| snap_to_limit(joint, *position, *end))
            .collect();
        if floating.is_some() && arrived != positions {
            let shift = motion.center_of_mass()
                - self
                    .chain
                    .dynamics_at(&arrived, &velocities, None)
                    .center_of_mass();
            if let Some(body) = engine.bodies.get_mut(tree.root) {
                let at = body.position().translation.as_dvec3() + shift;
                body.set_translation(at.as_vec3(), false);
            }
        }
        let states = arrived.into_iter().zip(velocity);
        for ((joint, k), (position, velocity)) in joints.iter().zip(&self.free).zip(states) {
            let [low, high] = joint.stops();
            let position = position.max(low).min(high);
            joint_coordinates[tree.joints[*k]] = JointKinematics { position, velocity };
            forward_kinematics::place_child(engine, joint, (position, velocity), false);
        }
    }
}

/// Returns the position of a joint at `position` that would come to `end` undisturbed: at the stop that it reached, and not short of it.
fn snap_to_limit(joint: &PhysicsJoint, position: f64, end: Option<f64>) -> f64 {
    let [low, high] = joint.stops();
    match end {
        Some(end) if end <= low || end >= high => end,
        _ => position,
    }
}

/// Returns the impulses that stop joints beyond their stops: a plastic impact, with the momentum that it gives the others.
fn stop_impulse_terms(
    joints: &[&PhysicsJoint],
    positions: &[f64],
    inertia: &SymmetricMatrix,
) -> Vec<EffortTerm> {
    let held = |(k, (joint, position)): (usize, (&&PhysicsJoint, &f64))| {
        let [low, high] = joint.stops();
        let bounds = if *position < low {
            [0.0, f64::INFINITY]
        } else if *position > high {
            [f64::NEG_INFINITY, 0.0]
        } else {
            return None;
        };
        Some(EffortTerm {
            index: k,
            opposing: None,
            offset: 0.0,
            slope: RIGID * inertia.get(k, k),
            bounds,
            speed_limit: None,
        })
    };
    let pairs = joints.iter().zip(positions).enumerate();
    pairs.filter_map(held).collect()
}

impl TreeDynamics<'_> {
    /// Returns the velocity and angular velocity of a body relative to a kinematic root. A free root counts with the others.
    fn velocity_relative_to_root(
        &self,
        center: DVec3,
        linear: DVec3,
        angular: DVec3,
    ) -> (DVec3, DVec3) {
        if self.free_root.is_some() {
            return (linear, angular);
        }
        let with_root = self.root_velocity + self.root.angular.cross(center - self.root.center);
        (linear - with_root, angular - self.root.angular)
    }

    /// Returns the common centre of mass of all that moves, m.
    fn center_of_mass(&self) -> DVec3 {
        let root = self.free_root.unwrap_or_default();
        let whole = self
            .masses
            .iter()
            .fold(root, |whole, mass| whole.combined_with(mass));
        whole.center
    }

    /// Returns the joints' velocities, and those of a free root's centre of mass and its rotation, that have these momenta
    /// about the origin, less those taken by stops: of the joints' bodies, shape (freedom,), and of the root.
    fn velocities_from_momenta(
        &self,
        floating: Option<&FloatingBase>,
        mut momenta: Vec<Wrench>,
        (inertia, stops): (SymmetricMatrix, Vec<EffortTerm>),
    ) -> (Vec<f64>, Option<(DVec3, DVec3)>) {
        let mut whole = match &self.free_root {
            Some(root) => {
                let force = self.root_velocity * root.mass;
                let moment = root.inertia * self.root.angular + root.center.cross(force);
                Wrench {
                    force,
                    torque: moment,
                }
            }
            None => Wrench::default(),
        };
        for k in (0..momenta.len()).rev() {
            let below = momenta[k];
            let above = match self.axes[k].parent {
                Some(parent) => &mut momenta[parent],
                None => &mut whole,
            };
            *above = above.add_scaled(&below, 1.0);
        }
        // S^T h: the momentum along each joint of all that it moves.
        let along = self.axes.iter().zip(&momenta);
        let mut along: Vec<f64> = along
            .map(|(axis, momentum)| axis.generalized_force_of(momentum))
            .collect();
        if let Some(floating) = floating {
            floating.subtract_base_load(&whole, &mut along);
        }
        // H q' = S^T h, the normal equations of the least constraint; stops take what they hold.
        let velocity = EffortProblem {
            free_velocities: inertia.cholesky().solve(&along),
            inertia,
            terms: stops,
            dt_s: 1.0,
        }
        .solve();
        let Some(floating) = floating else {
            return (velocity, None);
        };
        // I^c_0 v_0 = h_0 - F q'.
        let mut left = floating.generalized_force(&whole);
        for (column, velocity) in floating.momentum_jacobian.iter().zip(&velocity) {
            for (left, share) in left.iter_mut().zip(column) {
                *left -= share * velocity;
            }
        }
        let six = floating.inertia().cholesky().solve(&left);
        let angular = DVec3::new(six[3], six[4], six[5]);
        let arm = self.root.center - floating.composite_body.center;
        let linear = DVec3::new(six[0], six[1], six[2]) + angular.cross(arm);
        (velocity, Some((linear, angular)))
    }
}
