//! The compass: an agent's heading relative to its start.

use super::{
    AgentSensorSettings, Dtype, ObservationBuffer, ObservedAgent, Sensor, SensorContext,
    SensorKind, SensorSetup, SensorSpec,
};
use crate::error::WorldError;
use crate::schema;
use dwell_scene::math;
use dwell_scene::space::yaw_from_forward;
use glam::Vec3;

const ABOUT: &str =
    "Yaw against the episode's start, radians in (-pi, pi], positive to the left; shape (1,).";

pub(super) const KIND: SensorKind = SensorKind {
    name: "compass",
    about: ABOUT,
    build,
    settings: schema::fields_of::<AgentSensorSettings>,
    image: None,
    goal_part: None,
};

#[derive(Debug)]
struct CompassSensor(ObservedAgent);

fn build(value: &serde_json::Value, setup: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    Ok(Box::new(CompassSensor(ObservedAgent::build(
        KIND.name, value, setup,
    )?)))
}

impl Sensor for CompassSensor {
    fn spec(&self) -> SensorSpec {
        let pi = std::f64::consts::PI;
        SensorSpec {
            name: self.0.name.clone(),
            shape: vec![1],
            dtype: Dtype::Float32,
            unit: "rad",
            low: -pi - 1e-6,
            high: pi + 1e-6,
            about: ABOUT,
        }
    }

    fn write_observation(&self, seen: SensorContext<'_>, out: ObservationBuffer<'_>) {
        if let (Some(agent), ObservationBuffer::Float32(out)) = (self.0.state(seen), out) {
            let start_yaw =
                yaw_from_forward(seen.start_pose(self.0.agent).transform_vector(Vec3::NEG_Z));
            out[0] = math::wrap_angle(agent.yaw_rad - start_yaw);
        }
    }
}
