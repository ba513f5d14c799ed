//! Spectrograms of the sound at an agent's ears, or at other microphones on its head.

use super::receiver::ReceiverConfig;
use super::{
    Dtype, ObservationBuffer, Sensor, SensorContext, SensorKind, SensorSetup, SensorSpec,
    parse_sensor_settings,
};
use crate::error::WorldError;
use crate::listener::Listener;
use crate::schema;
use crate::sensor_requests::SensorRequests;
use crate::world::World;
use dwell_acoustics::Spectrogram;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

const ABOUT: &str = "Spectrograms of the sound at the ears: ln(1 + mean magnitude of 4 by 4 values of a transform of 512 samples); shape (frequencies, times, 2), left ear first. With the setting receiver at other microphones: shape (frequencies, times, channels).";

/// The highest value; a sine of 200 Pa has 24 at the least reference. What is louder is clipped.
const HIGHEST: f64 = 50.0;

pub(super) const KIND: SensorKind = SensorKind {
    name: "spectrogram",
    about: ABOUT,
    build,
    settings: schema::fields_of::<SpectrogramConfig>,
    image: None,
    goal_part: None,
};

/// The settings of a spectrogram.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
struct SpectrogramConfig {
    /// The key in the observation; by default the sensor's kind.
    name: Option<String>,
    /// Which agent's ears; by default those of the one whom the environment is about.
    agent: Option<u32>,
    /// Length of the window, s; default 1, at most 10.
    window_s: f64,
    /// The pressure that counts as 1, Pa, 0.000001 to 1,000; default 0.001 (34 dB SPL). Softer sounds come out linear, louder ones
    /// by their logarithm.
    reference_pa: f32,
    /// The microphones in place of the ears, and where they are mounted, as for `audio`.
    receiver: ReceiverConfig,
}

impl Default for SpectrogramConfig {
    fn default() -> Self {
        Self {
            name: None,
            agent: None,
            window_s: 1.0,
            reference_pa: 1e-3,
            receiver: ReceiverConfig::default(),
        }
    }
}

#[derive(Debug)]
struct SpectrogramSensor {
    name: String,
    listener: Listener,
    channels: usize,
    samples: usize,
    spectrogram: Spectrogram,
}

fn build(value: &serde_json::Value, site: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    let config: SpectrogramConfig = parse_sensor_settings(value)?;
    let samples = super::window_samples(site, config.window_s)?;
    let listener = config.receiver.build(site, config.agent)?;
    Ok(Box::new(SpectrogramSensor {
        name: super::key(KIND.name, config.name)?,
        channels: listener.channels(),
        listener,
        samples,
        spectrogram: Spectrogram::new(samples, config.reference_pa)?,
    }))
}

impl Sensor for SpectrogramSensor {
    fn spec(&self) -> SensorSpec {
        let [frequencies, times] = self.spectrogram.shape();
        SensorSpec {
            name: self.name.clone(),
            shape: vec![frequencies, times, self.channels],
            dtype: Dtype::Float32,
            unit: "1",
            low: 0.0,
            high: HIGHEST,
            about: ABOUT,
        }
    }

    fn request(&self, _world: &World, requests: &mut SensorRequests) {
        requests.request_sound(&self.listener, self.samples);
    }

    fn write_observation(&self, seen: SensorContext<'_>, out: ObservationBuffer<'_>) {
        let ObservationBuffer::Float32(out) = out else {
            return;
        };
        let mut window = vec![0.0; self.samples];
        for channel in 0..self.channels {
            seen.world
                .newest_samples_of(&self.listener, channel, &mut window);
            self.spectrogram
                .write(&window, &mut out[channel..], self.channels);
        }
        for value in out {
            *value = value.min(HIGHEST as f32);
        }
    }
}
