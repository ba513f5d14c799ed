//! A body's pose and velocity, and the deviation of two of these.

use glam::{DQuat, DVec3};

/// A body's pose and velocities in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionState {
    /// Its origin, m.
    pub position: DVec3,
    /// World from body.
    pub rotation: DQuat,
    /// Velocity of the origin, m/s.
    pub linear: DVec3,
    /// Angular velocity along the axes of the world, rad/s.
    pub angular: DVec3,
}

/// The deviation of a prediction from the measurement.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Deviation {
    /// Distance of the origins, m.
    pub position_m: f64,
    /// Angle of the rotation between them, rad; 0 to π.
    pub rotation_rad: f64,
}

impl Deviation {
    /// Between a prediction and a measurement.
    pub fn between(predicted: &MotionState, measured: &MotionState) -> Self {
        Self {
            position_m: (predicted.position - measured.position).length(),
            rotation_rad: crate::bundle::rotation_vector_between(
                measured.rotation,
                predicted.rotation,
            )
            .length(),
        }
    }

    /// The distance, mm.
    pub fn position_mm(&self) -> f64 {
        1e3 * self.position_m
    }

    /// The angle, degrees.
    pub fn rotation_deg(&self) -> f64 {
        self.rotation_rad.to_degrees()
    }

    /// Returns whether it is larger than `limit` in distance or angle.
    pub fn exceeds(&self, limit: &Self) -> bool {
        self.position_m > limit.position_m || self.rotation_rad > limit.rotation_rad
    }

    /// |Δp|² / h + θ² with Δp in m, θ in rad and h the half width in m: metres and radians² added as the published
    /// evaluation of cube tosses adds them.
    ///
    /// # Source
    /// B. Acosta, W. Yang, M. Posa, IEEE RA-L 7(3), 6471 (2022), the loss of their code.
    pub fn e_q(&self, half_width_m: f64) -> f64 {
        self.position_m * self.position_m / half_width_m + self.rotation_rad * self.rotation_rad
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_counts_the_short_way_and_a_shift_by_its_length() {
        let still = MotionState {
            position: DVec3::ZERO,
            rotation: DQuat::IDENTITY,
            linear: DVec3::ZERO,
            angular: DVec3::ZERO,
        };
        let turned = MotionState {
            position: DVec3::new(3e-3, 4e-3, 0.0),
            // 350 degrees one way are 10 the other.
            rotation: -DQuat::from_rotation_y(350.0_f64.to_radians()),
            ..still
        };
        let found = Deviation::between(&turned, &still);
        assert!((found.position_m - 5e-3).abs() < 1e-15);
        assert!((found.rotation_rad - 10.0_f64.to_radians()).abs() < 1e-12);
        let e_q = found.e_q(0.05);
        assert!((e_q - (25e-6 / 0.05 + found.rotation_rad.powi(2))).abs() < 1e-15);
    }
}
