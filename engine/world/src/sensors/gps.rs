//! Where an agent is, relative to where it started.

use super::{Dtype, NoSettings, Out, Seen, Sensor, SensorKind, SensorSpec, Site, settings};
use crate::error::WorldError;
use dwell_scene::{AgentId, Id};

const ABOUT: &str = "Position in the frame of the episode's start: metres forward and metres to the left; shape (2,).";

pub(super) const KIND: SensorKind = SensorKind {
    name: "gps",
    about: ABOUT,
    build,
    image: None,
};

#[derive(Debug)]
struct Gps;

fn build(value: &serde_json::Value, _: Site<'_>) -> Result<Box<dyn Sensor>, WorldError> {
    let NoSettings {} = settings(value)?;
    Ok(Box::new(Gps))
}

impl Sensor for Gps {
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

    fn finish(&self, seen: Seen<'_>, out: Out<'_>) {
        if let (Some(agent), Out::Float32(out)) =
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
