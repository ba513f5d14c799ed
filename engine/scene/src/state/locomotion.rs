//! Locomotion of agents: on legs, or on the wheels of a base. Its numbers are nominal; an override at `agent/N/base/FIELD`
//! gives the true value in a world.

use super::Parameter;
use super::numeric_field::{NumericField, number, parameters, set};
use crate::error::SceneError;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The locomotion of an agent.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Locomotion {
    /// On legs: any direction at once, up to a speed; it can crouch.
    Walking(LeggedLocomotion),
    /// On two driven wheels side by side.
    DifferentialDrive(DifferentialDrive),
    /// On a base that moves in any direction, such as one with Mecanum wheels.
    Holonomic(HolonomicBase),
}

impl Default for Locomotion {
    fn default() -> Self {
        Self::Walking(LeggedLocomotion::default())
    }
}

/// The parameters of walking, running and crouching.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct LeggedLocomotion {
    /// Its highest speed, m/s; 0 to 100, default 100: as fast as commanded.
    pub max_speed_m_s: f32,
    /// Its highest speed while it crouches, m/s; 0 to 100, default 1.
    pub max_crouched_speed_m_s: f32,
    /// Its height when it crouches, m; 0.1 to 3, default 0.9. A body that is not higher does not crouch; none gets lower
    /// than twice its radius.
    pub crouched_height_m: f32,
}

impl Default for LeggedLocomotion {
    fn default() -> Self {
        Self {
            max_speed_m_s: 100.0,
            max_crouched_speed_m_s: 1.0,
            crouched_height_m: 0.9,
        }
    }
}

/// A base on two driven wheels side by side; it turns about their middle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct DifferentialDrive {
    /// Distance between the points where the wheels touch the floor, m; 0.01 to 5, default 0.3.
    pub wheel_base_m: f32,
    /// m; 0.001 to 1, default 0.05.
    pub left_wheel_radius_m: f32,
    /// m; 0.001 to 1, default 0.05.
    pub right_wheel_radius_m: f32,
    /// Highest speed of a wheel, rad/s; 0 to 1,000, default 20 (1 m/s).
    pub max_wheel_speed_rad_s: f32,
    /// Largest acceleration of a wheel, rad/s²; 0.01 to 1,000,000, default 40 (2 m/s²).
    pub max_wheel_acceleration_rad_s2: f32,
}

impl Default for DifferentialDrive {
    fn default() -> Self {
        Self {
            wheel_base_m: 0.3,
            left_wheel_radius_m: 0.05,
            right_wheel_radius_m: 0.05,
            max_wheel_speed_rad_s: 20.0,
            max_wheel_acceleration_rad_s2: 40.0,
        }
    }
}

/// A base that moves in any direction and turns at the same time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct HolonomicBase {
    /// Highest speed forward or backward, m/s; 0 to 100, default 1.
    pub max_forward_m_s: f32,
    /// Highest speed sideways, m/s; 0 to 100, default 1.
    pub max_sideways_m_s: f32,
    /// Highest yaw rate, rad/s; 0 to 100, default 2.
    pub max_yaw_rate_rad_s: f32,
    /// Largest acceleration, m/s²; 0.01 to 10,000, default 2.
    pub max_acceleration_m_s2: f32,
    /// Largest yaw acceleration, rad/s²; 0.01 to 10,000, default 4.
    pub max_yaw_acceleration_rad_s2: f32,
}

impl Default for HolonomicBase {
    fn default() -> Self {
        Self {
            max_forward_m_s: 1.0,
            max_sideways_m_s: 1.0,
            max_yaw_rate_rad_s: 2.0,
            max_acceleration_m_s2: 2.0,
            max_yaw_acceleration_rad_s2: 4.0,
        }
    }
}

const GAIT: &[NumericField<LeggedLocomotion>] = &[
    number!(max_speed_m_s, "m/s", 0.0 to 100.0),
    number!(max_crouched_speed_m_s, "m/s", 0.0 to 100.0),
    number!(crouched_height_m, "m", 0.1 to 3.0),
];

const DIFFERENTIAL: &[NumericField<DifferentialDrive>] = &[
    number!(wheel_base_m, "m", 0.01 to 5.0),
    number!(left_wheel_radius_m, "m", 0.001 to 1.0),
    number!(right_wheel_radius_m, "m", 0.001 to 1.0),
    number!(max_wheel_speed_rad_s, "rad/s", 0.0 to 1000.0),
    number!(max_wheel_acceleration_rad_s2, "rad/s2", 0.01 to 1e6),
];

const HOLONOMIC: &[NumericField<HolonomicBase>] = &[
    number!(max_forward_m_s, "m/s", 0.0 to 100.0),
    number!(max_sideways_m_s, "m/s", 0.0 to 100.0),
    number!(max_yaw_rate_rad_s, "rad/s", 0.0 to 100.0),
    number!(max_acceleration_m_s2, "m/s2", 0.01 to 1e4),
    number!(max_yaw_acceleration_rad_s2, "rad/s2", 0.01 to 1e4),
];

impl Locomotion {
    /// Returns its numbers by name, with units and ranges: the fields of the address `agent/N/base/FIELD`.
    pub fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        match self {
            Self::Walking(gait) => parameters(GAIT, gait),
            Self::DifferentialDrive(base) => parameters(DIFFERENTIAL, base),
            Self::Holonomic(base) => parameters(HOLONOMIC, base),
        }
    }

    /// Returns a copy with the numbers for which `value_of` gives a value replaced.
    #[must_use]
    pub fn with_overrides(mut self, value_of: impl Fn(&str) -> Option<f32>) -> Self {
        match &mut self {
            Self::Walking(gait) => set(GAIT, gait, value_of),
            Self::DifferentialDrive(base) => set(DIFFERENTIAL, base, value_of),
            Self::Holonomic(base) => set(HOLONOMIC, base, value_of),
        }
        self
    }

    /// Returns its name in words.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Walking(_) => "walking",
            Self::DifferentialDrive(_) => "differential drive",
            Self::Holonomic(_) => "holonomic base",
        }
    }

    /// Checks every range.
    ///
    /// # Errors
    /// [`SceneError::Range`] names the field.
    pub fn check(&self) -> Result<(), SceneError> {
        for (name, parameter) in self.parameters() {
            if !parameter.admits(parameter.value) {
                return Err(SceneError::Range {
                    at: format!("agent body, {}", self.name()),
                    field: name,
                    found: format!(
                        "{} (range {} to {} {})",
                        parameter.value, parameter.low, parameter.high, parameter.unit
                    ),
                    allowed: "a value within its range",
                });
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_is_reached_by_its_name_and_nothing_else_changes() {
        for locomotion in [
            Locomotion::default(),
            Locomotion::DifferentialDrive(DifferentialDrive::default()),
            Locomotion::Holonomic(HolonomicBase::default()),
        ] {
            locomotion.check().unwrap();
            for (name, parameter) in locomotion.parameters() {
                let other = parameter.low as f32 + 0.01;
                let changed = locomotion.with_overrides(|field| (field == name).then_some(other));
                for ((field, before), (_, after)) in locomotion
                    .parameters()
                    .into_iter()
                    .zip(changed.parameters())
                {
                    let expected = if field == name {
                        f64::from(other)
                    } else {
                        before.value
                    };
                    assert_eq!(after.value, expected, "{name} {field}");
                }
                let wrong = locomotion.with_overrides(|field| (field == name).then_some(f32::NAN));
                assert!(wrong.check().unwrap_err().to_string().contains(name));
            }
        }
    }

    #[test]
    fn old_words_without_locomotion_still_make_a_body_that_walks() {
        let body: crate::AgentBody =
            serde_json::from_str(r#"{"radius_m": 0.25, "height_m": 1.6}"#).unwrap();
        assert_eq!(body.locomotion, Locomotion::default());
        let base: crate::AgentBody = serde_json::from_str(
            r#"{"locomotion": {"differential_drive": {"wheel_base_m": 0.2}}}"#,
        )
        .unwrap();
        let Locomotion::DifferentialDrive(drive) = base.locomotion else {
            panic!("{base:?}")
        };
        assert_eq!((drive.wheel_base_m, drive.left_wheel_radius_m), (0.2, 0.05));
        let wrong = r#"{"locomotion": {"differential_drive": {"wheelbase_m": 0.2}}}"#;
        assert!(serde_json::from_str::<crate::AgentBody>(wrong).is_err());
    }
}
