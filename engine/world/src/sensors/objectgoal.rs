//! The class of the thing that is looked for.

use super::{
    Dtype, NameSettings, ObservationBuffer, Sensor, SensorContext, SensorKind, SensorSetup,
    SensorSpec, parse_sensor_settings,
};
use crate::episode::GoalField;
use crate::error::WorldError;
use crate::schema;
use dwell_semantics::category::categories;

const ABOUT: &str = "The class of the thing that is looked for, as the sensor semantic numbers them by default (House.semantic_classes); shape (1,).";

pub(super) const KIND: SensorKind = SensorKind {
    name: "objectgoal",
    about: ABOUT,
    build,
    settings: schema::fields_of::<NameSettings>,
    image: None,
    goal_part: Some(GoalField::Class),
};

#[derive(Debug)]
struct ObjectGoalSensor(String);

fn build(value: &serde_json::Value, _: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    let NameSettings { name } = parse_sensor_settings(value)?;
    Ok(Box::new(ObjectGoalSensor(super::key(KIND.name, name)?)))
}

impl Sensor for ObjectGoalSensor {
    fn spec(&self) -> SensorSpec {
        SensorSpec {
            name: self.0.clone(),
            shape: vec![1],
            dtype: Dtype::Int32,
            unit: "class",
            low: 0.0,
            high: categories().rows().len() as f64 + 1.0,
            about: ABOUT,
        }
    }

    fn write_observation(&self, seen: SensorContext<'_>, out: ObservationBuffer<'_>) {
        if let ObservationBuffer::Int32(out) = out {
            out.fill(seen.episode.goal.class);
        }
    }
}
