//! The question of the episode as text.

use super::{
    Dtype, NoSettings, ObservationBuffer, Sensor, SensorContext, SensorKind, SensorSetup,
    SensorSpec, parse_sensor_settings,
};
use crate::episode::GoalField;
use crate::error::WorldError;
use crate::schema;

const ABOUT: &str = "The question as text; its characters are dwell_semantics::instruct::CHARSET.";

pub(super) const KIND: SensorKind = SensorKind {
    name: "question",
    about: ABOUT,
    build,
    settings: schema::fields_of::<NoSettings>,
    image: None,
    goal_part: Some(GoalField::Question),
};

#[derive(Debug)]
struct QuestionSensor;

fn build(value: &serde_json::Value, _: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    let NoSettings {} = parse_sensor_settings(value)?;
    Ok(Box::new(QuestionSensor))
}

impl Sensor for QuestionSensor {
    fn spec(&self) -> SensorSpec {
        SensorSpec {
            name: "question".to_owned(),
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
