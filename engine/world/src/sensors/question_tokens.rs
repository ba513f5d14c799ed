//! The question of the episode as numbers of a versioned vocabulary.

use super::{
    Dtype, NoSettings, ObservationBuffer, Sensor, SensorContext, SensorKind, SensorSetup,
    SensorSpec, parse_sensor_settings,
};
use crate::episode::GoalField;
use crate::error::WorldError;
use crate::schema;

const ABOUT: &str =
    "The question as tokens of the versioned vocabulary; shape (tokens,), 0 = padding.";

pub(super) const KIND: SensorKind = SensorKind {
    name: "question_tokens",
    about: ABOUT,
    build,
    settings: schema::fields_of::<NoSettings>,
    image: None,
    goal_part: Some(GoalField::Question),
};

#[derive(Debug)]
struct QuestionTokensSensor;

fn build(value: &serde_json::Value, _: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    let NoSettings {} = parse_sensor_settings(value)?;
    Ok(Box::new(QuestionTokensSensor))
}

impl Sensor for QuestionTokensSensor {
    fn spec(&self) -> SensorSpec {
        SensorSpec {
            name: "question_tokens".to_owned(),
            shape: vec![dwell_semantics::vocabulary::LENGTH],
            dtype: Dtype::Int32,
            unit: "token",
            low: 0.0,
            high: dwell_semantics::vocabulary::size() as f64,
            about: ABOUT,
        }
    }

    fn write_observation(&self, seen: SensorContext<'_>, out: ObservationBuffer<'_>) {
        if let ObservationBuffer::Int32(out) = out {
            out.copy_from_slice(&seen.episode.tokens);
        }
    }
}
