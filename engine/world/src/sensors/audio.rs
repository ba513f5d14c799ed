//! What an agent's two ears hear.

use super::{Dtype, Out, Seen, Sensor, SensorKind, SensorSpec, Site, settings};
use crate::error::WorldError;
use crate::requests::Requests;
use crate::world::World;
use dwell_scene::AgentId;
use serde::{Deserialize, Serialize};

const ABOUT: &str = "Sound pressure at the ears: shape (2, samples), pascals, left ear first, newest sample last; clipped at 200 Pa.";

/// The largest pressure that an observation holds, Pa (140 dB SPL).
const CEILING_PA: f32 = 200.0;

pub(super) const KIND: SensorKind = SensorKind {
    name: "audio",
    about: ABOUT,
    build,
};

/// The settings of the ears.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct AudioConfig {
    /// Which agent's ears.
    agent: u32,
    /// Length of the window, s; default one control step; at most 10.
    window_s: Option<f64>,
}

#[derive(Debug)]
struct Audio {
    agent: AgentId,
    samples: usize,
}

fn build(value: &serde_json::Value, site: Site<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    let config: AudioConfig = settings(value)?;
    if config.agent as usize >= site.config.agents.len() {
        let allowed = format!("below the number of agents, {}", site.config.agents.len());
        return Err(WorldError::Config {
            field: "agent",
            found: config.agent.to_string(),
            allowed,
        });
    }
    let window_s = config.window_s.unwrap_or_else(|| site.config.step_s());
    let samples = (window_s * f64::from(site.config.sound_rate_hz)).round();
    if !(window_s <= 10.0 && samples >= 1.0) {
        let allowed = "one sample to 10 s".to_owned();
        return Err(WorldError::Config {
            field: "window_s",
            found: window_s.to_string(),
            allowed,
        });
    }
    Ok(Box::new(Audio {
        agent: AgentId(config.agent),
        samples: samples as usize,
    }))
}

impl Sensor for Audio {
    fn spec(&self) -> SensorSpec {
        SensorSpec {
            name: "audio".to_owned(),
            shape: vec![2, self.samples],
            dtype: Dtype::Float32,
            unit: "Pa",
            low: f64::from(-CEILING_PA),
            high: f64::from(CEILING_PA),
            about: ABOUT,
        }
    }

    fn plan(&self, _world: &World, requests: &mut Requests) {
        requests.ears(self.agent, self.samples);
    }

    fn finish(&self, seen: Seen<'_>, out: Out<'_>) {
        let Out::Float32(out) = out else { return };
        for (channel, window) in out.chunks_exact_mut(self.samples).enumerate() {
            seen.world.heard(self.agent, channel, window);
            for sample in window {
                *sample = sample.clamp(-CEILING_PA, CEILING_PA);
            }
        }
    }
}
