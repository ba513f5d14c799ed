//! The instruction of the episode as text.

use super::{
    Dtype, NoSettings, ObservationBuffer, Sensor, SensorContext, SensorKind, SensorSetup,
    SensorSpec, parse_sensor_settings,
};
use crate::error::WorldError;
use crate::schema;

const ABOUT: &str =
    "The instruction as text; its characters are dwell_semantics::instruct::CHARSET.";

pub(super) const KIND: SensorKind = SensorKind {
    name: "instruction",
    about: ABOUT,
    build,
    settings: schema::fields_of::<NoSettings>,
    image: None,
    goal_part: None,
};

#[derive(Debug)]
struct InstructionSensor;

fn build(value: &serde_json::Value, _: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    let NoSettings {} = parse_sensor_settings(value)?;
    Ok(Box::new(InstructionSensor))
}

impl Sensor for InstructionSensor {
    fn spec(&self) -> SensorSpec {
        SensorSpec {
            name: "instruction".to_owned(),
            shape: Vec::new(),
            dtype: Dtype::Text,
            unit: "1",
            low: 0.0,
            high: dwell_semantics::instruct::MAX_TEXT_LEN as f64,
            about: ABOUT,
        }
    }

    fn write_observation(&self, seen: SensorContext<'_>, out: ObservationBuffer<'_>) {
        if let ObservationBuffer::Text(out) = out {
            out.clear();
            out.push_str(&seen.episode.instruction);
        }
    }
}
