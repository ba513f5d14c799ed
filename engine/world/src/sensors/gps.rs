//! Where an agent is, relative to where it started.

use super::{
    Dtype, NoSettings, ObservationBuffer, Sensor, SensorContext, SensorKind, SensorSetup,
    SensorSpec, settings,
};
use crate::error::WorldError;
use crate::schema;
use dwell_scene::{AgentId, Id};

const ABOUT: &str = "Position in the frame of the episode's start: metres forward and metres to the left; shape (2,).";

pub(super) const KIND: SensorKind = SensorKind {
    name: "gps",
    about: ABOUT,
    build,
    settings: schema::fields::<NoSettings>,
    image: None,
};

#[derive(Debug)]
struct GpsSensor;

fn build(value: &serde_json::Value, _: SensorSetup<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    let NoSettings {} = settings(value)?;
    Ok(Box::new(GpsSensor))
}

impl Sensor for GpsSensor {
    fn spec(&self) -> SensorSpec {
        SensorSpec {
            name: "gps".to_owned(),
            shape: vec![2],
            dtype: Dtype::Float32,
            unit: "m",
            low: -1000.0,
            high: 1000.0,
            about: ABOUT,
        }
    }

    fn finish(&self, seen: SensorContext<'_>, out: ObservationBuffer<'_>) {
        if let (Some(agent), ObservationBuffer::Float32(out)) =
            (seen.world.state().agents.get(AgentId::from_index(0)), out)
        {
            let moved = seen.episode.start.inverse().transform_point(agent.position);
            out.copy_from_slice(&[
                (0.0 - moved.z).clamp(-1000.0, 1000.0),
                (0.0 - moved.x).clamp(-1000.0, 1000.0),
            ]);
        }
    }
}
