//! Laws that exert forces on jointed bodies, or on roots of trees.
//!
//! Such a body moves as the joints of its tree allow, so that a law cannot change its velocity between steps as that of a
//! free body: it returns a force, and the tree is integrated with all forces at once.

use glam::{DMat3, DVec3};
use std::fmt::Debug;

/// A law that exerts forces on bodies of kinematic trees.
pub(crate) trait LinkLaw: Debug + Send + Sync {
    /// Returns the wrench on a jointed body, or on a free root of a tree. It is called several times in a step, until the
    /// tree's motion and the wrenches agree.
    fn wrench(&self, link: &LinkState) -> ExternalWrench;
}

/// A body of a kinematic tree, at the beginning of a step or at its middle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LinkState {
    /// Index of its plan in the model.
    pub(crate) body: u32,
    pub(crate) mass_kg: f64,
    /// About its centre of mass, world axes, kg·m².
    pub(crate) inertia: DMat3,
    /// Of its centre of mass, m/s.
    pub(crate) velocity: DVec3,
    /// rad/s.
    pub(crate) angular_velocity: DVec3,
    /// Length of the step, s.
    pub(crate) dt_s: f64,
    /// Set if velocities are those at the middle of the step.
    pub(crate) is_midpoint: bool,
    /// Since the world was made, s.
    pub(crate) time_s: f64,
}

/// A force at a body's centre of mass, N, and a moment, N·m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ExternalWrench {
    pub(crate) force: DVec3,
    pub(crate) torque: DVec3,
}

impl ExternalWrench {
    /// Returns the sum of both.
    pub(crate) fn sum(self, other: Self) -> Self {
        Self {
            force: self.force + other.force,
            torque: self.torque + other.torque,
        }
    }
}

impl LinkState {
    /// Returns the share of its momentum that a body loses each second under a decay with `rate_per_s`, for the whole step,
    /// so that an otherwise free body slows exponentially and never reverses.
    pub(crate) fn decay_per_s(&self, rate_per_s: f64) -> f64 {
        let times = rate_per_s * self.dt_s;
        if self.is_midpoint {
            // v' - v = -2 tanh(r dt / 2) (v' + v) / 2 is v' = v exp(-r dt).
            2.0 * libm::tanh(0.5 * times) / self.dt_s
        } else {
            -libm::expm1(-times) / self.dt_s
        }
    }

    /// Returns the same for a decay whose rate is `per_m` times the speed against the air.
    pub(crate) fn quadratic_decay_per_s(&self, per_m: f64, speed_m_s: f64) -> f64 {
        let rate = per_m * speed_m_s;
        if self.is_midpoint {
            self.decay_per_s(rate)
        } else {
            rate / (1.0 + rate * self.dt_s)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn link(velocity: f64, dt_s: f64, middle: bool) -> LinkState {
        LinkState {
            body: 0,
            mass_kg: 1.0,
            inertia: DMat3::IDENTITY,
            velocity: DVec3::X * velocity,
            angular_velocity: DVec3::ZERO,
            dt_s,
            is_midpoint: middle,
            time_s: 0.0,
        }
    }

    /// For any step, by either end's formula, the decay is exponential.
    #[test]
    fn a_decay_is_exact_for_any_step() {
        for dt_s in [1e-4, 1.0 / 120.0, 0.5, 20.0] {
            let expected = libm::exp(-3.0 * dt_s);
            let from_start = 1.0 - dt_s * link(1.0, dt_s, false).decay_per_s(3.0);
            assert!((from_start - expected).abs() < 1e-12);
            let half = 0.5 * dt_s * link(1.0, dt_s, true).decay_per_s(3.0);
            assert!(((1.0 - half) / (1.0 + half) - expected).abs() < 1e-12);
            let quadratic = link(7.0, dt_s, false).quadratic_decay_per_s(0.2, 7.0);
            assert!((1.0 - dt_s * quadratic - 1.0 / (1.0 + 1.4 * dt_s)).abs() < 1e-12);
        }
    }
}
