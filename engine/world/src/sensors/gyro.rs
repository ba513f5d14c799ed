//! What an agent's gyro reads.

use super::{
    Dtype, NoSettings, ObservationBuffer, Sensor, SensorContext, SensorKind, SensorSetup,
    SensorSpec, settings,
};
use crate::error::WorldError;
use crate::schema;
use dwell_scene::{AgentId, Id};

const ABOUT: &str = "Rate of turn to the left as the agent's gyro reads it, rad/s: the mean over the last step, with the \
                     errors that laws give it; shape (1,).";

/// The end of its range, rad/s: 200 turns a second.
const FULL_SCALE_RAD_S: f32 = 1257.0;

pub(super) const KIND: SensorKind = SensorKind {
    name: "gyro",
    about: ABOUT,
    build,
    settings: schema::fields::<NoSettings>,
    image: None,
};

#[derive(Debug)]
struct GyroSensor;

fn build(value: &serde_json::Value, _: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    let NoSettings {} = settings(value)?;
    Ok(Box::new(GyroSensor))
}

impl Sensor for GyroSensor {
    fn spec(&self) -> SensorSpec {
        SensorSpec {
            name: "gyro".to_owned(),
            shape: vec![1],
            dtype: Dtype::Float32,
            unit: "rad/s",
            low: f64::from(-FULL_SCALE_RAD_S),
            high: f64::from(FULL_SCALE_RAD_S),
            about: ABOUT,
        }
    }

    fn finish(&self, seen: SensorContext<'_>, out: ObservationBuffer<'_>) {
        if let (Some(agent), ObservationBuffer::Float32(out)) =
            (seen.world.state().agents.get(AgentId::from_index(0)), out)
        {
            out[0] = agent.gyro_rad_s.clamp(-FULL_SCALE_RAD_S, FULL_SCALE_RAD_S);
        }
    }
}
