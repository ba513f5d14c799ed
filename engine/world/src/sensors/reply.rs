//! What the oracle replied to a question, as text.

use super::{
    Dtype, NoSettings, ObservationBuffer, Sensor, SensorContext, SensorKind, SensorSetup,
    SensorSpec, parse_sensor_settings,
};
use crate::episode::GoalField;
use crate::error::WorldError;
use crate::schema;
use dwell_semantics::instruct::{CHARSET, MAX_TEXT_LEN};

const ABOUT: &str = "What the oracle replied to what was asked in this step, as text, empty where nothing was asked; its characters \
                     are dwell_semantics::instruct::CHARSET.";

pub(super) const KIND: SensorKind = SensorKind {
    name: "reply",
    about: ABOUT,
    build,
    settings: schema::fields_of::<NoSettings>,
    image: None,
    goal_part: Some(GoalField::Replies),
};

#[derive(Debug)]
struct ReplySensor;

fn build(value: &serde_json::Value, _: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    let NoSettings {} = parse_sensor_settings(value)?;
    Ok(Box::new(ReplySensor))
}

impl Sensor for ReplySensor {
    fn spec(&self) -> SensorSpec {
        SensorSpec {
            name: KIND.name.to_owned(),
            shape: Vec::new(),
            dtype: Dtype::Text,
            unit: "1",
            low: 0.0,
            high: MAX_TEXT_LEN as f64,
            about: ABOUT,
        }
    }

    fn write_observation(&self, seen: SensorContext<'_>, out: ObservationBuffer<'_>) {
        if let ObservationBuffer::Text(out) = out {
            out.clear();
            // Names that a house's own file gives may have any letters.
            let letters = seen.reply.into_iter().flat_map(|reply| reply.text.chars());
            out.extend(
                letters
                    .filter(|own| CHARSET.contains(*own))
                    .take(MAX_TEXT_LEN),
            );
        }
    }
}
