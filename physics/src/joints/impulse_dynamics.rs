//! Impulse dynamics of trees: velocities of their bodies' points, and the response of their joints to impulses.
//!
//! A leaf that is hit beside its hinge gives way about the hinge and nowhere else. Rebounds that took its body for a free
//! or a fixed one would part too fast or too slowly.
//!
//! A point goes with `J q'` along a direction, an impulse P there changes velocities by `H^-1 J^T P`, and the point by `J H^-1 J^T P`.
//!
//! # Source
//! R. Featherstone, Rigid Body Dynamics Algorithms (2008), 11.7: impulsive dynamics in joint space.

use super::convex_solver::SymmetricMatrix;
use super::floating_base::{FloatingBase, dot};
use super::forward_kinematics;
use super::joint_state::JointKinematics;
use super::tree_dynamics::{JointAxisState, LinkMotion};
use super::tree_step::TreeStep;
use super::{KinematicTree, PhysicsJoint};
use crate::engine::RapierWorld;
use glam::{DVec3, Vec3};
use rapier3d::dynamics::RigidBodyHandle;

/// Distance from a stop within which a joint is at it, rad or m.
const AT_STOP: f64 = 1e-4;
/// Factor on the inertia of a rigid joint.
const RIGID: f64 = 1e6;

/// A tree after a step, whose velocities impulses change.
pub(crate) struct ImpulseDynamics {
    /// Its index among the world's trees.
    tree: usize,
    /// The joints that may move, by their indices in the tree. Shape (freedom,).
    free: Vec<usize>,
    /// rad or m. Shape (freedom,).
    positions: Vec<f64>,
    /// The lower and the upper stop of each where the joint is at it, or was when the step began. Shape (freedom,).
    at_stop: Vec<[Option<f64>; 2]>,
    axes: Vec<JointAxisState>,
    /// The bodies that the joints move. Shape (freedom,).
    bodies: Vec<RigidBodyHandle>,
    root_body: RigidBodyHandle,
    root: LinkMotion,
    root_velocity: DVec3,
    floating: Option<FloatingBase>,
    /// The joint-space inertia matrix, with a free root's six freedoms.
    inertia: SymmetricMatrix,
    /// Velocities of the joints, and of a free root's six freedoms.
    velocities: Vec<f64>,
    moved: bool,
}

/// A point of a tree's bodies and the direction of an impulse on it.
pub(crate) struct ImpulsePoint {
    /// Jacobian row: its speed in that direction for each unit of the tree's velocities.
    row: Vec<f64>,
    /// Change of the tree's velocities by 1 N·s in that direction.
    answer: Vec<f64>,
    /// Its speed in that direction by the motion of a kinematic root, m/s.
    root_velocity_along: f64,
}

impl ImpulsePoint {
    /// Returns how fast the point goes after 1 N·s, m/s: `J H^-1 J^T`.
    pub(crate) fn inverse_effective_mass(&self) -> f64 {
        dot(&self.row, &self.answer)
    }
}

impl ImpulseDynamics {
    /// Returns the index of a body's tree among the world's.
    pub(crate) fn tree_of(
        trees: &[KinematicTree],
        joints: &[PhysicsJoint],
        body: RigidBodyHandle,
    ) -> Option<usize> {
        let of = |tree: &KinematicTree| {
            let moved = tree.joints.iter().map(|k| joints[*k].child_handle);
            tree.root == body || moved.into_iter().any(|child| child == body)
        };
        trees.iter().position(of)
    }

    /// Returns the tree in its present motion; `None` where it sleeps or is latched. Takes each of the world's joints'
    /// coordinates before the step and now.
    pub(crate) fn of(
        engine: &RapierWorld,
        (trees, tree): (&[KinematicTree], usize),
        joints: &[PhysicsJoint],
        (began, joint_coordinates): (&[JointKinematics], &[JointKinematics]),
    ) -> Option<Self> {
        let number = tree;
        let tree = &trees[number];
        let standing = TreeStep::of(engine, tree, joints, joint_coordinates)?;
        let own = standing.joints(tree, joints);
        let positions = standing.positions();
        let mut velocities = standing.velocities();
        let motion = standing.chain.dynamics_at(&positions, &velocities, None);
        let floating = motion.floating_base();
        let n = own.len();
        let mut inertia = motion.fixed_base_inertia();
        for (k, joint) in own.iter().enumerate() {
            inertia.add(k, k, f64::from(joint.values.armature).max(0.0));
        }
        couple_mimic_joints(&mut inertia, tree, &standing.free, &own);
        if let Some(floating) = &floating {
            inertia = with_root(&inertia, floating, n);
            velocities.extend(floating.base_velocity(&motion.root, motion.root_velocity));
        }
        let at_stop = |k: usize| {
            let before = began[tree.joints[standing.free[k]]].position;
            let (least, most) = (before.min(positions[k]), before.max(positions[k]));
            own[k].values.limits.map_or([None; 2], |[low, high]| {
                let (low, high) = (f64::from(low), f64::from(high));
                let (at_low, at_high) = (least <= low + AT_STOP, most >= high - AT_STOP);
                [at_low.then_some(low), at_high.then_some(high)]
            })
        };
        let at_stop = (0..n).map(at_stop).collect();
        let bodies = own.iter().map(|joint| joint.child_handle).collect();
        let (axes, root, root_velocity) = (motion.axes, motion.root, motion.root_velocity);
        Some(Self {
            tree: number,
            free: standing.free,
            positions,
            at_stop,
            axes,
            bodies,
            root_body: tree.root,
            root,
            root_velocity,
            floating,
            inertia,
            velocities,
            moved: false,
        })
    }

    /// Stops a joint, with the impulse along it that this takes.
    fn stop(&mut self, k: usize) {
        let mut along = vec![0.0; self.velocities.len()];
        along[k] = 1.0;
        let answer = self.inertia.cholesky().solve(&along);
        // q'_k + (H^-1)_kk P = 0.
        let impulse = -self.velocities[k] / answer[k];
        for (velocity, answer) in self.velocities.iter_mut().zip(&answer) {
            *velocity += impulse * answer;
        }
        self.velocities[k] = 0.0;
        self.moved = true;
    }

    /// Returns its index among the world's trees.
    pub(crate) fn tree(&self) -> usize {
        self.tree
    }

    /// Returns a point of a body with a direction of impulse; `None` for a body that does not give way. A joint that this
    /// presses against its stop stays there: rapier's stops would throw it back.
    pub(crate) fn point(
        &mut self,
        body: RigidBodyHandle,
        at: Vec3,
        direction: Vec3,
    ) -> Option<ImpulsePoint> {
        let (at, direction) = (at.as_dvec3(), direction.as_dvec3());
        let mut link = self.bodies.iter().position(|own| *own == body);
        if link.is_none() && (body != self.root_body || self.floating.is_none()) {
            return None;
        }
        let mut row = vec![0.0; self.velocities.len()];
        while let Some(k) = link {
            // J_k = n . S_k at the point.
            row[k] = self.axes[k].unit_velocity_at(at).0.dot(direction);
            link = self.axes[k].parent;
        }
        let mut root_velocity_along = 0.0;
        if let Some(floating) = &self.floating {
            let turn = (at - floating.composite_body.center).cross(direction);
            let six = direction.to_array().into_iter().chain(turn.to_array());
            for (entry, value) in row.iter_mut().skip(self.axes.len()).zip(six) {
                *entry = value;
            }
        } else {
            let arm = at - self.root.center;
            root_velocity_along =
                (self.root_velocity + self.root.angular.cross(arm)).dot(direction);
        }
        let answer = self.unit_impulse_response(&row);
        Some(ImpulsePoint {
            row,
            answer,
            root_velocity_along,
        })
    }

    /// Returns the velocity change by 1 N·s. Joints at a stop are not moved through it.
    fn unit_impulse_response(&mut self, row: &[f64]) -> Vec<f64> {
        let mut inertia = self.inertia.clone();
        // H^-1 J^T.
        let mut answer = inertia.cholesky().solve(row);
        let mut held = vec![false; self.at_stop.len()];
        loop {
            let presses = |k: &usize| {
                let [low, high] = self.at_stop[*k];
                let stop = if answer[*k] < 0.0 { low } else { high };
                stop.filter(|_| !held[*k] && answer[*k] != 0.0)
            };
            let Some((k, stop)) = (0..held.len()).find_map(|k| Some((k, presses(&k)?))) else {
                return answer;
            };
            held[k] = true;
            inertia.add(k, k, RIGID * inertia.get(k, k));
            answer = inertia.cholesky().solve(row);
            self.positions[k] = stop;
            if self.velocities[k] != 0.0 {
                self.stop(k);
            }
        }
    }

    /// Returns the speed of a point in its direction, m/s.
    pub(crate) fn point_speed(&self, point: &ImpulsePoint) -> f64 {
        dot(&point.row, &self.velocities) + point.root_velocity_along
    }

    /// Applies an impulse at a point in its direction, N·s.
    pub(crate) fn apply_impulse(&mut self, point: &ImpulsePoint, impulse: f64) {
        for (velocity, answer) in self.velocities.iter_mut().zip(&point.answer) {
            *velocity += impulse * answer;
        }
        self.moved |= impulse != 0.0;
    }

    /// Returns the velocities, for [`ImpulseDynamics::restore_velocities`].
    pub(crate) fn velocities(&self) -> Vec<f64> {
        self.velocities.clone()
    }

    /// Restores velocities.
    pub(crate) fn restore_velocities(&mut self, velocities: &[f64]) {
        self.velocities.copy_from_slice(velocities);
    }

    /// Writes the velocities to the bodies; `joint_coordinates`: the coordinates of each of the world's joints. Returns
    /// whether anything was changed.
    pub(crate) fn write_velocities(
        &self,
        engine: &mut RapierWorld,
        trees: &[KinematicTree],
        joints: &[PhysicsJoint],
        joint_coordinates: &mut [JointKinematics],
    ) -> bool {
        if !self.moved {
            return false;
        }
        let n = self.axes.len();
        if let (Some(floating), Some(body)) =
            (&self.floating, engine.bodies.get_mut(self.root_body))
        {
            let six = &self.velocities[n..];
            let angular = DVec3::new(six[3], six[4], six[5]);
            let arm = self.root.center - floating.composite_body.center;
            let linear = DVec3::new(six[0], six[1], six[2]) + angular.cross(arm);
            body.set_linvel(linear.as_vec3(), false);
            body.set_angvel(angular.as_vec3(), false);
        }
        for (k, free) in self.free.iter().enumerate() {
            let (position, velocity) = (self.positions[k], self.velocities[k]);
            let joint = trees[self.tree].joints[*free];
            joint_coordinates[joint] = JointKinematics { position, velocity };
            forward_kinematics::place_child(engine, &joints[joint], (position, velocity), false);
        }
        true
    }
}

/// Couples mimic joints: they move only as their leaders do.
fn couple_mimic_joints(
    inertia: &mut SymmetricMatrix,
    tree: &KinematicTree,
    free: &[usize],
    joints: &[&PhysicsJoint],
) {
    for (k, (joint, place)) in joints.iter().zip(free).enumerate() {
        if let Some(leader) = tree.mimic_leaders[*place]
            && let Some(mimic) = &joint.values.mimic
            && let Some(leader) = free.iter().position(|other| *other == leader)
        {
            // H + s w w^T for the equation w q' = 0, w = (1, -multiplier) for follower and leader.
            let share = f64::from(mimic.multiplier);
            let strength = RIGID * inertia.get(k, k);
            inertia.add(k, k, strength);
            inertia.add(k, leader, -strength * share);
            inertia.add(leader, leader, strength * share * share);
        }
    }
}

/// The inertia of `n` joints and of a root that is free: `[H F^T; F I^c_0]`.
fn with_root(joints: &SymmetricMatrix, floating: &FloatingBase, n: usize) -> SymmetricMatrix {
    let mut all = SymmetricMatrix::zero(n + 6);
    for k in 0..n {
        for j in 0..=k {
            all.set(k, j, joints.get(k, j));
        }
        for (j, share) in floating.momentum_jacobian[k].iter().enumerate() {
            all.set(n + j, k, *share);
        }
    }
    let root = floating.inertia();
    for k in 0..6 {
        for j in 0..=k {
            all.set(n + k, n + j, root.get(k, j));
        }
    }
    all
}
