//! Settings of a world.

use crate::error::WorldError;
use dwell_acoustics::{AcousticConfig, HeadId};
use dwell_render::BackEnd;
use dwell_scene::{AgentBody, LawSpec, SceneError};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Rates, laws and parameters of a world. Every field has a default; unknown fields are refused.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct WorldConfig {
    /// Control steps per second of simulated time; 1 to 1,000, default 20.
    pub control_rate_hz: f64,
    /// Physics steps per second; a whole multiple of the control rate, default 120.
    pub physics_rate_hz: f64,
    /// Sound samples per second; 8,000 to 192,000, default 16,000; a whole number of samples must fit a control step.
    #[schemars(range(min = 8_000, max = 192_000))]
    pub sound_rate_hz: u32,
    /// How carefully sound is traced: `"rl"` (fast, default), `"full"` or `"reference"` (slow).
    #[schemars(extend("enum" = AcousticConfig::PRESETS))]
    pub sound_preset: String,
    /// The head on which all agents' ears are, of those that [`Engines::add_head`](crate::Engines::add_head) got; without one a
    /// sphere.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<u64>")]
    pub sound_head: Option<HeadId>,
    /// The folder below which sound files are, as a path; without one no file is played.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sound_root: Option<String>,
    /// Whether agents' voices are silent, default false: what they say is neither heard nor understood.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub muted: bool,
    /// Who renders pictures: `"cpu"` (default), `"gpu"`, or `"gpu:NAME"` with a part of an adapter's name.
    #[serde(skip_serializing_if = "is_default")]
    #[schemars(with = "String")]
    pub renderer: BackEnd,
    /// The agents' bodies, one for each agent.
    pub agents: Vec<AgentBody>,
    /// Laws to install.
    #[schemars(with = "Vec<serde_json::Map<String, serde_json::Value>>")]
    pub laws: Vec<LawSpec>,
    /// How long things may come to rest before the world begins, s, 0 to 60; less where all rest sooner. Without it nothing is moved
    /// in advance in a world, and 2 s pass before an environment's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub settle_s: Option<f64>,
    /// Parameters that differ from the house's, by address.
    pub parameters: BTreeMap<String, f64>,
    /// Parameters that every episode draws anew from its seed, by address: evenly between the two ends, as far as the parameter may
    /// be there. They go before `parameters` and the numbers of `laws`.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub randomize: BTreeMap<String, [f64; 2]>,
}

/// Returns whether a back end is the default, which files do not mention.
fn is_default(back_end: &BackEnd) -> bool {
    *back_end == BackEnd::Cpu
}

impl Default for WorldConfig {
    fn default() -> Self {
        Self {
            control_rate_hz: 20.0,
            physics_rate_hz: 120.0,
            sound_rate_hz: 16_000,
            sound_preset: "rl".to_owned(),
            sound_head: None,
            sound_root: None,
            muted: false,
            renderer: BackEnd::Cpu,
            agents: vec![AgentBody::default()],
            laws: Vec::new(),
            settle_s: None,
            parameters: BTreeMap::new(),
            randomize: BTreeMap::new(),
        }
    }
}

impl WorldConfig {
    /// Checks every range.
    ///
    /// # Errors
    /// [`WorldError::Config`] names the field, what was found and what is allowed.
    pub fn check(&self) -> Result<(), WorldError> {
        let fault = |field: &'static str, found: String, allowed: String| {
            Err(WorldError::Config {
                field,
                found,
                allowed,
            })
        };
        if !(1.0..=1000.0).contains(&self.control_rate_hz) {
            return fault(
                "control_rate_hz",
                self.control_rate_hz.to_string(),
                "1 to 1000".into(),
            );
        }
        let substeps = self.physics_rate_hz / self.control_rate_hz;
        if !(1.0..=1000.0).contains(&substeps) || substeps.fract() != 0.0 {
            let allowed = format!(
                "a whole multiple of control_rate_hz = {}, at most 1000 times it",
                self.control_rate_hz
            );
            return fault("physics_rate_hz", self.physics_rate_hz.to_string(), allowed);
        }
        if !(8_000..=192_000).contains(&self.sound_rate_hz) {
            return fault(
                "sound_rate_hz",
                self.sound_rate_hz.to_string(),
                "8000 to 192000".into(),
            );
        }
        let samples = f64::from(self.sound_rate_hz) / self.control_rate_hz;
        if samples.fract() != 0.0 {
            let (low, high) = (
                samples.floor() * self.control_rate_hz,
                samples.ceil() * self.control_rate_hz,
            );
            let allowed = format!(
                "a whole number of samples a control step; the nearest are {low} and {high} Hz"
            );
            return fault("sound_rate_hz", self.sound_rate_hz.to_string(), allowed);
        }
        if !AcousticConfig::PRESETS.contains(&self.sound_preset.as_str()) {
            let allowed = AcousticConfig::PRESETS.join(", ");
            return fault("sound_preset", format!("{:?}", self.sound_preset), allowed);
        }
        if self.agents.len() > 64 {
            return fault("agents", self.agents.len().to_string(), "at most 64".into());
        }
        for (address, [low, high]) in &self.randomize {
            if !(low.is_finite() && high.is_finite() && low <= high) {
                let found = format!("{low} to {high} for {address}");
                return fault("randomize", found, "finite numbers, rising".into());
            }
        }
        for (k, body) in self.agents.iter().enumerate() {
            body.check().map_err(|error| with_agent_index(k, error))?;
        }
        Ok(())
    }

    /// Checks that the folder of sound files exists.
    ///
    /// # Errors
    /// [`WorldError::Config`] with what the system says.
    pub(crate) fn check_sound_root(&self) -> Result<(), WorldError> {
        let Some(folder) = &self.sound_root else {
            return Ok(());
        };
        // A folder is readable if it can be listed.
        let Err(told) = std::fs::read_dir(folder) else {
            return Ok(());
        };
        Err(WorldError::Config {
            field: "sound_root",
            found: format!("{folder:?}: {told}"),
            allowed: "the folder below which sound files are".to_owned(),
        })
    }

    /// The length of a control step, s.
    pub fn step_s(&self) -> f64 {
        1.0 / self.control_rate_hz
    }

    /// Sound samples a control step.
    pub fn samples_per_step(&self) -> usize {
        (f64::from(self.sound_rate_hz) / self.control_rate_hz) as usize
    }
}

/// Returns the message for a fault of an agent's body, with its index.
fn with_agent_index(number: usize, error: SceneError) -> SceneError {
    match error {
        SceneError::Range {
            at,
            field,
            found,
            allowed,
        } => SceneError::Range {
            at: at.replacen("agent body", &format!("agents[{number}]"), 1),
            field,
            found,
            allowed,
        },
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dwell_scene::{DifferentialDrive, Locomotion};

    #[test]
    fn a_preset_of_sound_that_there_is_not_is_refused_with_those_there_are() {
        let config = |preset: &str| WorldConfig {
            sound_preset: preset.to_owned(),
            ..WorldConfig::default()
        };
        for preset in AcousticConfig::PRESETS {
            config(preset).check().unwrap();
        }
        assert_eq!(
            config("loud").check().unwrap_err().to_string(),
            "sound_preset is \"loud\"; allowed is rl, full, reference"
        );
    }

    #[test]
    fn a_body_out_of_range_is_named_by_agent_and_field() {
        let refused = |body: AgentBody| {
            let config = WorldConfig {
                agents: vec![AgentBody::default(), body],
                ..WorldConfig::default()
            };
            config.check().unwrap_err().to_string()
        };
        let flat = AgentBody {
            radius_m: f32::NAN,
            ..AgentBody::default()
        };
        assert_eq!(
            refused(flat),
            "agents[1]: radius_m is NaN (range 0.05 to 0.75 m); allowed is a value within its range"
        );
        let narrow = AgentBody {
            locomotion: Locomotion::DifferentialDrive(DifferentialDrive {
                wheel_base_m: 0.0,
                ..DifferentialDrive::default()
            }),
            ..AgentBody::default()
        };
        assert!(refused(narrow).starts_with("agents[1], differential drive: wheel_base_m is 0 ("));
    }
}
