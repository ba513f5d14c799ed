//! Support contacts of a tree with a free root in one step: they hold as far as they press and do not slip.
//!
//! A sticking point brakes its own motion so strongly that next to nothing is left of it. With these brakes the root's six
//! freedoms are eliminated, so that each joint has its true effective inertia: a knee under load a whole trunk, not a
//! shank. The supporting points are found in a few iterations, in which points that would pull are released and points that
//! would need more friction than there is slip.
//!
//! With the points' velocities `J v`, v the root's six and the joints', a step of length h is
//! `(M + h b J^T J) v' = M v + h (tau - C + J^T f)`: the brake b of points that stand, and the friction f of those that slip. M is
//! `[I^c_0 F; F^T H]` as in `floating_base`.
//!
//! # Source
//! The conditions of a point, which presses or parts and sticks or slips, are those of D. E. Stewart, J. C. Trinkle (Int. J. Numer.
//! Methods Eng. 39, 1996), with Coulomb's cone; here a set of active points is sought instead of the complementarity problem solved.

use super::convex_solver::{CholeskyFactor, SymmetricMatrix};
use super::floating_base::{FloatingBase, dot};
use super::tree_dynamics::{TreeDynamics, TreeLoads, Wrench};
use glam::DVec3;

/// Virtual mass of a sticking support point, in masses of the tree.
const STICKING_MASS_RATIO: f64 = 1e4;

/// The contact state of a support point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum SupportContactState {
    Sticking,
    /// It presses, and friction brakes it with this force, N.
    Sliding(DVec3),
    /// It does not press.
    Separated,
}

impl SupportContactState {
    /// Returns the directions in which it holds.
    fn constrained_directions(self) -> [bool; 3] {
        match self {
            Self::Sticking => [true; 3],
            Self::Sliding(_) => [false, true, false],
            Self::Separated => [false; 3],
        }
    }

    /// Returns the force that is independent of its motion.
    fn force(self) -> DVec3 {
        match self {
            Self::Sliding(force) => force,
            Self::Sticking | Self::Separated => DVec3::ZERO,
        }
    }
}

/// The Jacobian of a point by the root's freedoms and by the joints', in one direction.
struct PointJacobian {
    root: [f64; 6],
    /// Shape (freedom,).
    joints: Vec<f64>,
}

/// The root's part of a step's equations.
pub(super) struct BaseContactSolver {
    factor: CholeskyFactor,
    /// Coupling inertia of root and joints. Shape (freedom, 6).
    shared: Vec<[f64; 6]>,
    momentum: [f64; 6],
    before: [f64; 6],
    /// Shape (support, 3).
    rows: Vec<[PointJacobian; 3]>,
    /// Force for each unit of velocity of a sticking point, N·s/m.
    brake: f64,
    dt_s: f64,
}

/// The root's acceleration in a step, and its support forces.
#[derive(Clone, Debug)]
pub(super) struct BaseResponse {
    /// The change of its six velocities, per second.
    pub(super) accelerations: [f64; 6],
    /// On each support, N.
    pub(super) support_forces: Vec<DVec3>,
}

/// The joint-space equations of a step after elimination of the root: `inertia * velocity = momentum` at its end, without efforts.
pub(super) struct ReducedProblem {
    pub(super) inertia: SymmetricMatrix,
    /// Shape (freedom,).
    pub(super) momentum: Vec<f64>,
    pub(super) base_contacts: Option<BaseContactSolver>,
}

impl ReducedProblem {
    /// `holds`: the state of each support.
    pub(super) fn of(
        motion: &TreeDynamics<'_>,
        loads: &TreeLoads,
        now: &[f64],
        holds: &[SupportContactState],
        dt_s: f64,
    ) -> Self {
        let mut inertia = motion.fixed_base_inertia();
        let bias = motion.generalized_forces(loads, 0);
        // H q' - h C.
        let mut momentum = inertia.multiply(now);
        for (momentum, bias) in momentum.iter_mut().zip(&bias) {
            *momentum -= dt_s * bias;
        }
        let floating = motion.floating_base();
        let (efforts, root_efforts) = motion.generalized_contact_forces(floating.as_ref());
        for (momentum, effort) in momentum.iter_mut().zip(efforts) {
            *momentum += dt_s * effort;
        }
        let Some(floating) = floating else {
            return Self {
                inertia,
                momentum,
                base_contacts: None,
            };
        };
        let before = floating.base_velocity(&motion.root, motion.root_velocity);
        let mut own = floating.inertia();
        // I^c_0 v_0 + F q'.
        let mut root_momentum: [f64; 6] = std::array::from_fn(|k| {
            let shared = floating.momentum_jacobian.iter().zip(now);
            let joints: f64 = shared.map(|(column, now)| column[k] * now).sum();
            let root: f64 = (0..6).map(|j| own.get(k, j) * before[j]).sum();
            root + joints
        });
        for (momentum, felt) in root_momentum
            .iter_mut()
            .zip(floating.generalized_force(&loads.root[0]))
        {
            *momentum -= dt_s * felt;
        }
        for (momentum, column) in momentum.iter_mut().zip(&floating.momentum_jacobian) {
            *momentum += dot(column, &before);
        }
        let brake = STICKING_MASS_RATIO * floating.composite_body.mass / dt_s;
        let mut shared = floating.momentum_jacobian.clone();
        for (momentum, effort) in root_momentum.iter_mut().zip(root_efforts) {
            *momentum += dt_s * effort;
        }
        let rows: Vec<[PointJacobian; 3]> = motion
            .supports
            .iter()
            .map(|support| point_jacobian_rows(motion, &floating, support.link, support.position))
            .collect();
        let strength = brake * dt_s;
        for (rows, hold) in rows.iter().zip(holds) {
            // h J^T f.
            for (row, force) in rows.iter().zip(hold.force().to_array()) {
                for (root, way) in root_momentum.iter_mut().zip(row.root) {
                    *root += dt_s * force * way;
                }
                for (joint, way) in momentum.iter_mut().zip(&row.joints) {
                    *joint += dt_s * force * way;
                }
            }
            // h b J^T J.
            for (row, _) in rows
                .iter()
                .zip(hold.constrained_directions())
                .filter(|(_, holds)| *holds)
            {
                for k in 0..6 {
                    for j in 0..=k {
                        own.add(k, j, strength * row.root[k] * row.root[j]);
                    }
                }
                for (k, a) in row.joints.iter().enumerate().filter(|(_, a)| **a != 0.0) {
                    for (shared, root) in shared[k].iter_mut().zip(row.root) {
                        *shared += strength * a * root;
                    }
                    for (j, b) in row.joints.iter().enumerate().take(k + 1) {
                        inertia.add(k, j, strength * a * b);
                    }
                }
            }
        }
        // Schur's complement: H - F^T I^c_0^-1 F, and the same of the momentum.
        let factor = own.cholesky();
        let answer = factor.solve(&root_momentum);
        for (k, column) in shared.iter().enumerate() {
            momentum[k] -= dot(column, &answer);
            let own = factor.solve(column);
            for (j, other) in shared.iter().enumerate().take(k + 1) {
                inertia.add(k, j, -dot(&own, other));
            }
        }
        Self {
            inertia,
            momentum,
            base_contacts: Some(BaseContactSolver {
                factor,
                shared,
                momentum: root_momentum,
                before,
                rows,
                brake,
                dt_s,
            }),
        }
    }
}

/// Returns the Jacobian of a point of a joint's body (or the root), in three directions.
fn point_jacobian_rows(
    motion: &TreeDynamics<'_>,
    floating: &FloatingBase,
    link: Option<usize>,
    at: DVec3,
) -> [PointJacobian; 3] {
    let mut joints = vec![DVec3::ZERO; motion.axes.len()];
    let mut link = link;
    while let Some(k) = link {
        joints[k] = motion.axes[k].unit_velocity_at(at).0;
        link = motion.axes[k].parent;
    }
    let arm = at - floating.composite_body.center;
    let row = |way: DVec3| {
        let turn = arm.cross(way);
        PointJacobian {
            root: [way.x, way.y, way.z, turn.x, turn.y, turn.z],
            joints: joints.iter().map(|moves| moves.dot(way)).collect(),
        }
    };
    [row(DVec3::X), row(DVec3::Y), row(DVec3::Z)]
}

impl BaseContactSolver {
    /// Returns the root's response when the joints have these velocities at the end of the step.
    pub(super) fn base_response(
        &self,
        velocities: &[f64],
        holds: &[SupportContactState],
    ) -> BaseResponse {
        // I^c_0 v_0 = p_0 - F q'.
        let mut left = self.momentum;
        for (column, velocity) in self.shared.iter().zip(velocities) {
            for (left, shared) in left.iter_mut().zip(column) {
                *left -= shared * velocity;
            }
        }
        let root = self.factor.solve(&left);
        let force = |(rows, hold): (&[PointJacobian; 3], &SupportContactState)| {
            let along = |k: usize| {
                let moves = dot(&rows[k].root, &root) + dot(&rows[k].joints, velocities);
                if hold.constrained_directions()[k] {
                    // -b J v.
                    -self.brake * moves
                } else {
                    0.0
                }
            };
            hold.force() + DVec3::new(along(0), along(1), along(2))
        };
        BaseResponse {
            accelerations: std::array::from_fn(|k| (root[k] - self.before[k]) / self.dt_s),
            support_forces: self.rows.iter().zip(holds).map(force).collect(),
        }
    }
}

/// Releases points that pull, and lets points slip whose friction does not suffice. Returns whether anything changed.
pub(super) fn update_support_states(
    motion: &TreeDynamics<'_>,
    loads: &TreeLoads,
    answer: &BaseResponse,
    holds: &mut [SupportContactState],
) -> bool {
    let mut changed = false;
    let weighed = motion.supports.iter().zip(&loads.support_weights);
    for (((support, weight), force), hold) in weighed.zip(&answer.support_forces).zip(holds) {
        // f_n >= 0, and |f_t| <= mu f_n with the weight there for f_n.
        let aside = libm::hypot(force.x, force.z);
        let most = support.friction * weight;
        let next = match *hold {
            SupportContactState::Separated => SupportContactState::Separated,
            _ if force.y < 0.0 => SupportContactState::Separated,
            SupportContactState::Sticking if aside > most => {
                let share = most / aside;
                SupportContactState::Sliding(DVec3::new(force.x * share, 0.0, force.z * share))
            }
            same => same,
        };
        changed |= next != *hold;
        *hold = next;
    }
    changed
}

impl BaseResponse {
    /// Returns the force of a support as a load on its body about the body's centre.
    pub(super) fn wrench(&self, support: usize, at: DVec3, center: DVec3) -> Wrench {
        let force = self.support_forces[support];
        Wrench {
            force,
            torque: (at - center).cross(force),
        }
    }
}
