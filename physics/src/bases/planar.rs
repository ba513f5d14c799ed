//! Poses and twists on a floor.

use glam::Vec3;
use serde::{Deserialize, Serialize};

/// A pose on a floor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PlanarPose {
    /// m.
    pub x_m: f64,
    /// m.
    pub y_m: f64,
    /// rad, positive to the left; not wrapped.
    pub heading_rad: f64,
}

/// The velocity of a body in its own frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PlanarTwist {
    /// m/s.
    pub forward_m_s: f64,
    /// m/s.
    pub left_m_s: f64,
    /// rad/s, positive to the left.
    pub yaw_rate_rad_s: f64,
}

/// `sin(x) / x`.
fn sinc(x: f64) -> f64 {
    if x.abs() < 1e-4 {
        // The next term is x^4 / 120 < 1e-18.
        1.0 - x * x / 6.0
    } else {
        libm::sin(x) / x
    }
}

impl PlanarPose {
    /// Returns the pose after moving with a constant twist for `duration_s`: exactly, on an arc of a circle.
    ///
    /// # Source
    /// The exponential map of SE(2): R. M. Murray, Z. Li, S. S. Sastry, A Mathematical Introduction to Robotic
    /// Manipulation (1994), section 2.3; written with the chord of the arc, which stays accurate for small turns.
    #[must_use]
    pub fn integrated(&self, twist: &PlanarTwist, duration_s: f64) -> Self {
        let turn = twist.yaw_rate_rad_s * duration_s;
        // An arc of the angle phi over the time t has the chord v t sin(phi/2) / (phi/2), half of phi aside.
        let chord = sinc(0.5 * turn) * duration_s;
        let (sin, cos) = libm::sincos(self.heading_rad + 0.5 * turn);
        Self {
            x_m: self.x_m + chord * (twist.forward_m_s * cos - twist.left_m_s * sin),
            y_m: self.y_m + chord * (twist.forward_m_s * sin + twist.left_m_s * cos),
            heading_rad: self.heading_rad + turn,
        }
    }

    /// Returns the displacement from the origin in a world, m.
    pub(crate) fn displacement(&self) -> Vec3 {
        Vec3::new(-self.y_m as f32, 0.0, -self.x_m as f32)
    }

    pub(crate) fn from_array([x_m, y_m, heading_rad]: [f64; 3]) -> Self {
        Self {
            x_m,
            y_m,
            heading_rad,
        }
    }

    pub(crate) fn to_array(self) -> [f64; 3] {
        [self.x_m, self.y_m, self.heading_rad]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{PI, TAU};

    fn twist(forward: f64, left: f64, yaw: f64) -> PlanarTwist {
        PlanarTwist {
            forward_m_s: forward,
            left_m_s: left,
            yaw_rate_rad_s: yaw,
        }
    }

    /// A body that goes forward and turns is on a circle of radius v / omega, and after a full turn where it was.
    #[test]
    fn a_constant_twist_draws_a_circle() {
        let (v, omega) = (0.7, -1.3);
        for k in 0..=40 {
            let t = f64::from(k) * 0.25;
            let pose = PlanarPose::default().integrated(&twist(v, 0.0, omega), t);
            let expected = (
                v / omega * (omega * t).sin(),
                v / omega * (1.0 - (omega * t).cos()),
            );
            assert!((pose.x_m - expected.0).abs() < 1e-12, "{t}");
            assert!((pose.y_m - expected.1).abs() < 1e-12, "{t}");
            assert!((pose.heading_rad - omega * t).abs() < 1e-12);
        }
        let round = PlanarPose::default().integrated(&twist(v, 0.4, omega), TAU / omega.abs());
        assert!(round.x_m.hypot(round.y_m) < 1e-12);
    }

    /// One step of a second and a thousand of a millisecond agree: the integration is exact, not a small-step scheme.
    #[test]
    fn many_small_steps_are_one_large_one() {
        for omega in [0.0, 1e-9, 1e-5, 0.3, 3.0 * PI] {
            let twist = twist(0.9, -0.2, omega);
            let whole = PlanarPose::default().integrated(&twist, 1.0);
            let mut pose = PlanarPose::default();
            for _ in 0..1000 {
                pose = pose.integrated(&twist, 1e-3);
            }
            assert!((whole.x_m - pose.x_m).abs() < 1e-12, "{omega}");
            assert!((whole.y_m - pose.y_m).abs() < 1e-12, "{omega}");
        }
    }
}
