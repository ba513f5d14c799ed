//! Kinds of grasp.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;

/// The way a hand holds an object. In both the object stays a rigid body that walls and furniture stop.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Grasp {
    /// It follows the hand within one physics step, as far as the hand's force allows.
    #[default]
    Kinematic,
    /// It is attached to the hand by a spring and damper, with its weight: it sags by g over the square of 2 pi times the
    /// frequency, lags and swings.
    Spring {
        /// Natural frequency, Hz; 0.5 to 20.
        #[schemars(range(min = 0.5, max = 20.0))]
        frequency_hz: f32,
        /// 1 is critical; 0.05 to 4.
        #[schemars(range(min = 0.05, max = 4.0))]
        damping_ratio: f32,
    },
}

impl fmt::Display for Grasp {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Kinematic => f.write_str("A kinematic grasp"),
            Self::Spring {
                frequency_hz,
                damping_ratio,
            } => write!(
                f,
                "A spring of {frequency_hz} Hz and damping ratio {damping_ratio}"
            ),
        }
    }
}

impl Grasp {
    /// Returns whether its numbers are in their ranges.
    pub fn is_valid(&self) -> bool {
        match self {
            Self::Kinematic => true,
            Self::Spring {
                frequency_hz,
                damping_ratio,
            } => (0.5..=20.0).contains(frequency_hz) && (0.05..=4.0).contains(damping_ratio),
        }
    }
}
