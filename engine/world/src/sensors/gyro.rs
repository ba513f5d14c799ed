//! The gyro: an agent's angular velocity.

use super::{
    AgentSensorSettings, Dtype, ObservationBuffer, ObservedAgent, Sensor, SensorContext,
    SensorKind, SensorSetup, SensorSpec,
};
use crate::error::WorldError;
use crate::schema;

const ABOUT: &str = "Rate of turn to the left as the agent's gyro reads it, rad/s: the mean over the last step, with the \
                     errors that laws give a base on wheels, without any on legs; shape (1,).";

/// The end of its range, rad/s: 200 turns a second.
const FULL_SCALE_RAD_S: f32 = 1257.0;

pub(super) const KIND: SensorKind = SensorKind {
    name: "gyro",
    about: ABOUT,
    build,
    settings: schema::fields_of::<AgentSensorSettings>,
    image: None,
    goal_part: None,
};

#[derive(Debug)]
struct GyroSensor(ObservedAgent);

fn build(value: &serde_json::Value, setup: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    Ok(Box::new(GyroSensor(ObservedAgent::build(
        KIND.name, value, setup,
    )?)))
}

impl Sensor for GyroSensor {
    fn spec(&self) -> SensorSpec {
        SensorSpec {
            name: self.0.name.clone(),
            shape: vec![1],
            dtype: Dtype::Float32,
            unit: "rad/s",
            low: f64::from(-FULL_SCALE_RAD_S),
            high: f64::from(FULL_SCALE_RAD_S),
            about: ABOUT,
        }
    }

    fn write_observation(&self, seen: SensorContext<'_>, out: ObservationBuffer<'_>) {
        if let (Some(agent), ObservationBuffer::Float32(out)) = (self.0.state(seen), out) {
            out[0] = agent.gyro_rad_s.clamp(-FULL_SCALE_RAD_S, FULL_SCALE_RAD_S);
        }
    }
}
