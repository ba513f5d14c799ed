//! What the oracle replied to a question, as numbers of the vocabulary.

use super::{
    Dtype, NoSettings, ObservationBuffer, Sensor, SensorContext, SensorKind, SensorSetup,
    SensorSpec, parse_sensor_settings,
};
use crate::episode::GoalField;
use crate::error::WorldError;
use crate::schema;

/// Most words of a reply that are observed.
const LENGTH: usize = 16;

const ABOUT: &str = "What the oracle replied to what was asked in this step, as tokens of the versioned vocabulary; shape (16,), \
                     0 = padding, all 0 = nothing was asked.";

pub(super) const KIND: SensorKind = SensorKind {
    name: "reply_tokens",
    about: ABOUT,
    build,
    settings: schema::fields_of::<NoSettings>,
    image: None,
    goal_part: Some(GoalField::Replies),
};

#[derive(Debug)]
struct ReplyTokensSensor;

fn build(value: &serde_json::Value, _: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    let NoSettings {} = parse_sensor_settings(value)?;
    Ok(Box::new(ReplyTokensSensor))
}

impl Sensor for ReplyTokensSensor {
    fn spec(&self) -> SensorSpec {
        SensorSpec {
            name: KIND.name.to_owned(),
            shape: vec![LENGTH],
            dtype: Dtype::Int32,
            unit: "token",
            low: 0.0,
            high: dwell_semantics::vocabulary::size() as f64,
            about: ABOUT,
        }
    }

    fn write_observation(&self, seen: SensorContext<'_>, out: ObservationBuffer<'_>) {
        if let ObservationBuffer::Int32(out) = out {
            match seen.reply {
                Some(reply) => out.copy_from_slice(&reply.tokens(LENGTH)),
                None => out.fill(dwell_semantics::vocabulary::PAD),
            }
        }
    }
}
