//! Sound at an agent's ears, or at other microphones on its head.

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
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::atomic::{AtomicU64, Ordering};

const ABOUT: &str = "Sound pressure at the ears: shape (2, samples), pascals, left ear first, newest sample last; clipped at 200 Pa and counted. \
                     With the setting receiver at other microphones: shape (channels, samples), in their order.";

/// The largest pressure that an observation holds, Pa (140 dB SPL).
const CEILING_PA: f32 = 200.0;

pub(super) const KIND: SensorKind = SensorKind {
    name: "audio",
    about: ABOUT,
    build,
    settings: schema::fields_of::<AudioConfig>,
    image: None,
    goal_part: None,
};

/// The settings of the ears, or of other microphones. Several sensors need names; those with equal receivers share the work.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
struct AudioConfig {
    /// The key in the observation; by default the sensor's kind.
    name: Option<String>,
    /// Which agent's ears; by default those of the one whom the environment is about.
    agent: Option<u32>,
    /// Length of the window, s; default one control step; at most 10.
    window_s: Option<f64>,
    /// The microphones in place of the ears, and where they are mounted: `{"kind": "mono"}`, `{"kind": "ambisonics", "order": 1}`,
    /// `{"kind": "circular_4", "radius_m": 0.05}`, `tetrahedral`, `circular_8`, `linear_4`, `{"kind": "array", "microphones_m": [...]}`, with
    /// `directivity` for arrays, `position_m`, `yaw_deg`, `pitch_deg` and `roll_deg` relative to the head.
    receiver: ReceiverConfig,
}

#[derive(Debug)]
struct AudioSensor {
    name: String,
    listener: Listener,
    channels: usize,
    samples: usize,
    /// Number of clipped samples of the latest observation.
    clipped: AtomicU64,
}

/// Keeps samples within the range; returns how many were beyond it.
fn clip(samples: &mut [f32]) -> u64 {
    let mut count = 0;
    for sample in samples {
        count += u64::from(sample.abs() > CEILING_PA);
        *sample = sample.clamp(-CEILING_PA, CEILING_PA);
    }
    count
}

fn build(value: &serde_json::Value, site: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    let config: AudioConfig = parse_sensor_settings(value)?;
    let listener = config.receiver.build(site, config.agent)?;
    let window_s = config.window_s.unwrap_or_else(|| site.config.step_s());
    Ok(Box::new(AudioSensor {
        name: super::key(KIND.name, config.name)?,
        channels: listener.channels(),
        listener,
        samples: super::window_samples(site, window_s)?,
        clipped: AtomicU64::new(0),
    }))
}

impl Sensor for AudioSensor {
    fn spec(&self) -> SensorSpec {
        SensorSpec {
            name: self.name.clone(),
            shape: vec![self.channels, self.samples],
            dtype: Dtype::Float32,
            unit: "Pa",
            low: f64::from(-CEILING_PA),
            high: f64::from(CEILING_PA),
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
        let mut clipped = 0;
        for (channel, window) in out.chunks_exact_mut(self.samples).enumerate() {
            seen.world
                .newest_samples_of(&self.listener, channel, window);
            clipped += clip(window);
        }
        self.clipped.store(clipped, Ordering::Relaxed);
    }

    fn clipped_samples(&self) -> u64 {
        self.clipped.load(Ordering::Relaxed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The fields within `receiver` are in the schema by which callers check them, and its text is its own.
    #[test]
    fn the_receiver_has_a_schema_of_its_own() {
        let fields = (KIND.settings)();
        let receiver = fields.iter().find(|field| field.name == "receiver");
        let receiver = receiver.unwrap();
        assert!(
            receiver.about.starts_with("The microphones in place"),
            "{receiver:?}"
        );
        assert_eq!(receiver.schema["type"], "object");
        assert!(receiver.schema["properties"]["microphones_m"].is_object());
    }

    #[test]
    fn what_is_too_loud_is_cut_off_and_counted() {
        let mut samples = [0.0, 199.0, 200.0, 200.1, -1e9, -200.0];
        assert_eq!(clip(&mut samples), 2);
        assert_eq!(samples, [0.0, 199.0, 200.0, 200.0, -200.0, -200.0]);
        assert_eq!(clip(&mut samples), 0);
    }
}
