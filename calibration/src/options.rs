//! Options of calibration.

use crate::error::CalibrationError;
use crate::progress::StopSignal;
use serde::{Deserialize, Serialize};

/// Settings of [`calibrate`](crate::calibrate). Every field has a default; unknown fields are refused.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CalibrationOptions {
    /// The room of impulse responses as a HOUSE string, instead of the box that the bundle describes.
    pub house: Option<String>,
    /// Seed of everything that is drawn: the held-out groups, the bootstrap, the sound rays.
    pub seed: u64,
    /// Threads; `None`: what `DWELL_THREADS`, the affinity mask or the quota say.
    pub threads: Option<usize>,
    /// Share of the groups of episodes that are held out from all fitting; 0.1 to 0.6, default 1/3.
    pub held_out_share: f64,
    /// Smallest fall of the information criterion with which a cause counts; 0 to 1,000, default 10.
    pub min_delta_bic: f64,
    /// Causes within this distance of the best one in the information criterion cannot be told apart; 0 to 100, default 6.
    pub rival_delta_bic: f64,
    /// Least share of the held-out squared error that a cause must take away; 0 to 1, default 0.01.
    pub min_gain_share: f64,
    /// Draws of the bootstrap; 100 to 100,000, default 2,000.
    pub bootstrap_draws: usize,
    /// True if samples far from the rest count less (Huber's loss from three robust standard deviations on); default true.
    pub robust: bool,
    /// Physics steps per second in the simulation experiment, Hz; 60 to 1,000, default 240.
    pub physics_rate_hz: f64,
    /// Sound rays per impulse response in the simulation experiment; 100 to 100,000, default 2,500.
    pub rays: usize,
    /// Time after which the search ends with what it has, s, 0 to 10,000,000; default `null`, no limit. A search that it ends names
    /// nothing, and what it has tried by then depends on the machine.
    pub budget_s: Option<f64>,
    /// Ends the search as `budget_s` does, once it is raised.
    #[serde(skip)]
    pub stop: StopSignal,
}

impl Default for CalibrationOptions {
    fn default() -> Self {
        Self {
            house: None,
            seed: 0,
            threads: None,
            held_out_share: 1.0 / 3.0,
            min_delta_bic: 10.0,
            rival_delta_bic: 6.0,
            min_gain_share: 0.01,
            bootstrap_draws: 2_000,
            robust: true,
            physics_rate_hz: 240.0,
            rays: 2_500,
            budget_s: None,
            stop: StopSignal::default(),
        }
    }
}

impl CalibrationOptions {
    /// Checks every range.
    ///
    /// # Errors
    /// [`CalibrationError::Field`] names the setting, what was found and what is allowed.
    pub fn check(&self) -> Result<(), CalibrationError> {
        let range = |field: &str, value: f64, low: f64, high: f64| {
            if (low..=high).contains(&value) {
                Ok(())
            } else {
                let allowed = format!("{low} to {high}");
                Err(CalibrationError::field(
                    "calibration options",
                    field,
                    value,
                    allowed,
                ))
            }
        };
        range("held_out_share", self.held_out_share, 0.1, 0.6)?;
        range("min_delta_bic", self.min_delta_bic, 0.0, 1000.0)?;
        range("rival_delta_bic", self.rival_delta_bic, 0.0, 100.0)?;
        range("min_gain_share", self.min_gain_share, 0.0, 1.0)?;
        range("bootstrap_draws", self.bootstrap_draws as f64, 100.0, 1e5)?;
        if let Some(budget_s) = self.budget_s {
            range("budget_s", budget_s, 0.0, 1e7)?;
        }
        range("physics_rate_hz", self.physics_rate_hz, 60.0, 1000.0)?;
        range("rays", self.rays as f64, 100.0, 1e5)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_out_of_range_are_named() {
        CalibrationOptions::default().check().unwrap();
        let options = CalibrationOptions {
            held_out_share: f64::NAN,
            ..CalibrationOptions::default()
        };
        let message = options.check().unwrap_err().to_string();
        assert!(
            message.contains("held_out_share") && message.contains("0.1 to 0.6"),
            "{message}"
        );
    }
}
