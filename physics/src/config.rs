//! Settings of a physics world.

use crate::error::PhysicsError;
use serde::{Deserialize, Serialize};

/// Friction model for two faces that touch in several points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactFriction {
    /// One friction force for the patch, and one torque about its normal: cheaper.
    #[default]
    Patch,
    /// Coulomb's law in each point: more expensive, and closer to measured tosses of a cube.
    Point,
}

/// Rates and tolerances of a physics world. Abilities of agents are in their bodies ([`dwell_scene::AgentBody`]). Every
/// field has a default; unknown fields are refused.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PhysicsConfig {
    /// Control steps per second of simulated time, Hz; 1 to 1,000, default 20.
    pub control_rate_hz: f32,
    /// Physics steps per second, Hz; a whole multiple (1 to 1,000) of the control rate, default 120.
    pub physics_rate_hz: f32,
    /// Substeps of the contact and joint solver in a physics step; 1 to 64, default 4.
    pub solver_substeps: u32,
    /// Friction model where faces touch; default `patch`.
    pub contact_friction: ContactFriction,
    /// Lets bodies at rest sleep until something touches them; default true.
    pub sleeping: bool,
    /// Depth up to which two objects may overlap at the start without being moved, m; 0 to 0.05, default 0.002. The solver
    /// pushes such overlaps apart gently.
    pub overlap_tolerance_m: f32,
    /// Largest displacement of an object at the start to free it from an overlap, m; 0 to 1, default 0.1. An object that
    /// needs more is frozen where it is.
    pub max_start_shift_m: f32,
    /// Distance up to which two objects count as touching, m; 0 to 0.02, default 0.002.
    pub touch_distance_m: f32,
    /// Normal speed from which a contact is an event, m/s; 0.01 to 10, default 0.1.
    pub event_min_speed_m_s: f32,
    /// Impulse from which a contact is an event, N·s; 1e-6 to 10, default 0.001.
    pub event_min_impulse_n_s: f32,
    /// Speed from which slip is sliding, and rolling is reported, m/s; 0.005 to 10, default 0.02.
    pub slide_min_speed_m_s: f32,
    /// Most events of a control step; 1 to 100,000, default 128. Impacts come before sliding and rolling, the strongest
    /// first; the others are counted and summed.
    pub max_events_per_step: usize,
    /// Keeps doors and drawers of the building shut at their closed position until they are opened; default true.
    pub latches: bool,
}

impl Default for PhysicsConfig {
    fn default() -> Self {
        Self {
            control_rate_hz: 20.0,
            physics_rate_hz: 120.0,
            solver_substeps: 4,
            contact_friction: ContactFriction::Patch,
            sleeping: true,
            overlap_tolerance_m: 0.002,
            max_start_shift_m: 0.1,
            touch_distance_m: 0.002,
            event_min_speed_m_s: 0.1,
            event_min_impulse_n_s: 1e-3,
            slide_min_speed_m_s: 0.02,
            max_events_per_step: 128,
            latches: true,
        }
    }
}

/// A checked [`PhysicsConfig`] with derived values.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ResolvedConfig {
    /// The settings.
    pub(crate) config: PhysicsConfig,
    /// Length of a physics step, s.
    pub(crate) dt_s: f32,
    /// Physics steps in a control step.
    pub(crate) steps_per_control: u32,
}

impl PhysicsConfig {
    /// Checks every range.
    ///
    /// # Errors
    /// [`PhysicsError::Range`] names the field, the value found and the allowed ones.
    pub fn check(&self) -> Result<(), PhysicsError> {
        let range =
            |field: &'static str, value: f32, low: f32, high: f32, allowed: &'static str| {
                if (low..=high).contains(&value) {
                    return Ok(());
                }
                let (at, found) = ("physics config".to_owned(), value.to_string());
                Err(PhysicsError::Range {
                    at,
                    field,
                    found,
                    allowed,
                })
            };
        range(
            "control_rate_hz",
            self.control_rate_hz,
            1.0,
            1000.0,
            "1 to 1000",
        )?;
        let ratio = self.physics_rate_hz / self.control_rate_hz;
        let whole = if ratio.fract() == 0.0 { ratio } else { 0.0 };
        range(
            "physics_rate_hz over control_rate_hz",
            whole,
            1.0,
            1000.0,
            "a whole number from 1 to 1000",
        )?;
        range(
            "solver_substeps",
            self.solver_substeps as f32,
            1.0,
            64.0,
            "1 to 64",
        )?;
        range(
            "overlap_tolerance_m",
            self.overlap_tolerance_m,
            0.0,
            0.05,
            "0 to 0.05",
        )?;
        range(
            "max_start_shift_m",
            self.max_start_shift_m,
            0.0,
            1.0,
            "0 to 1",
        )?;
        range(
            "touch_distance_m",
            self.touch_distance_m,
            0.0,
            0.02,
            "0 to 0.02",
        )?;
        range(
            "event_min_speed_m_s",
            self.event_min_speed_m_s,
            0.01,
            10.0,
            "0.01 to 10",
        )?;
        range(
            "event_min_impulse_n_s",
            self.event_min_impulse_n_s,
            1e-6,
            10.0,
            "1e-6 to 10",
        )?;
        range(
            "slide_min_speed_m_s",
            self.slide_min_speed_m_s,
            0.005,
            10.0,
            "0.005 to 10",
        )?;
        range(
            "max_events_per_step",
            self.max_events_per_step as f32,
            1.0,
            1e5,
            "1 to 100000",
        )
    }

    pub(crate) fn build(&self) -> Result<ResolvedConfig, PhysicsError> {
        self.check()?;
        Ok(ResolvedConfig {
            config: self.clone(),
            dt_s: 1.0 / self.physics_rate_hz,
            steps_per_control: (self.physics_rate_hz / self.control_rate_hz) as u32,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrong_rates_and_unknown_fields_are_refused_by_name() {
        let config = PhysicsConfig {
            physics_rate_hz: 110.0,
            ..PhysicsConfig::default()
        };
        let message = config.check().unwrap_err().to_string();
        assert!(message.contains("physics_rate_hz"), "{message}");
        let config = PhysicsConfig {
            touch_distance_m: f32::NAN,
            ..PhysicsConfig::default()
        };
        assert!(config.check().is_err());
        assert!(PhysicsConfig::default().check().is_ok());
    }
}
