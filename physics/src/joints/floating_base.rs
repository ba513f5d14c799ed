//! A root that is free to answer what its joints do.
//!
//! With the root's acceleration `a_0`, the inertia `I^c_0` of the whole tree and F, the tree's momentum for each unit of the joints'
//! velocities, the equation of motion is `[I^c_0 F; F^T H] [a_0; q''] = [-p_0; tau - C]`. Elimination of `a_0` leaves the joints
//! `H - F^T I^c_0^-1 F` as inertia and `C - F^T I^c_0^-1 p_0` as bias.
//!
//! # Source
//! R. Featherstone, Rigid Body Dynamics Algorithms (2008), 9.4: forward dynamics of floating bases. The elimination is Schur's
//! complement.

use super::convex_solver::{CholeskyFactor, SymmetricMatrix};
use super::tree_dynamics::{JointAxisState, LinkMotion, SpatialInertia, Wrench};
use glam::DVec3;

/// The six freedoms of a root: the velocity of the tree's centre of mass as if all joints stood, and its rotation.
pub(super) struct FloatingBase {
    /// The tree as one body.
    pub(super) composite_body: SpatialInertia,
    factor: CholeskyFactor,
    /// Linear and angular momentum about the common centre of mass for each unit of a joint's velocity. Shape (freedom, 6).
    pub(super) momentum_jacobian: Vec<[f64; 6]>,
}

fn six(linear: DVec3, angular: DVec3) -> [f64; 6] {
    [
        linear.x, linear.y, linear.z, angular.x, angular.y, angular.z,
    ]
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl FloatingBase {
    pub(super) fn of(
        root: &SpatialInertia,
        axes: &[JointAxisState],
        carried: &[SpatialInertia],
        momenta: &[(DVec3, DVec3)],
    ) -> Self {
        let children = axes
            .iter()
            .zip(carried)
            .filter(|(axis, _)| axis.parent.is_none());
        let whole = children.fold(*root, |whole, (_, mass)| whole.combined_with(mass));
        // F_k = I^c_k S_k, about the centre of mass of all, where linear and angular momentum are apart.
        let columns = momenta
            .iter()
            .zip(carried)
            .map(|((linear, angular), mass)| {
                six(
                    *linear,
                    *angular + (mass.center - whole.center).cross(*linear),
                )
            })
            .collect();
        Self {
            composite_body: whole,
            factor: spatial_inertia_matrix(&whole).cholesky(),
            momentum_jacobian: columns,
        }
    }

    /// Takes off what the joints' inertia loses because the root gives way: `F^T I^c_0^-1 F`.
    pub(super) fn subtract_base_inertia(&self, inertia: &mut SymmetricMatrix) {
        for (k, column) in self.momentum_jacobian.iter().enumerate() {
            let answer = self.factor.solve(column);
            for (j, other) in self.momentum_jacobian.iter().enumerate().take(k + 1) {
                inertia.set(k, j, inertia.get(k, j) - dot(&answer, other));
            }
        }
    }

    /// Returns what the six freedoms resist with, `I^c_0`.
    pub(super) fn inertia(&self) -> SymmetricMatrix {
        spatial_inertia_matrix(&self.composite_body)
    }

    /// Returns the six velocities of a root with this motion and velocity of its centre of mass.
    pub(super) fn base_velocity(&self, root: &LinkMotion, velocity: DVec3) -> [f64; 6] {
        let there = velocity + root.angular.cross(self.composite_body.center - root.center);
        six(there, root.angular)
    }

    /// Returns a load about the origin as a generalized force on the six freedoms.
    pub(super) fn generalized_force(&self, load: &Wrench) -> [f64; 6] {
        six(
            load.force,
            load.torque - self.composite_body.center.cross(load.force),
        )
    }

    /// Takes off what the joints' efforts lose because the root gives way under a load: `F^T I^c_0^-1 p_0`.
    pub(super) fn subtract_base_load(&self, load: &Wrench, efforts: &mut [f64]) {
        let answer = self.factor.solve(&self.generalized_force(load));
        for (effort, column) in efforts.iter_mut().zip(&self.momentum_jacobian) {
            *effort -= dot(&answer, column);
        }
    }

    /// Returns the root's motion when its six velocities change at this rate, per second.
    pub(super) fn base_motion_at(&self, root: &LinkMotion, gained: &[f64; 6]) -> LinkMotion {
        let linear = DVec3::new(gained[0], gained[1], gained[2]);
        let angular = DVec3::new(gained[3], gained[4], gained[5]);
        LinkMotion {
            acceleration: root.acceleration
                + linear
                + angular.cross(root.center - self.composite_body.center),
            angular_acceleration: root.angular_acceleration + angular,
            ..*root
        }
    }
}

fn spatial_inertia_matrix(whole: &SpatialInertia) -> SymmetricMatrix {
    let mut own = SymmetricMatrix::zero(6);
    for k in 0..3 {
        own.set(k, k, whole.mass);
        for j in 0..3 {
            own.set(3 + k, 3 + j, whole.inertia.col(j)[k]);
        }
    }
    own
}
