//! The kind of the room that is looked for.

use super::{
    Dtype, NameSettings, ObservationBuffer, Sensor, SensorContext, SensorKind, SensorSetup,
    SensorSpec, parse_sensor_settings,
};
use crate::episode::GoalField;
use crate::error::WorldError;
use crate::schema;
use dwell_semantics::room_kind::room_kinds;

const ABOUT: &str = "The kind of the room that is looked for: a row of assets/rooms.csv, counted from 1; shape (1,).";

pub(super) const KIND: SensorKind = SensorKind {
    name: "roomgoal",
    about: ABOUT,
    build,
    settings: schema::fields_of::<NameSettings>,
    image: None,
    goal_part: Some(GoalField::Room),
};

#[derive(Debug)]
struct RoomGoalSensor(String);

fn build(value: &serde_json::Value, _: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    let NameSettings { name } = parse_sensor_settings(value)?;
    Ok(Box::new(RoomGoalSensor(super::key(KIND.name, name)?)))
}

impl Sensor for RoomGoalSensor {
    fn spec(&self) -> SensorSpec {
        SensorSpec {
            name: self.0.clone(),
            shape: vec![1],
            dtype: Dtype::Int32,
            unit: "kind",
            low: 0.0,
            high: room_kinds().rows().len() as f64 + 1.0,
            about: ABOUT,
        }
    }

    fn write_observation(&self, seen: SensorContext<'_>, out: ObservationBuffer<'_>) {
        if let ObservationBuffer::Int32(out) = out {
            out.fill(seen.episode.goal.room_kind);
        }
    }
}
