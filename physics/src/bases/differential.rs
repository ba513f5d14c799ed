//! Differential drive: two driven wheels side by side.

use super::PlanarTwist;
use dwell_scene::DifferentialDrive;

/// The geometry of a differential drive, which relates wheel rates to the body's motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheelGeometry {
    /// Radius of the left and right wheel, m.
    pub radius_m: [f64; 2],
    /// Distance between the points where they touch the floor, m.
    pub wheel_base_m: f64,
}

impl From<&DifferentialDrive> for WheelGeometry {
    fn from(drive: &DifferentialDrive) -> Self {
        Self {
            radius_m: [drive.left_wheel_radius_m, drive.right_wheel_radius_m].map(f64::from),
            wheel_base_m: f64::from(drive.wheel_base_m),
        }
    }
}

impl WheelGeometry {
    /// Returns the body's twist when the left and right wheel turn at these rates (rad/s) and roll without slip: the mean
    /// of both speeds forward, their difference over the wheel base to the left.
    ///
    /// # Source
    /// R. Siegwart, I. R. Nourbakhsh, Introduction to Autonomous Mobile Robots (2004), section 3.2.2: forward kinematic models.
    pub fn twist(&self, wheel_rad_s: [f64; 2]) -> PlanarTwist {
        // v = (r_l w_l + r_r w_r) / 2 and omega = (r_r w_r - r_l w_l) / b.
        let [left, right] = [0, 1].map(|side| self.radius_m[side] * wheel_rad_s[side]);
        PlanarTwist {
            forward_m_s: 0.5 * (left + right),
            left_m_s: 0.0,
            yaw_rate_rad_s: (right - left) / self.wheel_base_m,
        }
    }

    /// Returns the rates of the left and right wheel (rad/s) for a forward speed and a yaw rate; the inverse of
    /// [`WheelGeometry::twist`]. Such wheels cannot go sideways.
    pub fn rates(&self, forward_m_s: f64, yaw_rate_rad_s: f64) -> [f64; 2] {
        // w_l = (v - b omega / 2) / r_l and w_r = (v + b omega / 2) / r_r.
        let turn = 0.5 * self.wheel_base_m * yaw_rate_rad_s;
        [
            (forward_m_s - turn) / self.radius_m[0],
            (forward_m_s + turn) / self.radius_m[1],
        ]
    }
}

/// Commanded rates of the left and the right wheel, rad/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WheelCommand(pub(crate) [f64; 2]);

impl WheelCommand {
    /// The command for a forward speed and a yaw rate, by the base's own geometry. If it is too fast for a wheel, both
    /// wheels are scaled down, so that the path keeps its curvature.
    pub(crate) fn from_twist(
        nominal: &WheelGeometry,
        forward: f64,
        yaw_rate: f64,
        fastest: f64,
    ) -> Self {
        let rates = nominal.rates(forward, yaw_rate);
        let most = rates[0].abs().max(rates[1].abs());
        let part = if most > fastest { fastest / most } else { 1.0 };
        Self(rates.map(|rate| rate * part))
    }
}

/// The motion of two wheels in one physics step; laws change it before it becomes a motion of the base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WheelMotion {
    /// The true geometry.
    pub(crate) wheels: WheelGeometry,
    /// Mean rate of each wheel over the step, rad/s.
    pub(crate) rate_rad_s: [f64; 2],
    /// Mean acceleration of each wheel over the step, rad/s².
    pub(crate) acceleration_rad_s2: [f64; 2],
    /// The lost share of each wheel's displacement: the body moves by `r w (1 - slip)`.
    pub(crate) slip_ratio: [f64; 2],
}

impl WheelMotion {
    /// Returns the body's twist.
    pub(crate) fn twist(&self) -> PlanarTwist {
        let gripping = [0, 1].map(|side| self.rate_rad_s[side] * (1.0 - self.slip_ratio[side]));
        self.wheels.twist(gripping)
    }
}

/// Returns the speed after `dt_s` of acceleration towards `target` with at most `acceleration` (> 0), and its mean over
/// that time.
pub(crate) fn ramp(now: f64, target: f64, acceleration: f64, dt_s: f64) -> (f64, f64) {
    let change = target - now;
    let needed_s = change.abs() / acceleration;
    if needed_s >= dt_s {
        // v = v0 + a t, and the mean of both ends.
        let end = now + acceleration.copysign(change) * dt_s;
        (end, 0.5 * (now + end))
    } else {
        // For t0 = |v - v0| / a it changes, then it stays: the mean is v - (v - v0) t0 / (2 t).
        let ramped = needed_s / dt_s;
        (target, target - 0.5 * change * ramped)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bases::PlanarPose;
    use proptest::prelude::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    fn wheels(radii: [f64; 2], base: f64) -> WheelGeometry {
        WheelGeometry {
            radius_m: radii,
            wheel_base_m: base,
        }
    }

    proptest! {
        #[test]
        fn rates_are_the_inverse_of_the_twist(
            l in 0.01..0.5_f64, r in 0.01..0.5_f64, b in 0.05..2.0_f64, v in -3.0..3.0_f64, w in -6.0..6.0_f64,
        ) {
            let wheels = wheels([l, r], b);
            let twist = wheels.twist(wheels.rates(v, w));
            prop_assert!((twist.forward_m_s - v).abs() < 1e-12 && (twist.yaw_rate_rad_s - w).abs() < 1e-11);
        }

        /// The mean over a step gives the displacement of many smaller steps.
        #[test]
        fn a_ramp_in_one_step_or_many_covers_the_same_way(now in -5.0..5.0_f64, target in -5.0..5.0_f64, a in 0.5..50.0_f64) {
            let (end, mean) = ramp(now, target, a, 0.1);
            let (mut speed, mut way) = (now, 0.0);
            for _ in 0..64 {
                let (next, mean) = ramp(speed, target, a, 0.1 / 64.0);
                way += mean * 0.1 / 64.0;
                speed = next;
            }
            prop_assert!((speed - end).abs() < 1e-12 && (way - mean * 0.1).abs() < 1e-12);
        }
    }

    /// The square of Borenstein and Feng, driven both ways by a robot that uses its nominal parameters. Unequal wheels add
    /// to the turning in one direction and take from it in the other (type B), a wrong base does the same in both (type A).
    ///
    /// # Source
    /// J. Borenstein, L. Feng, Measurement and correction of systematic odometry errors in mobile robots, IEEE
    /// Transactions on Robotics and Automation 12, 869 (1996), section III.
    #[test]
    fn a_square_ends_with_the_heading_error_of_its_wheels_and_base() {
        let nominal = wheels([0.05, 0.05], 0.3);
        let side = 4.0;
        let heading = |truth: &WheelGeometry, direction: f64| {
            let mut pose = PlanarPose::default();
            for _ in 0..4 {
                for (forward, yaw, seconds) in [(1.0, 0.0, side), (0.0, direction, FRAC_PI_2)] {
                    let twist = truth.twist(nominal.rates(forward, yaw));
                    pose = pose.integrated(&twist, seconds);
                }
            }
            pose.heading_rad
        };
        // Unequal wheels: the heading bends by (d_r - d_l) / b on each metre, whatever the direction of the square.
        let ratio = 1.004;
        let (left, right) = (0.1 / (1.0 + ratio), 0.1 / (1.0 + 1.0 / ratio));
        let unequal = wheels([left, right], 0.3);
        let bend = (right - left) / 0.05 / 0.3 * 4.0 * side;
        for direction in [1.0, -1.0] {
            let error = heading(&unequal, direction) - direction * 2.0 * PI;
            // The turns on the spot depend on the mean radius, which is nominal.
            assert!((error - bend).abs() < 1e-12, "{error} {bend}");
        }
        // A wrong base: every turn is too small by b / b_true.
        let wide = wheels([0.05, 0.05], 0.3 * 1.01);
        for direction in [1.0, -1.0] {
            let error = heading(&wide, direction) - direction * 2.0 * PI;
            let expected = direction * 2.0 * PI * (1.0 / 1.01 - 1.0);
            assert!((error - expected).abs() < 1e-12, "{error} {expected}");
        }
    }
}
