//! Where an agent faces, relative to where it faced at the start.

use super::{
    Dtype, NoSettings, ObservationBuffer, Sensor, SensorContext, SensorKind, SensorSetup,
    SensorSpec, settings,
};
use crate::error::WorldError;
use crate::schema;
use dwell_scene::space::yaw_from_forward;
use dwell_scene::{AgentId, Id, math};
use glam::Vec3;

const ABOUT: &str =
    "Yaw against the episode's start, radians in (-pi, pi], positive to the left; shape (1,).";

pub(super) const KIND: SensorKind = SensorKind {
    name: "compass",
    about: ABOUT,
    build,
    settings: schema::fields::<NoSettings>,
    image: None,
};

#[derive(Debug)]
struct CompassSensor;

fn build(value: &serde_json::Value, _: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    let NoSettings {} = settings(value)?;
    Ok(Box::new(CompassSensor))
}

impl Sensor for CompassSensor {
    fn spec(&self) -> SensorSpec {
        let pi = std::f64::consts::PI;
        SensorSpec {
            name: "compass".to_owned(),
            shape: vec![1],
            dtype: Dtype::Float32,
            unit: "rad",
            low: -pi - 1e-6,
            high: pi + 1e-6,
            about: ABOUT,
        }
    }

    fn finish(&self, seen: SensorContext<'_>, out: ObservationBuffer<'_>) {
        if let (Some(agent), ObservationBuffer::Float32(out)) =
            (seen.world.state().agents.get(AgentId::from_index(0)), out)
        {
            let start_yaw = yaw_from_forward(seen.episode.start.transform_vector(Vec3::NEG_Z));
            out[0] = math::wrap_angle(agent.yaw_rad - start_yaw);
        }
    }
}
