//! Settings of navigation: the walking agent, the grid, and the treatment of doors.

use crate::error::SceneError;
use serde::{Deserialize, Serialize};

/// The treatment of doors in the way of a walking agent: joints whose closed leaf blocks an otherwise walkable place. All
/// other joints (drawers, cupboards) are taken as they are in the state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DoorPolicy {
    /// As they are in the state: a closed door is an obstacle, and so is the leaf of an open one.
    #[default]
    AsTheyStand,
    /// Fully open, the leaf in its open position: the places that an agent that opens doors can reach.
    Open,
    /// As [`DoorPolicy::Open`], but passing a door that is not open adds [`NavConfig::door_price_m`] to the path.
    Priced,
}

/// The walking agent and the resolution of the grid.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct NavConfig {
    /// Edge of a cell, m; 0.02 to 1, default 0.1.
    pub cell_m: f32,
    /// Radius of the agent, m; 0 to 2, default 0.2.
    pub radius_m: f32,
    /// Height of the agent, m; 0.1 to 3, default 1.5.
    pub height_m: f32,
    /// The highest step it climbs, m; 0 to 1, default 0.2.
    pub step_m: f32,
    /// The steepest slope it walks on, rad; 0 to 1.5, default 0.785.
    pub max_slope_rad: f32,
    /// Treatment of doors.
    pub doors: DoorPolicy,
    /// Length added to a path for opening a door under [`DoorPolicy::Priced`], m; 0 to 1000, default 2.
    pub door_price_m: f32,
}

impl Default for NavConfig {
    fn default() -> Self {
        Self {
            cell_m: 0.1,
            radius_m: 0.2,
            height_m: 1.5,
            step_m: 0.2,
            max_slope_rad: 0.785,
            doors: DoorPolicy::AsTheyStand,
            door_price_m: 2.0,
        }
    }
}

impl NavConfig {
    pub(super) fn check(&self) -> Result<(), SceneError> {
        let checks = [
            ("cell_m", self.cell_m, 0.02, 1.0, "0.02 to 1"),
            ("radius_m", self.radius_m, 0.0, 2.0, "0 to 2"),
            ("height_m", self.height_m, 0.1, 3.0, "0.1 to 3"),
            ("step_m", self.step_m, 0.0, 1.0, "0 to 1"),
            ("max_slope_rad", self.max_slope_rad, 0.0, 1.5, "0 to 1.5"),
            ("door_price_m", self.door_price_m, 0.0, 1e3, "0 to 1000"),
        ];
        for (field, found, low, high, allowed) in checks {
            if !(low..=high).contains(&found) {
                return Err(range_error(field, found, allowed));
            }
        }
        Ok(())
    }
}

pub(super) fn range_error(field: &'static str, found: f32, allowed: &'static str) -> SceneError {
    SceneError::Range {
        at: "navigation".to_owned(),
        field,
        found: found.to_string(),
        allowed,
    }
}
