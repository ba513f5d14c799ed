//! Whence the words come that an agent hears, and how loudly.

use super::heard_tokens::{HeardTokensConfig, request_ears};
use super::{
    Dtype, ObservationBuffer, ObservedAgent, Sensor, SensorContext, SensorKind, SensorSetup,
    SensorSpec, parse_sensor_settings,
};
use crate::error::WorldError;
use crate::schema;
use crate::sensor_requests::SensorRequests;
use crate::world::World;

const ABOUT: &str = "For each word of heard_tokens the direction from which its first sound came, ahead, left and up as a unit vector in the \
                     head's frame (0 where only echoes arrive), and its level at the head, dB SPL; 0 where there is no word; shape (slots, 4).";

/// The highest level, dB SPL.
const LOUDEST_DB: f32 = 140.0;

pub(super) const KIND: SensorKind = SensorKind {
    name: "heard_directions",
    about: ABOUT,
    build,
    settings: schema::fields_of::<HeardTokensConfig>,
    image: None,
    goal_part: None,
};

#[derive(Debug)]
struct HeardDirectionsSensor {
    own: ObservedAgent,
    slots: usize,
}

fn build(value: &serde_json::Value, setup: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    let (own, slots) =
        parse_sensor_settings::<HeardTokensConfig>(value)?.build(KIND.name, setup)?;
    Ok(Box::new(HeardDirectionsSensor { own, slots }))
}

impl Sensor for HeardDirectionsSensor {
    fn spec(&self) -> SensorSpec {
        SensorSpec {
            name: self.own.name.clone(),
            shape: vec![self.slots, 4],
            dtype: Dtype::Float32,
            unit: "1, dB SPL",
            low: -1.0,
            high: f64::from(LOUDEST_DB),
            about: ABOUT,
        }
    }

    fn request(&self, world: &World, requests: &mut SensorRequests) {
        request_ears(self.own.agent, world, requests);
    }

    fn write_observation(&self, seen: SensorContext<'_>, out: ObservationBuffer<'_>) {
        let ObservationBuffer::Float32(out) = out else {
            return;
        };
        out.fill(0.0);
        let heard = seen.world.heard_tokens(self.own.agent);
        for (row, heard) in out.chunks_exact_mut(4).zip(heard) {
            let towards = heard.direction;
            let ahead_left_up = [-towards.z, -towards.x, towards.y];
            for (value, number) in row.iter_mut().zip(ahead_left_up) {
                *value = number.clamp(-1.0, 1.0);
            }
            row[3] = heard.level_db.clamp(0.0, LOUDEST_DB);
        }
    }
}
