//! The position sensor: an agent's position relative to its start.

use super::{
    AgentSensorSettings, Dtype, ObservationBuffer, ObservedAgent, Sensor, SensorContext,
    SensorKind, SensorSetup, SensorSpec,
};
use crate::error::WorldError;
use crate::schema;

const ABOUT: &str = "Position in the frame of the episode's start: metres forward and metres to the left; shape (2,).";

pub(super) const KIND: SensorKind = SensorKind {
    name: "gps",
    about: ABOUT,
    build,
    settings: schema::fields_of::<AgentSensorSettings>,
    image: None,
    goal_part: None,
};

#[derive(Debug)]
struct GpsSensor(ObservedAgent);

fn build(value: &serde_json::Value, setup: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    Ok(Box::new(GpsSensor(ObservedAgent::build(
        KIND.name, value, setup,
    )?)))
}

impl Sensor for GpsSensor {
    fn spec(&self) -> SensorSpec {
        SensorSpec {
            name: self.0.name.clone(),
            shape: vec![2],
            dtype: Dtype::Float32,
            unit: "m",
            low: -1000.0,
            high: 1000.0,
            about: ABOUT,
        }
    }

    fn write_observation(&self, seen: SensorContext<'_>, out: ObservationBuffer<'_>) {
        if let (Some(agent), ObservationBuffer::Float32(out)) = (self.0.state(seen), out) {
            let moved = seen
                .start_pose(self.0.agent)
                .inverse()
                .transform_point(agent.position);
            out.copy_from_slice(&[
                (0.0 - moved.z).clamp(-1000.0, 1000.0),
                (0.0 - moved.x).clamp(-1000.0, 1000.0),
            ]);
        }
    }
}
